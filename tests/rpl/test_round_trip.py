"""`read(print(ir)) == ir` for every node of the IR, and printing what was read gives the same text again."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import get_args

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "ir"))
import strategies as make

SLOW = (HealthCheck.too_slow, HealthCheck.data_too_large)
quick = settings(max_examples=120, deadline=None, suppress_health_check=SLOW, derandomize=True)


def printed(program: ir.Program) -> str:
    files = registry.target("rpl").write(program, WriteContext(Diagnostics()))
    return files[0].data.decode("utf-8")


def read(text: str) -> ir.Program:
    diagnostics = Diagnostics()
    program = registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program
    assert [item.as_text() for item in diagnostics] == [], text
    return program


def round_trip(program: ir.Program) -> None:
    text = printed(program)
    again = read(text)
    assert again == program, text
    assert printed(again) == text


def in_program(*body: ir.Statement) -> ir.Program:
    return ir.Program((ir.Module("m", "rpl", (), (ir.Routine("main", body=body),)),))


@quick
@given(make.expressions)
def test_expressions(expression: ir.Expression) -> None:
    round_trip(in_program(ir.Assign(ir.Name("x"), expression), ir.Return(expression), ir.Wait(expression)))


@quick
@given(make.simple)
def test_simple_statements(statement: ir.Statement) -> None:
    round_trip(in_program(statement))


@quick
@given(make.bodies)
def test_bodies(body: ir.Body) -> None:
    round_trip(in_program(*body))


@quick
@given(st.lists(make.declarations, max_size=3), st.lists(make.declarations, max_size=3), make.bodies)
def test_declarations(outer: list[ir.Declaration], inner: list[ir.Declaration], body: ir.Body) -> None:
    routine = ir.Routine("main", declarations=tuple(inner), body=body)
    round_trip(ir.Program((ir.Module("m", "krl", tuple(outer), (routine,)),)))


@quick
@given(make.programs)
def test_programs(program: ir.Program) -> None:
    round_trip(program)


def test_strategies_reach_every_node() -> None:
    """A node that is added to the IR and not to the strategies would never be tried."""
    wanted = {*get_args(ir.Statement), *get_args(ir.Expression), *get_args(ir.Declaration), *get_args(ir.Type)}
    seen: set[type] = {type(node) for node in (*make.BARE, *make.PLAIN_TYPES)}

    @settings(max_examples=600, deadline=None, suppress_health_check=SLOW, derandomize=True, database=None)
    @given(st.tuples(make.simple, make.simple, make.types, make.declarations, make.statements))
    def look(nodes: tuple[object, ...]) -> None:
        seen.update(type(part) for part in walk(nodes))

    look()
    assert sorted(node.__name__ for node in wanted - seen) == []
