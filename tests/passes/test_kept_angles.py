"""Single angles of places that are written with B beyond 90 degrees, in languages that keep rotations.

A controller that keeps what was written (KRL FRAME: components of a structure) says A 0, B 180, C 0 again; one that
keeps quaternions, matrices or rotation vectors says A 180, B 0, C 180 for the same place.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Severity
from tests.there_and_back import there_and_back

DATA = """DEFDAT JOB
DECL FRAME UP={X 1.0,Y 2.0,Z 3.0,A 10.0,B 0.0,C 0.0}
DECL FRAME DOWN={X 1.0,Y 2.0,Z 3.0,A 10.0,B 180.0,C 0.0}
DECL FRAME LIST[2]
LIST[1]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 180.0,C 0.0}
LIST[2]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
ENDDAT
"""
CASES = {
    "in the usual range": ("R=UP.A", []),
    "read": ("R=DOWN.A", [5]),
    "an element": ("R=LIST[2].A", [5]),
    "set alone": ("DOWN.A=20.0", [5]),
    "set by a difference": ("DOWN.A=DOWN.A+20.0", []),
    "B by a difference": ("DOWN.B=DOWN.B+5.0", [5]),
    "all three": ("DOWN.A=20.0\nDOWN.B=0.0\nDOWN.C=0.0", []),
    "the rest of it": ("R=DOWN.X", []),
    "a copy": ("F=DOWN\nR=F.C", [6]),
    "another's copy": ("F=UP\nR=F.C", []),
    "a product": ("F=DOWN:UP\nR=F.A", []),
    "an argument": ("R=ANGLE(DOWN)", [9]),
    "another argument": ("R=ANGLE(UP)", []),
    "a result": ("F=MADE( )\nR=F.A", [6]),
    "set anew": ("F=$NULLFRAME\nF.X=3.0\nF.B=180.0", []),
    "set and read": ("F=$NULLFRAME\nF.B=180.0\nR=F.A", [7]),
    "set twice": ("F.B=180.0", [5]),
}
PROGRAM = """DEF JOB( )
DECL FRAME F
DECL REAL R

{body}
END
DEFFCT REAL ANGLE(P:IN)
FRAME P
RETURN P.A
ENDFCT
DEFFCT FRAME MADE( )
RETURN DOWN
ENDFCT
"""


@pytest.mark.parametrize("target", ["rapid", "urscript", "vplus"])
@pytest.mark.parametrize("case", CASES)
def test_what_comes_from_another_of_the_equal_forms_is_named(case: str, target: str) -> None:
    body, lines = CASES[case]
    program = PROGRAM.format(body=body)
    journey = there_and_back({"job.src": program, "job.dat": DATA}, "krl", target, "kuka_kr6r900sixx")
    found = [item for item in journey.found.of(Severity.LOSS) if item.code.name == "angles-normalised"]
    assert [item.origin.line for item in found] == lines


@pytest.mark.parametrize("target", ["krl", "tp", "inform", "rpl"])
def test_languages_that_keep_the_angles_name_nothing(target: str) -> None:
    program = PROGRAM.format(body="R=DOWN.A\n$OUT[1]=R==10.0")
    journey = there_and_back({"job.src": program, "job.dat": DATA}, "krl", target, "kuka_kr6r900sixx")
    assert "angles-normalised" not in journey.losses
    assert 1 in journey.switched_on(journey.run("JOB"))
