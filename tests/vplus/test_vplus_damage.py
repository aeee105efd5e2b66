"""Damaged V+ programs: each mistake costs its own line, and every character is accounted for."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from vplus_helpers import as_rpl, program_of, read

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.reading.ledger import Ledger
from rpl.source import source_from_text

DAMAGED = [
    ("n = 1\nMOVE )\nn = 2", ["n = 1", "n = 2"]),
    ("IF x ==== THEN\nn = 1\nEND\nn = 2", ["n = 1", "n = 2"]),
    ("WHILE x DO\nFOR m 1 TO 3\nn = 1\nEND\nEND\nn = 2", ["WHILE to_bool(x)", "n = 1", "END WHILE", "n = 2"]),
    ("n = 1\nEND\nn = 2", ["n = 1", "n = 2"]),
    ("n = 1\nELSE\nn = 2", ["n = 1", "n = 2"]),
    ("WHILE x DO\nn = 1", ["WHILE to_bool(x)", "n = 1", "END WHILE"]),
    ("n = 1e99\nn = 2", ["n = 2"]),
    ("SIGNAL 5000\nn = 2", ["n = 2"]),
    ("n = ^H\nn = 2", ["n = 2"]),
]


@pytest.mark.parametrize(("text", "kept"), DAMAGED)
def test_a_mistake_costs_its_own_line(text: str, kept: list[str]) -> None:
    program, diagnostics = read(program_of(text))
    assert diagnostics.has_errors
    assert [line for line in as_rpl(program) if not line.startswith("OPAQUE")] == kept


@pytest.mark.parametrize(
    ("text", "line", "column"), [("n = 1\n  x = (3", 3, 9), ("MOVE , p q", 2, 10), ("AUTO 3", 2, 6)]
)
def test_the_place_of_a_mistake(text: str, line: int, column: int) -> None:
    (report,) = [item for item in read(program_of(text))[1] if item.severity > 2]
    assert (report.origin.line, report.origin.column) == (line, column)


def test_a_missing_end_of_a_program_is_reported_and_mended() -> None:
    program, diagnostics = read(".PROGRAM a\nn = 1\n.PROGRAM b\nn = 2\n.END")
    assert diagnostics.has_errors
    assert {routine.name for routine in program.modules[0].routines} == {"a", "b"}


def test_comments_and_labels_travel_with_their_steps() -> None:
    program, _ = read(".PROGRAM a ;head\n; before\n 10 n = 1 ;behind\n .END")
    (routine,) = program.modules[0].routines
    label, assign = (node for node in walk(routine.body) if isinstance(node, ir.Label | ir.Assign))
    assert [comment.text for comment in routine.origin.comments] == ["head"]
    assert [comment.text for comment in (*label.origin.comments, *assign.origin.comments)] == [" before", "behind"]


_PIECES = st.sampled_from(
    [".PROGRAM a(b, $c, d[])", ".END", "IF a THEN", "ELSE", "END", "DO", "UNTIL b", "CASE a OF", "VALUE 1, 2:", "ANY",
     "FOR i = 1 TO 3", "WHILE a DO", "MOVE p", "100 GOTO 100", "  100", "x = 'A + ^HF", '$s = "a;b"', "; remark",
     "AUTO q[3]", "EXIT 2", "NEXT", "SIGNAL -5, 2001", ".LOCATIONS", "p 1 2 3 4 5 6", ".REALS", "\t", "((",
     "CALL a(1,)", "TYPE /C1, \"x\", /F5.2, y", "SET f:p = HERE", "REACT 1001, a", "\x1a"]
)  # fmt: skip


@given(st.lists(_PIECES, max_size=25), st.sampled_from(["\n", "\r\n", "\r"]))
def test_whatever_stands_in_a_file_nothing_is_lost(lines: list[str], end: str) -> None:
    source = source_from_text("x.v2", end.join(lines))
    diagnostics = Diagnostics()
    result = registry.dialect("vplus").read([source], diagnostics)
    assert not [item for item in diagnostics if item.code.name == "unclaimed-text"]
    assert result.files[0].opaque == 0 or diagnostics.has_errors
    assert Ledger(source).rebuilt() == source.text


@given(st.text(alphabet="abIFENDO.PROGRAM \n()[]=+-*/:;'\"^$#%,0123456789THVLU", max_size=200))
def test_no_text_breaks_the_reader(text: str) -> None:
    registry.dialect("vplus").read([source_from_text("x.v2", text)], Diagnostics())
