"""Faults of the controller that REACTE catches: where the target stops at them, it looks in front."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 AUTO u, z
 errs = 0
 z = 0
 REACTE bad
 u = 4/z
 u = SQRT(z-1)+1
 u = SQRT(16)/2
 REACTE
 IF (errs == 2) AND (u == 2) AND (code < 0) THEN
 SIGNAL 1
 END
.END
.PROGRAM bad()
 errs = errs+1
 code = ERROR(-1)
 RETURNE
.END
"""


@pytest.mark.parametrize("target", ["krl", "tp", "urscript", "inform", "vplus", "rpl"])
def test_divisions_and_roots_come_to_the_routine(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    assert run_program(source.program, "adept_viper_s650", None, "main").outputs
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(files, target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and len(result.outputs) == 1
