"""Damaged text: one broken statement costs itself alone, and no text at all brings the reader down."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "ir"))
import strategies as make

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "rpl.md").read_text("utf-8")
quick = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=(HealthCheck.too_slow,))
GARBAGE = ("MOVE sideways", "x = = 1", "IF THEN", '"', "`", "@@@", "END", "SET do[1]", "WAIT UNTIL")


def read(text: str) -> tuple[ir.Program, Diagnostics]:
    diagnostics = Diagnostics()
    return registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program, diagnostics


@quick
@given(st.lists(make.simple, min_size=1, max_size=6), st.data())
def test_one_broken_statement_leaves_the_others(body: list[ir.Statement], data: st.DataObject) -> None:
    program = ir.Program((ir.Module("m", "rpl", (), (ir.Routine("main", body=tuple(body)),)),))
    lines = registry.target("rpl").write(program, WriteContext(Diagnostics()))[0].data.decode().splitlines()
    at = data.draw(st.integers(0, len(body)))
    garbage = data.draw(st.sampled_from(GARBAGE))
    broken = [*lines[: 2 + at], "        " + garbage, *lines[2 + at :]]
    found, diagnostics = read("\n".join(broken))
    assert [item.code.name for item in diagnostics] == ["unreadable-statement"]
    expected = (*body[:at], ir.Opaque(garbage), *body[at:])
    assert found.modules[0].routines[0].body == expected


@pytest.mark.parametrize("broken", ["f(", "x = {1,", "y = (a", "f(1,", "x = [", "f(a AND"])
@pytest.mark.parametrize("behind", ["b = 1", "SET do[1] TO ON", "`odd name`.x[1] = 2", "WAIT 1 s", "MOVE TO p"])
def test_an_open_bracket_ends_with_its_line(broken: str, behind: str) -> None:
    body = read(f"a = 1\n{broken}\n{behind}\n")[0].modules[0].routines[0].body
    assert body[1:] == (ir.Opaque(broken), *read(behind)[0].modules[0].routines[0].body)


@quick
@given(st.integers(0, len(PAGE)), st.integers(0, 400), st.text(max_size=5))
def test_any_piece_of_text_can_be_read(start: int, length: int, inserted: str) -> None:
    text = PAGE[start : start + length] + inserted + PAGE[start + length + 7 : start + length + 300]
    program, _ = read(text)
    printed = registry.target("rpl").write(program, WriteContext(Diagnostics()))[0].data.decode()
    again, diagnostics = read(printed)
    assert list(diagnostics) == []
    assert again == program


@quick
@given(st.text())
def test_any_text_is_accounted_for(text: str) -> None:
    program, diagnostics = read(text)
    assert not any(item.code.name == "unclaimed-text" for item in diagnostics), (text, program)
