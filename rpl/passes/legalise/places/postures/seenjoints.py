"""The place of joints that have just been asked for, for targets that do not calculate it: where the tool is.

A program that keeps the robot's joints and makes a place of them in the next lines could as well have asked for the
place, which controllers know that have no kinematics for programs.
"""

from __future__ import annotations

from functools import partial

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts


@legalising(
    unless=lambda context: context.capabilities.places.kinematics is not None or context.capabilities.carries_rules
)
def seen_joints(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without kinematic functions, in routines that see the robot standing still between the lines."""

    def work(node: object) -> object:
        return edit_bodies(node, _body) if isinstance(node, ir.Routine) else node

    return rewrite(program, work)


def _body(statements: ir.Body) -> ir.Body:
    seen: list[ir.Expression] = []  # places that hold the joints of this moment
    done: list[ir.Statement] = []
    for statement in statements:
        if isinstance(statement, ir.Assign) and not _asks_others(statement):
            statement = rewrite_parts(statement, partial(_place, tuple(seen)))
            changed = base_name(statement.target)
            seen = [one for one in seen if base_name(one) != changed]
            if _is_joints(statement.value) and _is_steady(statement.target):
                seen = [*seen, statement.target]
        elif not isinstance(statement, ir.Nothing):
            seen = []
            statement = rewrite_bodies(statement, _body)
        done.append(statement)
    return tuple(done)


def _place(seen: tuple[ir.Expression, ...], value: ir.Expression) -> ir.Expression:
    def change(node: object) -> object:
        match node:
            case ir.Builtin(function="joints_to_target", arguments=(joints, tool, frame), origin=origin) if (
                joints in seen
            ):
                return ir.Builtin("current_target", (tool, frame), origin=origin)
        return node

    return rewrite(value, change)


def _is_steady(place: ir.Expression) -> bool:
    """A variable, or an element with a constant number."""
    if isinstance(place, ir.Index):
        return isinstance(place.base, ir.Name) and all(isinstance(one, ir.IntLiteral) for one in place.indices)
    return isinstance(place, ir.Name)


def _is_joints(value: ir.Expression) -> bool:
    match value:
        case ir.System(name="actual_joints") | ir.Builtin(function="current_joints", arguments=()):
            return True
    return False


def _asks_others(statement: ir.Assign) -> bool:
    """Calls of functions may move the robot."""
    return any(isinstance(node, ir.Call) for node in walk((statement,)))
