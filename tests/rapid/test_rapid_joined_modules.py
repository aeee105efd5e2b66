"""Programs that are files of one routine each come out as routines of one RAPID module."""

from __future__ import annotations

import re

from tests.there_and_back import Journey, there_and_back

_POINT = """P[{number}{label}]{{
   GP1:
    UF : 0, UT : 0, CONFIG : 'N U T, 0, 0, 0',
    X = {x}.000 mm, Y = 0.000 mm, Z = 400.000 mm,
    W = 180.000 deg, P = 0.000 deg, R = 0.000 deg
}};
"""


def program(name: str, lines: str, *points: tuple[int, str, int]) -> str:
    numbered = "\n".join(f"{at:4}:  {line} ;" for at, line in enumerate(lines.splitlines(), 1))
    places = "".join(_POINT.format(number=n, label=f':"{label}"' if label else "", x=x) for n, label, x in points)
    return f"/PROG {name}\n/ATTR\n/MN\n{numbered}\n/POS\n{places}/END\n"


def journey(**files: str) -> Journey:
    return there_and_back({f"{name.upper()}.LS": text for name, text in files.items()}, "tp", "rapid", "fanuc_m10ia")


CELL = program("CELL", "!start\nUFRAME_NUM=0\nUTOOL_NUM=0\nCALL FETCH\nCALL PUT\nCALL OPENED")
FETCH = program(
    "FETCH", "!from the belt\nL P[1] 100mm/sec FINE\nL P[2:belt] 100mm/sec FINE", (1, "", 600), (2, "belt", 620)
)
PUT = program(
    "PUT",
    "L P[1] 100mm/sec FINE\nL P[2:place] 100mm/sec FINE\nL P[3:Home] 100mm/sec FINE",
    *((1, "", 640), (2, "place", 660), (3, "Home", 680)),
)
OPENED = program("OPENED", "DO[1]=OFF\nL P[1:Home] 100mm/sec FINE", (1, "Home", 690))


def test_programs_are_routines_of_the_module_that_the_task_begins_in() -> None:
    done = journey(cell=CELL, fetch=FETCH, put=PUT, opened=OPENED)
    files = {file.path: file.data.decode() for file in done.written.files if file.path.endswith(".mod")}
    (whole,) = [text for text in files.values() if "PROC" in text]
    assert re.findall(r"PROC (\w+)", whole) == ["main", "FETCH", "PUT", "OPENED"]


def test_what_several_call_alike_or_by_a_number_has_the_routine_in_front() -> None:
    text = journey(cell=CELL, fetch=FETCH, put=PUT, opened=OPENED).text
    points = re.findall(r"LOCAL CONST robtarget (\w+)", text)
    assert sorted(points) == ["FETCH_P1", "OPENED_Home", "PUT_Home", "PUT_P1", "belt", "place"]
    assert "MoveL FETCH_P1," in text and "MoveL PUT_Home," in text and "MoveL OPENED_Home," in text


def test_the_joined_module_means_the_same() -> None:
    assert journey(cell=CELL, fetch=FETCH, put=PUT, opened=OPENED).prove("CELL").agrees


def test_modules_of_several_routines_and_what_they_show_to_others_stay() -> None:
    """KRL modules: one has two routines, one has data that all see."""
    files = {
        "cell.src": "DEF cell()\n  pick()\n  drop()\nEND\nGLOBAL DEF pick()\n  $OUT[1]=TRUE\nEND\n",
        "drop.src": "DEF drop()\n  Count=Count+1\nEND\n",
        "drop.dat": "DEFDAT drop PUBLIC\nDECL GLOBAL INT Count=0\nENDDAT\n",
    }
    done = there_and_back(files, "krl", "rapid", "kuka_kr10r1100sixx")
    modules = [file.path for file in done.written.files if file.path.endswith(".mod")]
    assert len([path for path in modules if path.lower().startswith(("cell", "drop"))]) == 2


def test_data_of_one_module_does_not_hide_what_another_one_means() -> None:
    """`Level` is data of `pick` alone, and in `drop` what the controller's list declares for all."""
    files = {
        "cell.src": "DEF cell()\n  pick()\n  drop()\nEND\n",
        "pick.src": "DEF pick()\n  Level=Level+1\nEND\n",
        "pick.dat": "DEFDAT pick\nDECL INT Level=0\nENDDAT\n",
        "drop.src": "DEF drop()\n  Level=Level+2\n  IF Level==12 THEN\n    $OUT[1]=TRUE\n  ENDIF\nEND\n",
        "$config.dat": "DEFDAT $CONFIG\nDECL INT Level=10\nENDDAT\n",
    }
    done = there_and_back(files, "krl", "rapid", "kuka_kr10r1100sixx")
    assert done.prove("cell").agrees and done.switched_on(done.run("cell")) == {1}
