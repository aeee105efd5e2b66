"""Groups of signals with computed numbers, where a target has none: signal by signal."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

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
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("BYTES.JBI", JOB)], "inform", Diagnostics())
    translation = translate_program(read, target, None, None, diagnostics)
    assert [item.as_text() for item in diagnostics.of(Severity.LOSS)] == []
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again]
    result = run_program(back.program, None, None, translation.renamed.get("BYTES", "BYTES"))
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
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("PULSED.JBI", PULSED)], "inform", Diagnostics())
    translation = translate_program(read, target, None, None, diagnostics)
    assert [item.as_text() for item in diagnostics.of(Severity.LOSS)] == []
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again]
    result = run_program(back.program, None, None, translation.renamed.get("PULSED", "PULSED"))
    assert result.status == "finished", result.fault
    (rises, _, on), (falls, _, off) = result.outputs
    assert (on, off) == (True, False) and falls - rises == pytest.approx(0.5, abs=0.05)
