"""Errors: routines for all of them, and the numbers that the source's controller gives them."""

from __future__ import annotations

from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import rules_of
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.refusals.rows import PLAINLY, Asked, Found, Refusal

__all__ = ["ERRORS", "serves_all_errors"]

ROUTINE = code(
    "error-routine-lost",
    Severity.LOSS,
    "from here on errors call {name}; the target has no routine for all errors",
    "write handlers where an error is expected, or ask in front of what may fail",
    stops=True,
)
NUMBER = code(
    "error-number-lost",
    Severity.LOSS,
    "the target numbers its errors otherwise: what is kept or shown here would be another number",
    "compare the number with the error's name, and keep or show a value of your own for it",
    stops=True,
)
_NUMBER = ir.System("error_number")


def serves_all_errors(program: ir.Program, asked: frozenset[str]) -> bool:
    """Has a target with these statements a routine for all errors, those that the program raises itself among them?"""
    return "OnError" in asked and (
        "Raise" in asked or not any(isinstance(one, ir.Raise) for one in walk_for({"Raise"}, program))
    )


def _routine(statement: ir.OnError, asked: Asked) -> Found:
    if statement.routine is None or serves_all_errors(asked.program, asked.can.statements):
        return ()
    return ({"name": statement.routine},)


def _number(statement: ir.Statement, asked: Asked) -> Found:
    """The number of an error where it is more than the question which error it is."""
    if not asked.can.errors.handlers or isinstance(statement, ir.Raise):
        return ()
    theirs, ours = (rules_of(one).errors for one in (asked.context.target, asked.context.source))
    if not ours or theirs == ours:
        return ()
    if isinstance(statement, ir.Switch) and statement.selector == _NUMBER:
        return ()
    nodes = [*walk(*children(statement))]
    questions = [one for one in nodes if isinstance(one, ir.Binary) and one.op in ("=", "<>")]
    sides = [side for one in questions for side in (one.left, one.right)]
    return PLAINLY if nodes.count(_NUMBER) > sides.count(_NUMBER) else ()


ERRORS = (
    Refusal("a routine for all errors of a task", ROUTINE, (ir.OnError,), _routine, left=False),
    Refusal("the number of an error, kept, shown or counted with", NUMBER, get_args(ir.Statement), _number, left=False),
)
