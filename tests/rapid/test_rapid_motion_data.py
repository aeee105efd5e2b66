"""What a move in RAPID is driven with: predefined words and named data, and no numbers in the move."""

from __future__ import annotations

import re

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

HOME = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}"
DATA = """DEFDAT m
DECL FRAME GRIPPER={X 0,Y 0,Z 120,A 0,B 0,C 0}
DECL FRAME TABLE={X 400,Y 0,Z 100,A 0,B 0,C 0}
DECL E6POS XP={X 50,Y 0,Z 300,A 0,B 90,C 0}
ENDDAT
"""


def written(*lines: str, more: str = "") -> tuple[str, list[str]]:
    """The text for the routine with these lines, and the codes of what was said."""
    files = {"m.src": "\n".join(("DEF m()", *lines, "END", more)), "m.dat": DATA}
    found = Diagnostics()
    read = read_sources([source_from_text(name, text) for name, text in files.items()], "krl", found)
    done = translate_program(read, "rapid", "kuka_kr6r900sixx", None, found)
    return "\n".join(file.data.decode() for file in done.files), [item.code.name for item in found]


def moves(text: str) -> list[str]:
    return [re.sub(r"^Move\w+ .*?,(?=[vz]\w)", "", line.strip()) for line in text.splitlines() if " Move" in line]


