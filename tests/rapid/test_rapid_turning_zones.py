"""Zones beside which the tool turns, written in other languages and out of them: the corner keeps its size.

ABB RAPID Reference Manual, zonedata: a zone is reduced to the smallest of its sizes relative to the motion.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

NOWHERE = "[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]"


def module(last: str, zone: str = "z20") -> str:
    return f"""MODULE m
PROC main()
ConfJ\\Off; ConfL\\Off;
MoveAbsJ [[0,10,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
MoveL [[400,-100,400],[0,0,1,0],{NOWHERE}],v100,fine,tool0;
MoveL [[400,0,400],[0,0,1,0],{NOWHERE}],v100,{zone},tool0;
MoveL [[500,0,400],{last},{NOWHERE}],v100,fine,tool0;
ENDPROC
ENDMODULE
"""


def translated(text: str, source: str, target: str) -> tuple[str, list[str]]:
    suffix = {"rapid": ".mod", "krl": ".src"}[source]
    diagnostics = Diagnostics()
    program = read_sources([source_from_text(f"m{suffix}", text)], source, diagnostics).program
    read = ReadProgram(program, program, (), (), (source,))
    found = translate_program(read, target, None, None, diagnostics)
    return "\n".join(file.data.decode("latin-1") for file in found.files), [item.code.name for item in diagnostics]


TURN_60, TURN_10, NO_TURN = "[0,0.5,0.8660254,0]", "[0,0.0871557,0.9961947,0]", "[0,0,1,0]"


@pytest.mark.parametrize(
    ("target", "reduced", "whole"),
    [("krl", "$APO.CDIS=5", "$APO.CDIS=20"), ("urscript", "r=0.005", "r=0.02"), ("tp", "CNT75", "CNT100")],
)
def test_a_reduced_zone_is_written_with_its_size(target: str, reduced: str, whole: str) -> None:
    """60 degrees over 100 mm: 3/60 of 100 is 5 mm; as CNT at 100 mm/s 75 (20 mm: more than that controller drives)."""
    text, codes = translated(module(TURN_60), "rapid", target)
    assert reduced in text and whole not in text
    assert "zone-reduced" in codes
    text, codes = translated(module(NO_TURN), "rapid", target)
    assert whole in text
    assert not {"zone-reduced", "zone-of-tool-lost"} & set(codes)


def test_that_the_tool_begins_to_turn_earlier_is_told_once() -> None:
    """10 degrees over 100 mm: 30 mm for the tool, 20 mm for the path."""
    text, codes = translated(module(TURN_10), "rapid", "krl")
    assert "$APO.CDIS=20" in text
    assert codes.count("zone-of-tool-lost") == 1 and "zone-reduced" not in codes


@pytest.mark.parametrize(("angle", "zone"), [(30, "z20Turning"), (5, "z20")])
def test_a_corner_of_another_language_keeps_its_size(angle: int, zone: str) -> None:
    """z20 would be reduced by 30 degrees over 100 mm, whose share of 20 mm is 6 degrees."""
    lines = (
        "DEF M( )", "BAS(#INITMOV,0)", "$TOOL=$NULLFRAME", "$BASE=$NULLFRAME", "$VEL.CP=0.1", "$APO.CDIS=20",
        "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}",
        "LIN {X 450,Y 0,Z 400,A 0,B 135,C 0}",
        "LIN {X 450,Y 100,Z 400,A 0,B 135,C 0} C_DIS",
        f"LIN {{X 550,Y 100,Z 400,A {angle},B 135,C 0}}",
        "END",
    )  # fmt: skip
    text, _ = translated("\n".join(lines), "krl", "rapid")
    (line,) = [line for line in text.splitlines() if "[450,100,400]" in line and "MoveL" in line]
    assert f",{zone}," in line
    # a turn of 180 degrees never makes the zone smaller, so that one datum serves all moves
    assert ("CONST zonedata z20Turning:=[FALSE,20,20,30,180,30,3];" in text) == (angle == 30)


def test_zones_of_the_same_language_stay() -> None:
    text, codes = translated(module(TURN_60), "rapid", "rapid")
    assert "z20" in text and "zone-reduced" not in codes
