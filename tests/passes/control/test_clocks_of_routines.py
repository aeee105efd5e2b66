"""Stop watches of routines in languages whose stop watches are data of the whole program."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TEXT = """MODULE Times
  PROC main()
    IF Taken(0.5)<0.6 SetDO do1,1;
    IF Taken(0.3)<0.4 SetDO do2,1;
    IF Taken(0.5)>0.4 SetDO do3,1;
    IF Fresh() AND Fresh() SetDO do4,1;
  ENDPROC
  FUNC num Taken(num nSeconds)
    VAR clock ck;
    ClkReset ck;
    ClkStart ck;
    WaitTime nSeconds;
    ClkStop ck;
    RETURN ClkRead(ck);
  ENDFUNC
  FUNC bool Fresh()
    VAR clock ck;
    VAR bool bZero;
    WaitTime 0.3;
    bZero:=ClkRead(ck)<0.1;
    ClkStart ck;
    WaitTime 0.3;
    RETURN bZero;
  ENDFUNC
ENDMODULE
"""


@pytest.mark.parametrize("language", ["rapid", "krl", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_watch_is_new_in_each_call(language: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Times.mod", TEXT)], "rapid", diagnostics)
    translation = translate_program(read, language, "abb_irb1200_5_90", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    written = [source_from_bytes(one.path, one.data) for one in translation.files]
    back = with_signal_names(read_sources(written, language, Diagnostics()).program, translation.program)
    result = run_program(back, "abb_irb1200_5_90", None, translation.renamed.get("main", "main"), 60)
    assert result.fault is None
    happenings = [one for task in record_of(result, back).tasks.values() for one in task]
    assert [one.value for one in happenings if one.kind == "output"] == [True] * 4


def test_a_watch_that_is_reset_first_needs_no_other_reset() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Times.mod", TEXT)], "rapid", diagnostics)
    (file,) = translate_program(read, "urscript", None, None, diagnostics).files
    text = file.data.decode()
    assert (
        text.count(" = 0.0") == 2 + 2
    )  # where they are declared, the reset of one, and where the other's routine begins


STOPPED = """MODULE Stopped
  VAR clock ck;
  PROC main()
    ClkReset ck;
    ClkStart ck;
    WaitTime 0.5;
    ClkStop ck;
    WaitTime 0.5;
    IF ClkRead(ck)<0.6 SetDO do1,1;
    ClkStart ck;
    WaitTime 0.3;
    ClkStop ck;
    WaitTime 1;
    IF ClkRead(ck)>0.75 AND ClkRead(ck)<0.9 SetDO do2,1;
    ClkReset ck;
    WaitTime 0.2;
    IF ClkRead(ck)=0 SetDO do3,1;
  ENDPROC
ENDMODULE
"""


def test_a_stopped_watch_keeps_its_time_where_timers_always_run() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Stopped.mod", STOPPED)], "rapid", diagnostics)
    (file,) = translate_program(read, "vplus", "adept_viper_s650", None, diagnostics).files
    assert not list(diagnostics), [one.as_text() for one in diagnostics]
    back = read_sources([source_from_bytes(file.path, file.data)], "vplus", Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, "main", 20)
    assert [name for _, name, value in result.outputs if value] == ["1", "2", "3"]
