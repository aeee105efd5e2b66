"""A place less itself (`PR[1]=LPOS-LPOS`, `SUB P010 P010`) in languages without sums of places."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

ROBOT = "fanuc_lrmate200id"
HEAD = "/PROG  SHIFT\n/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n"
POINTS = """/POS
P[1]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   500.000  mm,	Y =     0.000  mm,	Z =   400.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
"""
SHIFTED = "   1:  PR[1]=LPOS-LPOS ;\n   2:  PR[1,1]=R[1]*10 ;\n   3:L P[1] 100mm/sec FINE Offset,PR[1] ;\n"
SEEN = SHIFTED + "   4:  R[2]=PR[1,1] ;\n"
DRIVEN = "   1:  PR[1]=LPOS-LPOS ;\n   2:  PR[1,1]=500 ;\n   3:L PR[1] 100mm/sec FINE ;\n"


def _read(lines: str) -> ReadProgram:
    return read_sources([source_from_text("shift.ls", HEAD + lines + POINTS)], "tp", Diagnostics())


def _written(lines: str, target: str) -> list[str]:
    files = translate_program(_read(lines), target, ROBOT, None, Diagnostics()).files
    return [line.strip() for one in files for line in one.data.decode("utf-8").splitlines()]


@pytest.mark.parametrize(
    ("target", "line"),
    [
        ("krl", "PR1={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}"),
        ("rapid", "PR1:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"),
    ],
)
def test_a_place_that_only_shifts_is_set_as_a_whole(target: str, line: str) -> None:
    assert line in _written(SEEN, target)


def test_one_that_nothing_else_looks_at_is_a_way_in_the_move() -> None:
    written = _written(SHIFTED, "rapid")
    assert any("Offs(P1,R1*10,0,0)" in line for line in written)
    assert not any("PR1" in line for line in written)


@pytest.mark.parametrize("target", ["krl", "rapid"])
def test_a_place_that_is_driven_to_keeps_the_posture_of_the_robot(target: str) -> None:
    assert any("$POS_ACT" in line or "CRobT" in line for line in _written(DRIVEN, target))
