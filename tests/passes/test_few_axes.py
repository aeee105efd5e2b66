"""Steps that are written for any arm, on a SCARA."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TEXT = """.PROGRAM main()
 AUTO REAL q[8]
 MOVE #PPOINT(10,80,30,5)
 ALIGN
 BREAK
 HERE #arm
 DECOMPOSE q[1] = #arm
 IF (ABS(q[2]-80) < 0.1) AND (ABS(q[4]-5) < 0.1) THEN
 SIGNAL 1
 END
.END
"""


@pytest.mark.parametrize("target", ["rapid", "krl", "urscript", "inform", "tp"])
def test_the_joints_that_it_has_are_there(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", TEXT)], "vplus", diagnostics)
    done = translate_program(read, target, "adept_cobra_s600", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    result = run_program(back.program, "adept_cobra_s600", entry=done.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]
