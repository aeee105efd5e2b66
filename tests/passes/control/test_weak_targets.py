"""All passes together for targets that can say little: generated programs show the same before and after."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from rpl import ir
from rpl.passes.capabilities import Capabilities, Control, Counting, Limit, Local, Parameters, Passing, RoutineRule
from rpl.passes.legalise import legalise
from rpl.passes.legalise.control.loops import fit_loops

from .common import COMMON, PLAIN, count, nodes, same_run
from .shaped import ALL, assign, less, number, program, rewritten, same, step, target, when
from .test_generated import _KRL, _RAPID, GUARD, bodies, handlers, krl_bodies, read

BLOCKS = frozenset(("If", "Switch", "For", "While", "Repeat", "Loop", "ExitLoop", "NextPass"))
JUMPS = frozenset(("Goto", "Label"))
# Numbered labels, argument by variables, nothing of its own in a routine; a counting loop that keeps the last value.
LABELS_ONLY = replace(
    PLAIN,
    statements=COMMON - BLOCKS | {"For"},
    routines=replace(
        PLAIN.routines,
        rules=PLAIN.routines.rules - {RoutineRule.FUNCTIONS},
        parameters=Parameters.NONE,
        locals=PLAIN.routines.locals - {Local.VARIABLES},
    ),
    control=replace(
        PLAIN.control,
        limits=PLAIN.control.limits | {Limit.ONE_BRANCH},
        counting=PLAIN.control.counting | {Counting.KEEPS_LAST, Counting.ONE_STEP},
    ),
)
# Blocks without any jump, values only.
NO_JUMPS = replace(
    PLAIN,
    statements=COMMON - JUMPS - {"Switch", "For"} | {"ExitLoop", "NextPass"},
    routines=replace(PLAIN.routines, passing=PLAIN.routines.passing - {Passing.REFERENCES}),
)
SINGLE_BRANCHES = replace(
    PLAIN,
    statements=PLAIN.statements - {"Switch", "WaitUntil"},
    control=replace(PLAIN.control, limits=PLAIN.control.limits | {Limit.ONE_BRANCH}),
)
TARGETS = {"labels only": LABELS_ONLY, "no jumps": NO_JUMPS, "single branches": SINGLE_BRANCHES}


def _said(after: ir.Program, capabilities: Capabilities) -> None:
    """Every statement is one that the target has."""
    for one in nodes(after):
        name = one.__class__.__name__
        if isinstance(one, ir.If):
            if "If" not in capabilities.statements:
                assert len(one.branches) == 1 and not one.otherwise and isinstance(one.branches[0][1][0], ir.Goto)
            elif Limit.ONE_BRANCH in capabilities.control.limits:
                assert len(one.branches) == 1
        elif name in BLOCKS | JUMPS:
            assert name in capabilities.statements, name


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(krl_bodies(), min_size=1, max_size=3).map("\n".join))
@example(f"FOR i=1 TO 1\n{GUARD}show(i)\na=0\nENDFOR\na=i")  # the counter is looked at behind the loop
def test_programs_with_loops_and_calls(body: str) -> None:
    for capabilities in TARGETS.values():
        after = same_run(read("krl", _KRL % f"i = 0\nk = 0\n{body}"), capabilities, legalise)
        _said(after, capabilities)


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=3).map(" ".join), handlers())
def test_programs_with_handlers(inner: str, caught: str, main: str, last: str) -> None:
    # the generated programs call themselves, so their routines need variables of their own
    recursive = replace(
        LABELS_ONLY,
        routines=replace(
            LABELS_ONLY.routines, parameters=Parameters.NAMES, locals=LABELS_ONLY.routines.locals | {Local.VARIABLES}
        ),
    )
    for capabilities in (recursive, NO_JUMPS, SINGLE_BRANCHES):
        after = same_run(read("rapid", _RAPID % (inner, caught, main, last)), capabilities, legalise)
        _said(after, capabilities)


# ---- counters of FOR

KEEPS = target(ALL, control=Control(counting=frozenset((Counting.KEEPS_LAST,))))
LEAVES = target(ALL)
BY_ONE = target(ALL, control=Control(counting=frozenset((Counting.ONE_STEP,))))


def _for(body: ir.Body = (), last: bool = False, by: int | None = None, stop: ir.Expression | None = None) -> ir.For:
    given = None if by is None else number(by)
    return ir.For("i", number(1), stop or number(3), given, (step(ir.Name("i")), *body), keeps_last=last)


@pytest.mark.parametrize(
    "capabilities, loop, counts",
    [
        (KEEPS, _for(last=True), 1),
        (KEEPS, _for(), 1),
        (KEEPS, _for((when(less("n", 3), ir.ExitLoop()),)), 0),
        (KEEPS, _for(stop=ir.Name("a")), 0),
        (LEAVES, _for(last=True), 1),
        (LEAVES, _for(), 1),
        (LEAVES, _for(last=True, by=2), 1),
        (LEAVES, _for(last=True, stop=ir.Name("a")), 0),
        (LEAVES, _for((when(less("n", 3), ir.ExitLoop()),), last=True), 0),
        (BY_ONE, _for(by=2), 0),
        (BY_ONE, _for(by=-1), 1),
    ],
)
def test_the_counter_behind_the_loop(capabilities: Capabilities, loop: ir.For, counts: int) -> None:
    after = same(program(assign("a", 2), loop, step(ir.Name("i"))), capabilities, fit_loops)
    assert count(after, ir.For) == counts


def test_a_counter_that_nobody_looks_at_needs_no_care() -> None:
    given = program(assign("a", 2), _for(stop=ir.Name("a")), local=True)
    after, _ = rewritten(given, KEEPS, fit_loops)
    assert count(after, ir.For) == 1 and not count(after, ir.While)
