"""No program that is written makes its controller leave a move out: for every sample, in every target whose controller
does that. Source: URScript Manual 5.2, movej (a move is skipped whose blend overlaps with the one before or behind)."""

from __future__ import annotations

from pathlib import Path

import pytest
from outcomes import model_of
from test_conformance_samples import SAMPLES, expected, name_of, programs_of

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.passes.scope import rules_of
from rpl.project import read_sources
from rpl.proof.postures import left_out
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes
from rpl.translation import translate_program

LEAVING_OUT = [name for name in registry.target_names() if rules_of(name).inputs.overlapping_blends]


@pytest.mark.parametrize("target", LEAVING_OUT)
@pytest.mark.parametrize("sample", SAMPLES, ids=name_of)
def test_what_is_written_leaves_no_move_out(sample: Path, target: str) -> None:
    if sample.parent.name == target:
        pytest.skip("written in that language")
    read, wanted = programs_of(sample), expected(sample)
    given, around = (wanted.cell.variables, wanted.cell.mechanisms) if wanted.cell is not None else (None, ())
    written = translate_program(read, target, wanted.robot, None, Diagnostics(), given=given, mechanisms=around)
    back = read_sources([source_from_bytes(one.path, one.data) for one in written.files], target, Diagnostics())
    program = with_signal_names(back.program, written.program)
    entry = entry_name(read.program, wanted.entry)
    cell = in_words_of(wanted.cell, read.program, program) if wanted.cell is not None else None
    result = run_program(program, model_of(wanted.robot), cell, written.renamed.get(entry, entry) if entry else None)
    assert {task: [str(one.place) for one in moves] for task, moves in left_out(result.trace).items()} == {}
