"""Pulses to the opposite of what an output is, of outputs that the program has names for."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

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
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Pump.mod", TEXT)], "rapid", diagnostics)
    translation = translate_program(read, language, None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = with_signal_names(read_sources(written, language, Diagnostics()).program, translation.program)
    result = run_program(back, None, None, translation.renamed.get("main", "main"), 60)
    assert result.fault is None
    happenings = [one for task in record_of(result, back).tasks.values() for one in task if one.kind == "output"]
    marks = {name for one in happenings for name in one.names if one.value and name.startswith("digital_out:")}
    assert {f"digital_out:{number}" for number in (1, 2, 3, 4)} <= marks


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
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Bell.mod", GIVEN)], "rapid", diagnostics)
    translation = translate_program(read, language, None, None, diagnostics)
    assert [item.origin.line for item in diagnostics.of(Severity.LOSS)] == [10]
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = with_signal_names(read_sources(written, language, Diagnostics()).program, translation.program)
    result = run_program(back, None, None, translation.renamed.get("main", "main"), 60)
    assert result.status == "finished"
    happenings = [one for task in record_of(result, back).tasks.values() for one in task if one.kind == "output"]
    marks = {name for one in happenings for name in one.names if one.value and ":" in name}
    assert {"digital_out:1", "digital_out:2"} <= marks
