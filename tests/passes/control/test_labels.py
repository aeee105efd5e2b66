"""Structure as labels and jumps: what a run shows stays, and the jumps read as a person would write them."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings

from rpl import ir
from rpl.passes.capabilities import Control, Counting
from rpl.passes.legalise.control.labels import structure_to_labels
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.statements.switches import unroll_switches

from .common import count, nodes
from .shaped import ALL, JUMPING, assign, bodies, jumping, less, number, program, rewritten, same, step, target, when

PASSES = (unroll_switches, fit_loops, structure_to_labels)
TARGETS = {
    "jumps only": target(JUMPING),
    "and FOR by one": target(
        JUMPING | {"For"}, control=Control(counting=frozenset((Counting.KEEPS_LAST, Counting.ONE_STEP)))
    ),
    "and IF blocks": target(JUMPING | {"If", "For"}, control=Control(counting=frozenset((Counting.KEEPS_LAST,)))),
    "and WHILE": target(JUMPING | {"If", "While", "ExitLoop"}),
    "all blocks": target(ALL),
}
A, B = less("a", 1), less("b", 2)


def goto(condition: ir.Expression, label: str) -> ir.If:
    return when(condition, ir.Goto(label))


def at_least(name: str, value: int) -> ir.Binary:
    return ir.Binary(">=", ir.Name(name), number(value))


CASES: list[tuple[str, ir.Body, ir.Body]] = [
    ("conditional jump", (goto(A, "x"), step(1), ir.Label("x")), (goto(A, "x"), step(1), ir.Label("x"))),
    ("if", (when(A, step(1)),), (goto(at_least("a", 1), "if_end"), step(1), ir.Label("if_end"))),
    (
        "if else",
        (when(A, step(1), otherwise=(step(2),)),),
        (goto(at_least("a", 1), "else"), step(1), ir.Goto("if_end"), ir.Label("else"), step(2), ir.Label("if_end")),
    ),
    (
        "elseif",
        (ir.If(((A, (step(1),)), (B, (step(2),)))),),
        (
            *(goto(at_least("a", 1), "else"), step(1), ir.Goto("if_end")),
            *(ir.Label("else"), goto(at_least("b", 2), "if_end"), step(2), ir.Label("if_end")),
        ),
    ),
    (
        "a branch that leaves needs no jump",
        (when(A, ir.Return(), otherwise=(step(2),)),),
        (goto(at_least("a", 1), "else"), ir.Return(), ir.Label("else"), step(2)),
    ),
    (
        "while",
        (ir.While(A, (step(1), assign("a", 1))),),
        (
            *(ir.Label("loop"), goto(at_least("a", 1), "loop_end"), step(1), assign("a", 1)),
            *(ir.Goto("loop"), ir.Label("loop_end")),
        ),
    ),
    ("endless", (ir.Loop((step(1),)),), (ir.Label("loop"), step(1), ir.Goto("loop"))),
    ("endless while", (ir.While(ir.BoolLiteral(True), (step(1),)),), (ir.Label("loop"), step(1), ir.Goto("loop"))),
    (
        "repeat",
        (ir.Repeat(B, (step(1), assign("b", 3))), ir.Repeat(A, (step(1),))),
        (
            *(ir.Label("loop"), step(1), assign("b", 3), goto(at_least("b", 2), "loop")),
            *(ir.Label("loop2"), step(1), goto(at_least("a", 1), "loop2")),
        ),
    ),
    (
        "exit is a jump behind the loop",
        (ir.Loop((step(1), when(A, ir.ExitLoop()))), step(2)),
        (ir.Label("loop"), step(1), goto(at_least("a", 1), "loop"), step(2)),
    ),
    (
        "not both",
        (when(ir.Binary("and", A, ir.Unary("not", B)), step(1)),),
        (goto(ir.Binary("or", at_least("a", 1), B), "if_end"), step(1), ir.Label("if_end")),
    ),
]


@pytest.mark.parametrize("body, wanted", [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_blocks_as_jumps(body: ir.Body, wanted: ir.Body) -> None:
    after = same(program(*body), TARGETS["jumps only"], *PASSES)
    assert after.modules[0].routines[0].body == wanted


def test_a_block_that_a_jump_goes_into_is_taken_apart() -> None:
    body = (when(A, ir.Goto("x")), ir.While(B, (step(1), ir.Label("x"), step(2), assign("b", 9))), ir.While(B, ()))
    after = same(program(*body), TARGETS["all blocks"], *PASSES)
    assert count(after, ir.While) == 1


def _untidy(after: ir.Program) -> list[str]:
    """What a reader would strike out."""
    found = []
    for body in [r.body for r in after.modules[0].routines]:
        used = {one.label.lower() for one in nodes(after) if isinstance(one, ir.Goto)}
        for at, one in enumerate(body):
            if isinstance(one, ir.Label) and one.name.lower() not in used:
                found.append(f"label {one.name} has no use")
            if at and isinstance(one, ir.Goto) and isinstance(body[at - 1], ir.Goto | ir.Return):
                found.append(f"jump to {one.label} is dead")
            if (
                at
                and isinstance(body[at - 1], ir.Goto)
                and isinstance(one, ir.Label)
                and one.name == body[at - 1].label
            ):
                found.append(f"jump to {one.name} goes nowhere")
    return found


def _generated_blocks(body: ir.Body) -> None:
    for name, capabilities in TARGETS.items():
        after = same(program(*body, step(ir.Name("i"))), capabilities, *PASSES)
        assert not _untidy(after), name
        for one in nodes(after):
            if isinstance(one, ir.While | ir.Repeat | ir.Loop | ir.For | ir.ExitLoop | ir.NextPass):
                assert one.__class__.__name__ in capabilities.statements, name
            if isinstance(one, ir.If) and "If" not in capabilities.statements:
                assert isinstance(one.branches[0][1][0], ir.Goto) and len(one.branches) == 1 and not one.otherwise


@settings(max_examples=33, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies())
def test_generated_blocks(body: ir.Body) -> None:
    _generated_blocks(body)


@pytest.mark.slow
@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies())
def test_many_generated_blocks(body: ir.Body) -> None:
    _generated_blocks(body)


def _generated_jumps(body: ir.Body) -> None:
    for capabilities in TARGETS.values():
        same(program(*body, step(ir.Name("i"))), capabilities, *PASSES)


@settings(max_examples=33, deadline=None, suppress_health_check=list(HealthCheck))
@given(jumping())
def test_generated_jumps(body: ir.Body) -> None:
    _generated_jumps(body)


@pytest.mark.slow
@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(jumping())
def test_many_generated_jumps(body: ir.Body) -> None:
    _generated_jumps(body)


def test_nothing_to_do_is_nothing_done() -> None:
    given = program(when(A, step(1)), ir.While(B, (assign("b", 5),)))
    assert rewritten(given, TARGETS["all blocks"], structure_to_labels)[0] is given
