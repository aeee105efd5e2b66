"""Numbers of interrupts that a routine declares: in every language."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

HANDLES = """MODULE Job
  VAR num a:=0;
  VAR num b:=0;
  PROC main()
    One;
    Two;
    IF a=2 AND b=1 SetDO do1,1;
  ENDPROC
  PROC One()
    VAR intnum i;
    CONNECT i WITH tA;
    ISignalDO do5,1,i;
    SetDO do5,1;
    WaitTime 0.1;
    Reset do5;
    WaitTime 0.1;
    Two;
    SetDO do5,1;
    WaitTime 0.1;
    IDelete i;
    Reset do5;
  ENDPROC
  PROC Two()
    VAR intnum i;
    IF b>0 RETURN;
    CONNECT i WITH tB;
    ISignalDO do6,1,i;
    SetDO do6,1;
    WaitTime 0.1;
    Reset do6;
    IDelete i;
  ENDPROC
  TRAP tA
    Incr a;
  ENDTRAP
  TRAP tB
    Incr b;
  ENDTRAP
ENDMODULE
"""
LANGUAGES = ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"]


@pytest.mark.parametrize("language", LANGUAGES)
def test_numbers_of_interrupts_in_a_routine(language: str) -> None:
    journey = there_and_back({"Job.mod": HANDLES}, "rapid", language, "abb_irb1200_5_90")
    assert not journey.losses
    result = journey.run()
    assert result.fault is None and 1 in journey.switched_on(result)
