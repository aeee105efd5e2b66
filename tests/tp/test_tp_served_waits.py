"""A wait that also serves an interrupt takes its time: the steps that it counts are those that it waits."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import Cell, Input
from tests.there_and_back import there_and_back

PROGRAM = """MODULE Waits
  VAR intnum iLow;
  VAR num nLow:=0;

  PROC main()
    VAR clock ck;
    VAR bool bLate;
    CONNECT iLow WITH tLow;
    MoveAbsJ [[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;
    ISignalDI diLow,1,iLow;
    ClkReset ck;
    ClkStart ck;
    WaitUntil diClear=1\\MaxTime:=2\\TimeFlag:=bLate;
    ClkStop ck;
    IF bLate AND Abs(ClkRead(ck)-2)<0.1 SetDO do1,1;
    ClkReset ck;
    ClkStart ck;
    WaitTime 2;
    ClkStop ck;
    IF Abs(ClkRead(ck)-2)<0.1 SetDO do2,1;
    WaitTime 3;
    IDelete iLow;
    IF nLow=1 SetDO do3,1;
  ENDPROC

  TRAP tLow
    nLow:=nLow+1;
    WaitTime 0.5;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize("target", ["tp", "inform", "urscript"])
def test_a_wait_beside_an_interrupt_is_as_long_as_said(target: str) -> None:
    journey = there_and_back({"waits.mod": PROGRAM}, "rapid", target, "abb_irb1200_5_90")
    assert journey.losses == []
    result = journey.run("main", Cell(inputs=(Input(6.0, "diLow", True),)))
    assert result.fault is None
    assert journey.switched_on(result) >= {1, 2, 3}
