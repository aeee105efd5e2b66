"""Overlapping blends in translation: a move that the controller leaves out is left out in the other language, and
corners that would make it leave one out are written smaller. Source: URScript Manual 5.2, movej.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

NOWHERE = "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]"


def translated(text: str, source: str, target: str) -> tuple[str, list[tuple[str, int]]]:
    suffix = {"rapid": ".mod", "urscript": ".script"}[source]
    diagnostics = Diagnostics()
    program = read_sources([source_from_text(f"m{suffix}", text)], source, diagnostics).program
    read = ReadProgram(program, program, (), (), (source,))
    found = translate_program(read, target, None, None, diagnostics)
    told = [(item.code.name, item.origin.line) for item in diagnostics]
    return "\n".join(file.data.decode("latin-1") for file in found.files), told


def script(radius: float) -> str:
    return (
        "def prog():\n  movel(p[0.4,-0.2,0.3,0,3.14,0])\n"
        f"  movel(p[0.4,-0.1,0.3,0,3.14,0], r={radius})\n  movel(p[0.46,-0.1,0.3,0,3.14,0], r={radius})\n"
        "  movel(p[0.52,-0.08,0.3,0,3.14,0])\nend\n"
    )


def test_a_left_out_move_is_not_written() -> None:
    text, told = translated(script(0.05), "urscript", "rapid")
    assert "[400,-100,300]" in text and "[520,-80,300]" in text and "[460,-100,300]" not in text
    assert ("move-left-out", 4) in told
    text, told = translated(script(0.02), "urscript", "rapid")
    assert "[460,-100,300]" in text
    assert "move-left-out" not in [name for name, _ in told]


def rapid(zone: str) -> str:
    places = ("400,-200", "400,-100", "460,-100", "460,0")
    zones = ("fine", zone, zone, "fine")
    lines = [
        f"MoveL [[{place},300],[0,0,1,0],{NOWHERE}],v100,{size},tool0;"
        for place, size in zip(places, zones, strict=True)
    ]
    return "\n".join(["MODULE m", "PROC main()", *lines, "ENDPROC", "ENDMODULE", ""])


def test_corners_that_overlap_are_written_smaller() -> None:
    """Each gets half of the 60 mm between them, which a RAPID controller makes of them as well (zonedata)."""
    text, told = translated(rapid("z50"), "rapid", "urscript")
    assert text.count("r=0.03)") == 2
    assert ("corner-made-smaller", 4) in told
    text, told = translated(rapid("z30"), "rapid", "urscript")
    assert text.count("r=0.03)") == 2
    assert "corner-made-smaller" not in [name for name, _ in told]


def move(y: float, zone: str) -> str:
    return f"MoveL [[400,{y},300],[0,0,1,0],{NOWHERE}],v100,{zone},tool0;"


# What stands in main, and in a routine that it may call; whether an overlap is possible for all that the program says.
ORDERS = {
    "a branch": (f"{move(0, 'z50')}\nIF di1=1 THEN\n{move(60, 'z50')}\nENDIF\n{move(400, 'fine')}", "", True),
    "behind a branch": (f"IF di1=1 THEN\n{move(0, 'z50')}\nENDIF\n{move(60, 'z50')}\n{move(400, 'fine')}", "", True),
    "a routine": (f"{move(0, 'z50')}\nother;\n{move(400, 'fine')}", move(60, "z50"), True),
    "behind a routine": (f"other;\n{move(60, 'z50')}\n{move(400, 'fine')}", move(0, "z50"), True),
    "a loop": (f"WHILE di1=1 DO\n{move(0, 'z50')}\n{move(400, 'z50')}\nENDWHILE\n{move(500, 'fine')}", "", True),
    "a stop at the end of a loop": (f"WHILE di1=1 DO\n{move(0, 'z50')}\n{move(400, 'fine')}\nENDWHILE", "", False),
    "a stop in a routine": (f"other;\n{move(60, 'z50')}\n{move(400, 'fine')}", move(0, "fine"), False),
    "a branch without moves": (f"{move(0, 'z50')}\nIF di1=1 THEN\nn:=1;\nENDIF\n{move(400, 'fine')}", "", False),
}


@pytest.mark.parametrize("what", ORDERS)
def test_corners_that_meet_only_in_the_run_are_warned_of(what: str) -> None:
    main, other, possible = ORDERS[what]
    program = f"MODULE m\nVAR num n:=0;\nPROC main()\n{main}\nENDPROC\nPROC other()\n{other}\nENDPROC\nENDMODULE\n"
    _, told = translated(program, "rapid", "urscript")
    assert ("corners-may-overlap" in [name for name, _ in told]) == possible


def test_what_stands_between_two_moves_does_not_hide_their_corners() -> None:
    lines = rapid("z50").splitlines()
    lines.insert(4, "SetDO do1,1;")
    text, told = translated("\n".join(lines) + "\n", "rapid", "urscript")
    assert text.count("r=0.03)") == 2
    assert "corners-may-overlap" not in [name for name, _ in told]
