"""Signals as parameters in targets whose signals have numbers: what each call switches is the signal it named."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "abb_irb1200_5_90"
SOURCE = """MODULE m
  PROC main()
    Expect do1,TRUE;
    Expect do2,FALSE;
    Copy do1,do3;
    Copy do2,do5;
    IF Level(do3)=1 AND Level(do2)=0 Set do7;
  ENDPROC
  PROC Expect(VAR signaldo sig,bool holds)
    IF holds THEN
      SetDO sig,1;
    ELSE
      SetDO sig,0;
    ENDIF
  ENDPROC
  PROC Copy(VAR signaldo a,VAR signaldo b)
    WaitTime 0.1;
    IF a=1 Set b;
    IF a=1 AND DOutput(b)=1 Expect do12,TRUE;
    IF a=0 InvertDO b;
  ENDPROC
  FUNC num Level(VAR signaldo s)
    RETURN s;
  ENDFUNC
ENDMODULE
"""


def _switched(record: Record) -> list[tuple[set[str], object]]:
    """The outputs by their numbers, in the order they were switched."""
    return [
        ({name for name in each.names if name.startswith("digital_out:")}, each.value)
        for happenings in record.tasks.values()
        for each in happenings
        if each.kind == "output"
    ]


@pytest.mark.parametrize("target", ["rapid", "rpl", "krl", "tp", "urscript", "vplus", "inform"])
def test_every_call_switches_its_own_signal(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", SOURCE)], "rapid", diagnostics)
    theirs = record_of(run_program(read.program, ROBOT, None, "main", 10.0), read.program)
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    named = with_signal_names(back.program, translation.program)
    entry = translation.renamed.get("main", "main") if target != "krl" else None
    run = run_program(named, ROBOT, None, entry, 10.0)
    assert run.status == "finished"
    ours = record_of(run, named)

    assert _switched(ours) == _switched(theirs)


CALCULATED = """/PROG  LAMPS
/MN
   1:  FOR R[1]=1 TO 18 ;
   2:  DO[R[1]]=ON ;
   3:  ENDFOR ;
   4:  RO[1]=OFF ;
   5:  GO[1]=0 ;
   6:  DO[3]=OFF ;
/POS
/END
"""


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "vplus", "inform"])
def test_chosen_numbers_keep_off_calculated_ones(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("LAMPS.LS", CALCULATED)], "tp", diagnostics)
    translation = translate_program(read, target, "fanuc_lrmate200id", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    named = with_signal_names(back.program, translation.program)
    entry = translation.renamed.get("LAMPS", "LAMPS")
    run = run_program(named, "fanuc_lrmate200id", None, entry, 10.0)
    assert run.status == "finished"
    on = {names.pop(): value for names, value in _switched(record_of(run, named)) if len(names) == 1}
    lamps = {f"digital_out:{number}": number != 3 for number in range(1, 19)}
    assert {name: on[name] for name in lamps} == lamps


GIVES = """/PROG  GIVES
/MN
   1:  SEMAPHORE[1]=OFF ;
   2:  R[3]=5 ;
   2:  R[2]=0 ;
   2:  RUN TAKES ;
   3:  F[R[3]]=ON ;
   4:  WAIT    .20(sec) ;
   5:  SEMAPHORE[1]=ON ;
   6:  WAIT    .20(sec) ;
   7:  DO[1]=(R[2]=7) ;
/POS
/END
"""
TAKES = """/PROG  TAKES
/MN
   1:  WAIT SEMAPHORE[1] ;
   2:  R[2]=7 ;
/POS
/END
"""


@pytest.mark.parametrize("target", ["rapid", "rpl", "krl", "tp", "urscript", "vplus", "inform"])
def test_flags_that_have_a_name_are_data(target: str) -> None:
    diagnostics = Diagnostics()
    sources = [source_from_text("GIVES.LS", GIVES), source_from_text("TAKES.LS", TAKES)]
    read = read_sources(sources, "tp", diagnostics)
    translation = translate_program(read, target, "fanuc_lrmate200id", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    entry = translation.renamed.get("GIVES", "GIVES") if target != "rapid" else None
    run = run_program(back.program, "fanuc_lrmate200id", None, entry, 10.0)
    assert [each[2] for each in run.outputs] == [True]