@pytest.mark.parametrize(
    ("settings", "move", "head"),
    [
        ("$VEL.CP=0.3", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.302", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.35", "v350,fine,tool0;", "CONST speeddata v350:=[350,500,5000,1000];"),
        ("$VEL.CP=0.3\n$VEL.ORI1=20", "v300_20,fine,tool0;", "CONST speeddata v300_20:=[300,20,5000,1000];"),
        ("$VEL.CP=0.3\n$VEL.ORI1=200", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.3\n$TOOL=GRIPPER", "v300,fine,GRIPPER;", "tooldata GRIPPER:=[TRUE,[[0,0,120],"),
        ("$VEL.CP=0.3\n$BASE=TABLE", "v300,fine,tool0\\WObj:=TABLE;", 'wobjdata TABLE:=[FALSE,TRUE,"",[[400,0,100],'),
        ("$VEL.CP=0.3\n$BASE=TABLE\n$BASE=$NULLFRAME", "v300,fine,tool0;", ""),
        ("$VEL.CP=0.3\n$TOOL={X 0,Y 0,Z 80,A 0,B 0,C 0}", "v300,fine,tool1;", "tooldata tool1:=[TRUE,[[0,0,80],"),
    ],
)
def test_what_is_known_is_a_word_of_the_move(settings: str, move: str, head: str) -> None:
    text, _ = written(HOME, settings, "LIN XP", "LIN XP")
    assert moves(text) == ["vmax,fine,tool0;", move, move], text
    assert head in text and not re.search(r"(tframe|uframe|v_tcp|v_ori):=", text), text


def test_a_corner_of_a_size_of_its_own_is_data_with_a_name() -> None:
    text, _ = written(HOME, "$VEL.CP=0.3", "$APO.CDIS=25", "LIN XP C_DIS", "$APO.CDIS=50", "LIN XP C_DIS", "LIN XP")
    assert moves(text)[1:] == ["v300,z25,tool0;", "v300,z50,tool0;", "v300,fine,tool0;"]
    assert text.count("zonedata") == 1


def test_what_is_rounded_is_said() -> None:
    assert "nearest-predefined" in written(HOME, "$VEL.CP=0.302", "LIN XP")[1]
    assert "nearest-predefined" not in written(HOME, "$VEL.CP=0.3", "LIN XP")[1]


def test_a_tool_that_the_run_decides_is_a_variable() -> None:
    lines = ("IF $IN[1] THEN", "$TOOL=GRIPPER", "ELSE", "$TOOL=$NULLFRAME", "ENDIF", "LIN XP")
    text, _ = written(HOME, *lines)
    assert moves(text)[-1].endswith(",fine,tCurrent;") and text.count("tCurrent.tframe:=") == 2, text


CONFIG = """DEFDAT $CONFIG PUBLIC
TOOL_DATA[1]={X 0,Y 0,Z 150,A 0,B 0,C 0}
TOOL_NAME[1,]="vacuum cup"
BASE_DATA[2]={X 350,Y 150,Z 20,A 0,B 0,C 0}
BASE_DATA[5]={X 300,Y 0,Z 0,A 0,B 0,C 0}
ENDDAT
"""


def test_numbered_tools_and_frames_have_their_names_or_numbers() -> None:
    lines = ("DEF m()", "$TOOL=TOOL_DATA[1]", "$BASE=BASE_DATA[2]", HOME, "$VEL.CP=0.3", "LIN XP", "END")
    files = {"m.src": "\n".join(lines), "m.dat": DATA, "$config.dat": CONFIG}
    read = read_sources([source_from_text(name, text) for name, text in files.items()], "krl", Diagnostics())
    done = translate_program(read, "rapid", "kuka_kr6r900sixx", None, Diagnostics())
    text = "\n".join(file.data.decode() for file in done.files)
    assert moves(text) == ["vmax,fine,tVacuumCup;", "v300,fine,tVacuumCup\\WObj:=wobj2;"], text
    assert "PERS tooldata tVacuumCup:=[TRUE,[[0,0,150]," in text and "_DATA" not in text and "_NAME" not in text
    assert 'PERS wobjdata wobj2:=[FALSE,TRUE,"",[[350,150,20],' in text


def test_a_tool_whose_name_is_a_word_keeps_it() -> None:
    lines = ("DEF m()", "$TOOL=TOOL_DATA[1]", "$BASE=BASE_DATA[2]", HOME, "$VEL.CP=0.3", "LIN XP", "END")
    config = CONFIG.replace("vacuum cup", "cup_2")
    files = {"m.src": "\n".join(lines), "m.dat": DATA, "$config.dat": config}
    read = read_sources([source_from_text(name, text) for name, text in files.items()], "krl", Diagnostics())
    done = translate_program(read, "rapid", "kuka_kr6r900sixx", None, Diagnostics())
    assert moves("\n".join(file.data.decode() for file in done.files))[-1] == "v300,fine,cup_2\\WObj:=wobj2;"


LISTINGS = {
    "main": "1: UFRAME_NUM=0;\n2: UTOOL_NUM=2;\n3:J P[1] 100% FINE;\n4: CALL PLACE;",
    "place": "1: UFRAME_NUM=3;\n2:L P[1] 300mm/sec FINE;",
}
POINT = """P[1]{
   GP1:
  UF : 0, UT : 2,  CONFIG : 'N U T, 0, 0, 0',
  X =  400.000 mm, Y = 0.000 mm, Z = 300.000 mm, W = 180.000 deg, P = 0.000 deg, R = 0.000 deg
};"""


def test_numbers_of_listings_are_those_of_tools_and_work_objects() -> None:
    sources = [
        source_from_text(f"{name}.ls", f"/PROG {name.upper()}\n/ATTR\n/MN\n{body}\n/POS\n{POINT}\n/END\n")
        for name, body in LISTINGS.items()
    ]
    read = read_sources(sources, "tp", Diagnostics())
    done = translate_program(read, "rapid", None, None, Diagnostics())
    text = "\n".join(file.data.decode() for file in done.files)
    assert moves(text) == ["vmax,fine,tool2;", "v300,fine,tool2\\WObj:=wobj3;"], text
    assert not re.search(r"U(FRAME|TOOL)(_NUM|\{)", text)


def test_the_first_routine_is_main_and_no_module_is_called_like_a_routine() -> None:
    sources = [
        source_from_text("cell.src", "DEF cell()\nfetch()\nEND"),
        source_from_text("fetch.src", "DEF fetch()\n$OUT[1]=TRUE\nshut()\nEND\nDEF shut()\n$OUT[2]=TRUE\nEND"),
    ]
    read = read_sources(sources, "krl", Diagnostics())
    done = translate_program(read, "rapid", None, None, Diagnostics())
    text = "\n".join(file.data.decode() for file in done.files)
    assert done.renamed["cell"] == "main"
    assert re.findall(r"^ *(?:MODULE|(?:LOCAL )?PROC) \w+", text, re.M) == [
        "MODULE cell",
        "  PROC main",
        "MODULE fetchModule",
        "  PROC fetch",
        "  LOCAL PROC shut",
    ]
