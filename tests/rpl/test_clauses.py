"""Every word of RPL in its contexts: what the manual says of it holds in the run, and behind the translations named."""

from __future__ import annotations

import itertools

import pytest
from clause_tables import FOLDER, Clause, clauses, program_of

from rpl.cell import Cell, read_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.proof.record import signal_names
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

KUKA = "kuka_kr6r900sixx"
CLAUSES = clauses()
TABLES = {name: list(rows) for name, rows in itertools.groupby(CLAUSES, lambda clause: clause.table)}
ALONE = [(clause, target) for clause in CLAUSES for target in clause.targets]


def _read(rows: list[Clause]) -> ReadProgram:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("table.rpl", program_of(rows))], "rpl", diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.ERROR)]
    return read


def _cell() -> Cell:
    return read_cell(str(FOLDER / "cell.toml"))


def _on(result: RunResult) -> set[int]:
    """Numbers of the digital outputs that are on at the end."""
    state: dict[str, bool] = {}
    for event in result.trace:
        if event.kind == "output":
            kind, index, last, _ = event.port or (None, None, None, None)
            known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
            state.update(dict.fromkeys(signal_names(kind, known, index, last), bool(event.data.get("value"))))
    named = (key.removeprefix("digital_out:") for key, on in state.items() if on)
    return {int(number) for number in named if number.isdigit()}


@pytest.mark.parametrize("table", TABLES)
def test_what_the_manual_says_holds(table: str) -> None:
    rows = TABLES[table]
    result = run_program(_read(rows).program, KUKA, _cell(), "main", 200.0)
    assert (result.status, result.fault) == ("finished", None)
    on = _on(result)
    assert [clause.name for number, clause in enumerate(rows, 1) if number not in on] == []


@pytest.mark.parametrize(("clause", "target"), ALONE, ids=[f"{c.table}-{c.name}-{t}" for c, t in ALONE])
def test_it_holds_behind_a_translation(clause: Clause, target: str) -> None:
    read = _read([clause])
    diagnostics = Diagnostics()
    written = translate_program(read, target, KUKA, None, diagnostics)
    assert [item.as_text() for item in diagnostics.of(Severity.LOSS)] == []
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, again)
    assert not [item.as_text() for item in again.of(Severity.ERROR)]
    named = with_signal_names(back.program, written.program)
    cell = in_words_of(_cell(), read.program, named)
    result = run_program(named, KUKA, cell, written.renamed.get("main", "main"), 200.0)
    assert (result.status, result.fault) == ("finished", None)
    assert 1 in _on(result), "\n".join(file.data.decode(errors="replace") for file in written.files)
