"""Jumps of languages without endless loops, for targets that have jumps and loops: what a run shows stays, and where
nothing is needed besides, loops stand for the jumps."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings

from rpl import ir
from rpl.passes.legalise.source.jumpsasblocks import jumps_as_blocks

from .common import count
from .shaped import ALL, assign, context_for, jumping, less, number, program, shown, step, target, when

A, B = less("a", 2), less("b", 2)
NOT_A, NOT_B = ir.Binary(">=", ir.Name("a"), number(2)), ir.Binary(">=", ir.Name("b"), number(2))


def goto(condition: ir.Expression, label: str) -> ir.If:
    return when(condition, ir.Goto(label))


def plus(name: str) -> ir.Assign:
    return assign(name, ir.Binary("+", ir.Name(name), number(1)))


COUNTING = (
    *(ir.Label("x"), step(1), plus("a"), goto(A, "x")),
    *(assign("a", 0), plus("b"), goto(B, "x"), step(2)),
)


def written(given_program: ir.Program, source: str = "tp", statements: frozenset[str] = ALL) -> ir.Body:
    """The body of the first routine behind the pass; a run shows the same."""
    context = replace(context_for(given_program, target(statements)), source=source, target="krl")
    after = jumps_as_blocks(given_program, context)
    assert shown(after) == shown(given_program)
    return after.modules[0].routines[0].body


def test_checks_that_go_back_to_one_label_are_loops_in_one_another() -> None:
    inner = ir.Repeat(NOT_A, (step(1), plus("a")))
    assert written(program(*COUNTING)) == (ir.Repeat(NOT_B, (inner, assign("a", 0), plus("b"))), step(2))


def test_checks_directly_behind_the_label() -> None:
    """Two inputs that are asked until both are there."""
    body = (assign("a", 2), assign("b", 2), ir.Label("x"), goto(A, "x"), goto(B, "x"), step(1))
    assert written(program(*body)) == (*body[:2], ir.Repeat(NOT_B, (ir.Repeat(NOT_A, ()),)), step(1))


def test_without_a_loop_that_checks_at_its_end_a_loop_is_left() -> None:
    body = written(program(*COUNTING), statements=ALL - {"Repeat"})
    assert isinstance(body[0], ir.Loop) and not count(program(*body), ir.Goto)


@pytest.mark.parametrize(
    "why, source, statements",
    [
        ("the language has loops, so a jump was wanted", "krl", ALL),
        ("the target cannot leave a loop", "tp", ALL - {"ExitLoop", "Repeat"}),
        ("the target has no loops", "tp", ALL - {"While", "Loop", "Repeat"}),
    ],
)
def test_jumps_that_stay(why: str, source: str, statements: frozenset[str]) -> None:
    assert written(program(*COUNTING), source, statements) == COUNTING, why


def test_a_routine_that_would_need_a_flag_keeps_its_jumps() -> None:
    """A loop that is entered in its middle."""
    body = (goto(A, "mid"), ir.Label("top"), step(1), ir.Label("mid"), step(2), plus("b"), goto(B, "top"))
    assert written(program(*body)) == body


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(jumping(4, 2))
def test_generated_jumps(body: ir.Body) -> None:
    written(program(*body, step(ir.Name("i"))))
