"""A choice by data that only ever holds some members: cases that nothing leads to are no loss for a target."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """&ACCESS RVP1
DEF forms( )
DECL FDAT HELD
DECL FDAT TAKEN
HELD={{TOOL_NO 0,BASE_NO 0,IPO_FRAME #{mode}}}
TAKEN=HELD
$IPO_MODE=TAKEN.IPO_FRAME
$OUT[1]=TRUE
END
"""


@pytest.mark.parametrize("target", ["tp", "rapid", "urscript", "vplus", "inform"])
def test_a_mode_that_nobody_chooses_is_no_loss(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("forms.src", PROGRAM.format(mode="BASE"))], "krl", Diagnostics())
    written = translate_program(read, target, None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("forms", "forms")
    assert [value for _, _, value in run_program(back.program, entry=entry).outputs] == [True]


def test_a_mode_that_somebody_chooses_is() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("forms.src", PROGRAM.format(mode="TCP"))], "krl", Diagnostics())
    translate_program(read, "tp", None, None, diagnostics)
    assert [item.code.name for item in diagnostics.of(Severity.LOSS)] == ["tp-guarded-stop"]
