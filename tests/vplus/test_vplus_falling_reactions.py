"""REACT and REACTI on a signal that goes off (a number with a minus), in every language."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 n = 0
 REACT -1003, gone, 20
 WAIT.EVENT , 0.5
 IF n == 1 THEN
 SIGNAL 1
 END
 IGNORE -1003
 WAIT.EVENT , 0.5
 IF n == 1 THEN
 SIGNAL 2
 END
.END
.PROGRAM gone()
 n = n+1
.END
"""
CELL = """[[input]]
time = 0.0
signal = "di3"
value = true
duration = 0.2

[[input]]
time = 0.6
signal = "di3"
value = true
duration = 0.2
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript", "vplus"])
def test_the_reaction_is_carried_over(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    cell = in_words_of(parse_cell(CELL), source.program, back.program)
    result = run_program(back.program, "adept_viper_s650", cell, translation.renamed.get("main", "main"))
    assert result.status == "finished" and sum(bool(value) for _, _, value in result.outputs) >= 2
