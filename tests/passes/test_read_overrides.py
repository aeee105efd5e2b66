"""An override that a program sets and reads, in languages whose programs can only set it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "fanuc_lrmate200id"
PROGRAM = """/PROG  OVERR
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  R[1]=$MCR.$GENOVERRIDE ;
   2:  DO[1]=(R[1]=100) ;
   3:  OVERRIDE=30% ;
   4:  R[1]=$MCR.$GENOVERRIDE ;
   5:  DO[2]=(R[1]=30) ;
   6:  IF ($MCR.$GENOVERRIDE<50),DO[3]=(ON) ;
   7:  OVERRIDE=100% ;
/POS
/END
"""


def _on(record: Record) -> set[str]:
    happenings = [each for group in record.tasks.values() for each in group if each.kind == "output" and each.value]
    return {name for each in happenings for name in each.names if name.startswith("digital_out:")}


@pytest.mark.parametrize("target", ["rapid", "vplus", "tp", "krl", "rpl"])
def test_what_was_set_is_read(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("OVERR.LS", PROGRAM)], "tp", diagnostics)
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    assert not translation.losses
    assert ("override-kept" in {item.code.name for item in diagnostics}) == (target in ("rapid", "vplus"))
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, diagnostics)
    assert not diagnostics.has_errors
    named = with_signal_names(back.program, translation.program)
    result = run_program(named, ROBOT, None, entry_name(named), 10.0)
    assert result.status == "finished"
    assert _on(record_of(result, named)) == {"digital_out:1", "digital_out:2", "digital_out:3"}
