"""Groups of signals with computed numbers, where a target has none: signal by signal."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

JOB = """/JOB
//NAME BYTES
//POS
///NPOS 0,0,0,0,0,0
//INST
///DATE 2025/01/10 10:00
///ATTR SC,RW
NOP
FOR I000=2 TO 2
DOUT OG#(I000) 129
DIN D001 OG#(I000)
NEXT I000
SET B000 4
DOUT OGH#(B000) 6
WAIT IG#(B000)=0
JUMP *NO IF D001<>129
JUMP *NO IF OG#(2)<>97
DOUT OT#(1) ON
*NO
END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "rpl", "tp", "urscript", "vplus", "inform"])
def test_each_signal_is_written_and_read(target: str) -> None:
    journey = there_and_back({"BYTES.JBI": JOB}, "inform", target)
    assert not journey.losses
    result = journey.run("BYTES")
    on = [value for _, _, value in result.outputs]
    assert (result.status, len(on), on[-1]) == ("finished", 6, True), result.fault


PULSED = """/JOB
//NAME PULSED
//POS
///NPOS 0,0,0,0,0,0
//INST
///DATE 2025/01/10 10:00
///ATTR SC,RW
NOP
SET B000 11
SET I000 50
PULSE OT#(B000) T=I000
TIMER T=1.00
END
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "rpl", "urscript", "vplus", "inform"])
def test_a_pulse_of_a_computed_signal(target: str) -> None:
    journey = there_and_back({"PULSED.JBI": PULSED}, "inform", target)
    assert not journey.losses
    result = journey.run("PULSED")
    assert result.status == "finished", result.fault
    (rises, _, on), (falls, _, off) = result.outputs
    assert (on, off) == (True, False) and falls - rises == pytest.approx(0.5, abs=0.05)
