"""Steps behind a corner that ask for what is now: the robot stops at that corner, and that is told once."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import parse_cell
from tests.there_and_back import Journey, there_and_back

ABB = "abb_irb1200_5_90"
HEAD = """MODULE Corner
  PERS tooldata tPen:=[TRUE,[[0,0,140],[1,0,0,0]],[0.9,[0,0,60],[1,0,0,0],0,0,0]];
  CONST jointtarget jStart:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pA:=[[400,-50,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pB:=[[500,-50,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pC:=[[500,50,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR pos p;
  VAR num n;
  VAR clock ck;
  PROC main()
    MoveAbsJ jStart,v1000,fine,tPen;
    MoveL pA,v100,fine,tPen;
    ClkReset ck;
    ClkStart ck;
    SetDO do7,1;
    MoveL pB,v100,z20,tPen;
"""
TAIL = """
    MoveL pC,v100,fine,tPen;
    SetDO do9,1;
  ENDPROC
ENDMODULE
"""
CELL = """
[[reaction]]
when = "do3"
after = 0.3
signal = "di3"
value = true

[[reaction]]
when = "do7"
after = 0.9
signal = "di5"
value = true
"""

CASES = {
    "a place": "p:=CPos(\\Tool:=tPen\\WObj:=wobj0);\nIF p.x>465 AND p.x<481 SetDO do1,1;",
    "a time": "n:=ClkRead(ck);\nIF n>0.6 AND n<0.9 SetDO do1,1;",
    "an answer": "SetDO do3,1;\nWaitDI di3,1;\nIF ClkRead(ck)>0.9 AND ClkRead(ck)<1.2 SetDO do1,1;",
    "a choice": "IF di5=0 THEN\nSetDO do1,1;\nELSE\nSetDO do2,1;\nENDIF",
}


def written(steps: str, target: str) -> Journey:
    return there_and_back({"Corner.mod": HEAD + steps + TAIL}, "rapid", target, ABB)


@pytest.mark.parametrize("target", ["krl", "vplus"])
@pytest.mark.parametrize("case", CASES)
def test_the_robot_stops_at_the_corner(case: str, target: str) -> None:
    journey = written(CASES[case], target)
    result = journey.run(cell=parse_cell(CELL, "cell.toml"))
    assert result.status == "finished"
    assert [item.origin.line for item in journey.found if item.code.name == "corner-stops-behind"] == [16]
    assert not journey.losses


KEPT_AS_THEY_ARE = {
    "an output alone": "SetDO do1,1;",
    "numbers": "n:=n+1;",
    "a pause": "WaitTime 0.5;",
    "a loop that asks": "WHILE di5=0 DO\nWaitTime 0.1;\nENDWHILE",
}


@pytest.mark.parametrize("case", KEPT_AS_THEY_ARE)
def test_other_steps_leave_the_corner(case: str) -> None:
    assert "corner-stops-behind" not in {item.code.name for item in written(KEPT_AS_THEY_ARE[case], "vplus").found}
