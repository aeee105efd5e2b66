"""A wait for a condition or a timer that has just been started is a wait with a time limit where the target has one."""

from __future__ import annotations

import pytest
from there_and_back import there_and_back

from rpl.cell import Cell, Input

KRL = """DEF main()
  $OUT[1]=TRUE
  REPEAT
    $TIMER[1]=-1500
    $TIMER_STOP[1]=FALSE
    WAIT FOR $IN[2] OR $TIMER_FLAG[1]
    $TIMER_STOP[1]=TRUE
    IF NOT $IN[2] THEN
      $OUT[3]=TRUE
    ENDIF
  UNTIL $IN[2]
  $OUT[1]=FALSE
END
"""
ASKED = KRL.replace("  $OUT[1]=FALSE\n", "  IF $TIMER[1]>-500 THEN\n    $OUT[4]=TRUE\n  ENDIF\n  $OUT[1]=FALSE\n")
LIMITS = {"tp": "$WAITTMOUT=150", "inform": "WAIT IN#(2)=ON T=1.50", "rapid": "\\MaxTime:=1.5"}
CELL = Cell(inputs=(Input(2.0, "$IN[2]", True),))


@pytest.mark.parametrize("target", LIMITS)
def test_a_timer_that_nothing_else_reads_is_the_limit_of_the_wait(target: str) -> None:
    journey = there_and_back({"main.src": KRL}, "krl", target)
    assert not journey.losses
    assert LIMITS[target] in journey.text
    outputs = [(round(at, 1), value) for at, _, value in journey.run(cell=CELL).outputs]
    assert outputs == [(0.0, True), (1.5, True), (2.0, False)]


def test_a_timer_that_is_read_stays() -> None:
    assert "TIMER[1]" in there_and_back({"main.src": ASKED}, "krl", "tp").text


RAPID = """MODULE m
  PROC main()
    SetDO do1,1;
    WaitDI di2,1\\MaxTime:=1.5;
    SetDO do1,0;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      SetDO do3,1;
      RETRY;
    ENDIF
  ENDPROC
ENDMODULE
"""


def test_retry_jumps_back_in_tp() -> None:
    text = there_and_back({"m.mod": RAPID}, "rapid", "tp").text
    assert "JMP LBL[1]" in text and "F[" not in text and "R[" not in text
