"""Jumps as structure: what a run shows stays; loops and branches read as a person would write them."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings

from rpl import ir
from rpl.passes.legalise.control.labels import structure_to_labels
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.statements.structure import labels_to_structure
from rpl.passes.legalise.statements.switches import unroll_switches

from .common import count
from .shaped import STRUCTURED, assign, bodies, jumping, less, number, program, rewritten, same, step, target, when

TARGETS = {
    "all blocks": target(STRUCTURED),
    "while and if": target(STRUCTURED - {"Repeat", "Loop", "Switch", "For"}),
    "no next pass": target(STRUCTURED - {"NextPass"}),
}
PASSES = (labels_to_structure, unroll_switches, fit_loops)
A, B = less("a", 1), less("b", 2)
NOT_A, NOT_B = ir.Binary(">=", ir.Name("a"), number(1)), ir.Binary(">=", ir.Name("b"), number(2))


def goto(condition: ir.Expression, label: str) -> ir.If:
    return when(condition, ir.Goto(label))


def plus(name: str) -> ir.Assign:
    return assign(name, ir.Binary("+", ir.Name(name), number(1)))


CASES: list[tuple[str, ir.Body, ir.Body]] = [
    ("forward", (goto(A, "x"), step(1), ir.Label("x"), step(2)), (when(NOT_A, step(1)), step(2))),
    (
        "if else",
        (goto(A, "x"), step(1), ir.Goto("y"), ir.Label("x"), step(2), ir.Label("y"), step(3)),
        (when(A, step(2), otherwise=(step(1),)), step(3)),
    ),
    ("endless", (ir.Label("x"), step(1), ir.Goto("x")), (ir.Loop((step(1),)),)),
    (
        "while",
        (ir.Label("x"), goto(NOT_A, "y"), step(1), plus("a"), ir.Goto("x"), ir.Label("y"), step(2)),
        (ir.While(A, (step(1), plus("a"))), step(2)),
    ),
    (
        "repeat",
        (ir.Label("x"), step(1), plus("b"), goto(B, "x"), step(2)),
        (ir.Repeat(NOT_B, (step(1), plus("b"))), step(2)),
    ),
    (
        "jump to the end",
        (step(1), goto(A, "end"), step(2), goto(B, "end"), step(3), ir.Label("end")),
        (step(1), when(NOT_A, step(2), when(NOT_B, step(3)))),
    ),
    (
        "jumps over one step",
        (goto(A, "end"), goto(B, "end"), goto(less("a", 0), "end"), step(1), ir.Label("end"), step(2)),
        (
            when(
                ir.Binary("and", ir.Binary("and", NOT_A, NOT_B), ir.Binary(">=", ir.Name("a"), number(0))),
                step(1),
            ),
            step(2),
        ),
    ),
    (
        "two that fail",
        (
            *(goto(B, "bad"), step(1), goto(A, "bad"), step(2), ir.Goto("end")),
            *(ir.Label("bad"), step(3), ir.Label("end"), step(4)),
        ),
        (
            assign("to_bad", ir.BoolLiteral(False)),
            when(
                B,
                assign("to_bad", ir.BoolLiteral(True)),
                otherwise=(step(1), when(A, assign("to_bad", ir.BoolLiteral(True)), otherwise=(step(2),))),
            ),
            when(ir.Name("to_bad"), step(3)),
            step(4),
        ),
    ),
    (
        "out of a counting loop",
        (ir.For("i", number(1), number(3), None, (step(1), goto(A, "out"))), step(2), ir.Label("out"), step(3)),
        (
            assign("to_out", ir.BoolLiteral(False)),
            ir.For(
                "i",
                *(number(1), number(3), None),
                (step(1), when(A, assign("to_out", ir.BoolLiteral(True)), ir.ExitLoop())),
            ),
            when(ir.Unary("not", ir.Name("to_out")), step(2)),
            step(3),
        ),
    ),
    (
        "next pass",
        (ir.For("i", number(1), number(3), None, (goto(A, "on"), step(1), ir.Label("on"))), step(2)),
        (ir.For("i", number(1), number(3), None, (when(NOT_A, step(1)),)), step(2)),
    ),
    (
        "a loop left in its middle",
        (ir.Label("x"), step(1), goto(A, "y"), step(2), ir.Goto("x"), ir.Label("y"), step(3)),
        (ir.Loop((step(1), when(A, ir.ExitLoop()), step(2))), step(3)),
    ),
    (
        "structure without jumps stays",
        (when(A, step(1)), ir.While(B, (plus("b"),)), goto(A, "x"), step(2), ir.Label("x")),
        (when(A, step(1)), ir.While(B, (plus("b"),)), when(NOT_A, step(2))),
    ),
]


@pytest.mark.parametrize("body, wanted", [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_jumps_as_blocks(body: ir.Body, wanted: ir.Body) -> None:
    after = same(program(*body), TARGETS["all blocks"], *PASSES)
    assert after.modules[0].routines[0].body == wanted


def test_a_loop_entered_in_its_middle_has_a_state() -> None:
    body = (goto(A, "mid"), ir.Label("top"), step(1), ir.Label("mid"), step(2), plus("b"), goto(B, "top"), step(3))
    after = same(program(*body), TARGETS["all blocks"], *PASSES)
    assert [d.name for d in after.modules[0].routines[0].declarations if isinstance(d, ir.Variable)] == ["state"]


def test_no_state_without_need() -> None:
    body = (ir.Label("top"), step(1), goto(A, "top"), ir.Label("mid"), step(2), plus("b"), goto(B, "top"), step(3))
    after = same(program(*body), TARGETS["all blocks"], *PASSES)
    assert not after.modules[0].routines[0].declarations


def _without_jumps(after: ir.Program, name: str) -> None:
    assert not count(after, ir.Goto) and not count(after, ir.Label), name
    assert name != "no next pass" or not count(after, ir.NextPass)


def _generated_jumps_in_blocks(body: ir.Body) -> None:
    for name, capabilities in TARGETS.items():
        after = same(program(*body, step(ir.Name("i"))), capabilities, *PASSES)
        _without_jumps(after, name)


@settings(max_examples=50, deadline=None, suppress_health_check=list(HealthCheck))
@given(jumping(4, 2))
def test_generated_jumps_in_blocks(body: ir.Body) -> None:
    _generated_jumps_in_blocks(body)


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(jumping(4, 2))
def test_many_generated_jumps_in_blocks(body: ir.Body) -> None:
    _generated_jumps_in_blocks(body)


def _there_and_back(body: ir.Body) -> None:
    from .test_labels import TARGETS as OTHERS

    given = program(*body, step(ir.Name("i")))
    flat, _ = rewritten(given, OTHERS["jumps only"], unroll_switches, fit_loops, structure_to_labels)
    for name, capabilities in TARGETS.items():
        after = same(flat, capabilities, *PASSES)
        _without_jumps(after, name)
        assert not any(
            isinstance(one, ir.Variable) and one.name.startswith("state")
            for one in after.modules[0].routines[0].declarations
        )


@settings(max_examples=33, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies())
def test_there_and_back(body: ir.Body) -> None:
    _there_and_back(body)


@pytest.mark.slow
@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies())
def test_many_there_and_back(body: ir.Body) -> None:
    _there_and_back(body)
