"""Pulses to the opposite of what an output is, of outputs that the program has names for."""

import pytest

from rpl.diagnostics import Severity
from tests.there_and_back import there_and_back

TEXT = """MODULE Pump
  PROC main()
    PulseDO\\PLength:=0.3,doPump;
    WaitTime 0.1;
    IF DOutput(doPump)=1 SetDO do1,1;
    WaitTime 0.5;
    IF DOutput(doPump)=0 SetDO do2,1;
    Set doPump;
    PulseDO\\PLength:=0.3,doPump;
    WaitTime 0.1;
    IF DOutput(doPump)=0 SetDO do3,1;
    WaitTime 0.5;
    IF DOutput(doPump)=1 SetDO do4,1;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("language", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"])
def test_high_from_low_and_low_from_high(language: str) -> None:
    journey = there_and_back({"Pump.mod": TEXT}, "rapid", language)
    assert not journey.losses
    result = journey.run()
    assert result.fault is None and {1, 2, 3, 4} <= journey.switched_on(result)


GIVEN = """MODULE Bell
  PROC main()
    Ring doBell;
    WaitTime 0.1;
    IF DOutput(doBell)=1 SetDO do1,1;
    WaitTime 0.5;
    IF DOutput(doBell)=0 SetDO do2,1;
  ENDPROC
  PROC Ring(VAR signaldo doWhich)
    PulseDO\\PLength:=0.3,doWhich;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("language", ["tp", "inform"])
def test_an_output_that_a_routine_is_given(language: str) -> None:
    """From low it is a pulse; only where it is on already the program would stop."""
    journey = there_and_back({"Bell.mod": GIVEN}, "rapid", language)
    assert [item.origin.line for item in journey.found.of(Severity.LOSS)] == [10]
    result = journey.run()
    assert result.status == "finished" and {1, 2} <= journey.switched_on(result)
