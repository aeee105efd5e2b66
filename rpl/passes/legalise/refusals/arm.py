"""Kinematics and postures of the arm that a program calculates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.places.postures.reports import FLAG_ACCESS
from rpl.passes.legalise.refusals.rows import Asked, Found, Refusal
from rpl.passes.typing import type_of

__all__ = ["ARM"]

KINEMATICS = code(
    "kinematics-lost",
    Severity.LOSS,
    "the target's programs cannot {what}",
    "teach the joints there, or let the move itself find them",
    stops=True,
)
_SOLVED = {
    "joints_to_target": "calculate the place of the tool at given joints",
    "target_to_joints": "calculate the joints of a place",
    "target_to_joints_near": "calculate the joints of a place that are nearest to given ones",
    "is_reachable": "ask whether a place can be reached",
}
_FUNCTIONS = frozenset(f"function {one}" for one in _SOLVED)


def _unsolved(statement: ir.Statement, asked: Asked) -> Found:
    """Kinematic functions that the target has in no form."""
    can, found = asked.can, list[Mapping[str, object]]()
    if can.places.kinematics is not None:
        return ()

    def look(expression: ir.Expression) -> None:
        if not isinstance(expression, ir.Builtin) or expression.function not in _SOLVED:
            return
        needed = {expression.function}
        if expression.function == "target_to_joints_near":
            if isinstance(statement, ir.Move) and statement.target == expression:
                return  # how a move says the posture that it wants
            chosen = isinstance(type_of(expression.arguments[0], asked.scope), ir.TargetType) and not can.storage.banks
            needed = {"target_to_joints"} if chosen else {"target_to_joints", "target_to_joints_near"}
        elif can.storage.banks and expression.function != "is_reachable":
            return  # registers change their form where they are assigned
        if not needed <= can.functions:
            found.append({"what": _SOLVED[expression.function]})

    each_expression(statement, look, kinds=_FUNCTIONS)
    return tuple(found)


ARM = (
    Refusal("kinematics of the arm in a program", KINEMATICS, get_args(ir.Statement), _unsolved),
    Refusal("a flag of the arm configuration that the run decides", FLAG_ACCESS),
)
