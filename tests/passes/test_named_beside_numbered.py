"""Signals by name beside signals by number: a name gets a number that the program does not use, and flags by a
computed number stay flags."""

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

ROBOT = "fanuc_lrmate200id"
SOURCE = """/PROG  SIGS
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  FOR R[1]=11 TO 14 ;
   2:  F[R[1]]=(ON) ;
   3:  ENDFOR ;
   4:  F[13]=(OFF) ;
   5:  DO[1]=(F[11] AND F[14] AND !F[13]) ;
   6:  RO[3]=ON ;
   7:  DO[2]=ON ;
   8:  RO[3]=OFF ;
   9:  DO[3]=(DO[1] AND !RO[3]) ;
/POS
/END
"""


def _on_at_the_end(record: Record) -> set[str]:
    state: dict[str, bool] = {}
    for happenings in record.tasks.values():
        for each in happenings:
            if each.kind == "output":
                for name in each.names:
                    state[name] = bool(each.value)
    return {name for name, on in state.items() if on and name in ("digital_out:1", "digital_out:2", "digital_out:3")}


@pytest.mark.parametrize("target", ["rapid", "rpl", "krl", "tp", "urscript", "vplus", "inform"])
def test_a_named_output_takes_no_numbered_one(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("SIGS.LS", SOURCE)], "tp", diagnostics)
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    assert not translation.losses
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    named = with_signal_names(back.program, translation.program)
    run = run_program(named, ROBOT, None, translation.renamed.get("SIGS", "SIGS") if target != "krl" else None, 10.0)
    assert run.status == "finished"
    assert _on_at_the_end(record_of(run, named)) == {"digital_out:1", "digital_out:2", "digital_out:3"}
