"""Overlapping blends in translation: a move that the controller leaves out is left out in the other language, and
corners that would make it leave one out are written smaller. Source: URScript Manual 5.2, movej.
"""

from __future__ import annotations

import re

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
    """Each gets just under half of the 60 mm between them, which a RAPID controller makes of them as well (zonedata):
    under it, so that they do not touch in the rounding."""
    text, told = translated(rapid("z50"), "rapid", "urscript")
    assert text.count("r=0.029994)") == 2
    assert ("corner-made-smaller", 4) in told
    text, told = translated(rapid("z30"), "rapid", "urscript")
    assert text.count("r=0.029994)") == 2
    assert "corner-made-smaller" not in [name for name, _ in told]  # only rounded
    text, _ = translated(rapid("z20"), "rapid", "urscript")
    assert text.count("r=0.02)") == 2


def test_sizes_before_and_after_are_told() -> None:
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("m.mod", rapid("z50"))], "rapid", diagnostics).program
    translate_program(ReadProgram(program, program, (), (), ("rapid",)), "urscript", None, None, diagnostics)
    told = [item for item in diagnostics if item.code.name == "corner-made-smaller"]
    assert {item.severity.name for item in told} == {"WARNING"}
    assert all("29.99 mm in place of 50 mm" in item.message for item in told)


def move(y: float, zone: str) -> str:
    return f"MoveL [[400,{y},300],[0,0,1,0],{NOWHERE}],v100,{zone},tool0;"


# What stands in main, and in a routine that it may call; the radii that are written, in the order of the text.
ORDERS = {
    "a branch": (
        f"{move(0, 'z50')}\nIF di1=1 THEN\n{move(60, 'z50')}\nENDIF\n{move(400, 'fine')}",
        "",
        ["0.029994", "0.029994"],
    ),
    "behind a branch": (
        f"IF di1=1 THEN\n{move(0, 'z50')}\nENDIF\n{move(60, 'z50')}\n{move(400, 'fine')}",
        "",
        ["0.029994", "0.029994"],
    ),
    "a routine": (f"{move(0, 'z50')}\nother;\n{move(400, 'fine')}", move(60, "z50"), ["0.029994", "0.029994"]),
    "behind a routine": (f"other;\n{move(60, 'z50')}\n{move(400, 'fine')}", move(0, "z50"), ["0.029994", "0.029994"]),
    "a routine within a routine": (
        f"{move(0, 'z50')}\nother;\n{move(400, 'fine')}",
        f"IF n>0 other;\n{move(60, 'z50')}",
        ["0.029994", "0.029994"],
    ),
    "the next pass of a loop": (
        f"WHILE di1=1 DO\n{move(0, 'z50')}\n{move(400, 'z50')}\n{move(60, 'z50')}\nENDWHILE\n{move(500, 'fine')}",
        "",
        ["0.029994", "0.05", "0.029994"],
    ),
    "a loop with room": (
        f"WHILE di1=1 DO\n{move(0, 'z50')}\n{move(400, 'z50')}\nENDWHILE\n{move(500, 'fine')}",
        "",
        ["0.05", "0.05"],
    ),
    "a stop at the end of a loop": (
        f"WHILE di1=1 DO\n{move(0, 'z50')}\n{move(400, 'fine')}\nENDWHILE",
        "",
        ["0.05"],
    ),
    "a stop in a routine": (f"other;\n{move(60, 'z50')}\n{move(400, 'fine')}", move(0, "fine"), ["0.05"]),
    "a branch without moves": (
        f"{move(0, 'z50')}\nIF di1=1 THEN\nn:=1;\nENDIF\n{move(400, 'fine')}",
        "",
        ["0.05"],
    ),
}


@pytest.mark.parametrize("what", ORDERS)
def test_corners_have_room_on_every_way_of_the_program(what: str) -> None:
    main, other, radii = ORDERS[what]
    program = f"MODULE m\nVAR num n:=0;\nPROC main()\n{main}\nENDPROC\nPROC other()\n{other}\nENDPROC\nENDMODULE\n"
    text, _ = translated(program, "rapid", "urscript")
    assert sorted(re.findall(r"r=([0-9.]+)\)", text)) == sorted(radii)


def test_what_stands_between_two_moves_does_not_hide_their_corners() -> None:
    lines = rapid("z50").splitlines()
    lines.insert(4, "SetDO do1,1;")
    text, _ = translated("\n".join(lines) + "\n", "rapid", "urscript")
    assert text.count("r=0.029994)") == 2


POINT = f"CONST robtarget base:=[[400,0,300],[0,0,1,0],{NOWHERE}];\nVAR robtarget spot;\nVAR num n:=0;\n"


def computed(*lines: str) -> tuple[str, list[tuple[str, int]]]:
    body = "\n".join(("IF di1=1 n:=3;", *lines))
    return translated(f"MODULE m\n{POINT}PROC main()\n{body}\nENDPROC\nENDMODULE\n", "rapid", "urscript")


def test_constant_offsets_from_a_computed_place_give_room() -> None:
    """Wherever the place is, 40 mm lie between the two."""
    text, told = computed(
        "spot:=Offs(base,n*50,0,0);",
        "MoveL Offs(spot,0,0,100),v100,fine,tool0;",
        "MoveL Offs(spot,0,0,50),v100,z40,tool0;",
        "MoveL Offs(spot,0,0,10),v100,z40,tool0;",
        "MoveL Offs(spot,90,0,10),v100,fine,tool0;",
    )
    assert text.count("r=0.019996)") == 2
    assert "corner-made-smaller" in [name for name, _ in told]


def test_a_way_that_the_run_computes_limits_both_corners() -> None:
    text, told = computed(
        "MoveL base,v100,fine,tool0;",
        "spot:=Offs(base,n*50,0,0);",
        "MoveL Offs(base,0,90,0),v100,z40,tool0;",
        "MoveL spot,v100,z30,tool0;",
        "MoveL Offs(base,90,300,10),v100,fine,tool0;",
    )
    assert len(re.findall(r"r=rpl_min_2\(0\.0[34], point_dist\(.*spot.*\) \* 0\.4999\)", text)) == 2
    assert [name for name, _ in told].count("corner-from-way") == 2


def test_the_later_corner_takes_what_is_left() -> None:
    """Every pass goes from one computed place to the next."""
    text, told = computed(
        "MoveL base,v100,fine,tool0;",
        "FOR i FROM 1 TO n DO",
        "spot:=Offs(base,i*n,0,0);",
        "MoveL spot,v100,z40,tool0;",
        "ENDFOR",
        "MoveL base,v100,fine,tool0;",
    )
    assert "r=rpl_min_2(0.04, rpl_max_2(0.0, point_dist(spot, rpl_corner) - 0.04002)))" in text
    assert text.count("rpl_corner = ") >= 2
    assert ("corner-from-way", 10) in told
