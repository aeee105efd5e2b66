"""What some `$` names read: questions about where the robot is, and timers, which count whole milliseconds."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.reading.shapes import SyntaxTree
from rpl.source import Origin

from . import tables

Pieces = tuple[str, ...]


def _at_home(origin: Origin) -> ir.Expression:
    """`$IN_HOME`: is each axis of the robot near to `$H_POS`?"""
    near: ir.Expression | None = None
    for axis in ("A1", "A2", "A3", "A4", "A5", "A6"):
        here = ir.Field(ir.System("actual_joints", origin=origin), axis, origin=origin)
        home = ir.Field(ir.Name("$H_POS", origin=origin), axis, origin=origin)
        away = ir.Builtin("abs", (ir.Binary("-", here, home, origin=origin),), origin=origin)
        one = ir.Binary("<", away, ir.IntLiteral(tables.HOME_TOLERANCE_DEG), origin=origin)
        near = one if near is None else ir.Binary("and", near, one, origin=origin)
    assert near is not None
    return near


def _stands(origin: Origin) -> ir.Expression:
    """`$ROB_STOPPED`: does the robot stand?"""
    return ir.Unary("not", ir.System("moving", origin=origin), origin=origin)


def joints_of(place: str, origin: Origin) -> ir.Expression:
    """`$AXIS_FOR`, `$AXIS_BACK`: the axes at the end and at the start of the present move."""
    return ir.Builtin("target_to_joints", (ir.System(place, origin=origin),), origin=origin)


ASKED: dict[str, Callable[[Origin], ir.Expression]] = {"$in_home": _at_home, "$rob_stopped": _stands}
JOINTS_OF = {"$axis_for": "end_pose", "$axis_back": "start_pose"}


def counts(tree: SyntaxTree) -> bool:
    """Is it a timer, which shows whole milliseconds?"""
    return str(tree.children[0]).lower() in tables.COUNTED


def counted(make: Callable[[Pieces, Origin], ir.Expression]) -> Callable[[Pieces, Origin], ir.Expression]:
    """A timer is read as an INT: what is between two milliseconds is not seen."""
    return lambda pieces, origin: ir.Convert("round_half_away", make(pieces, origin), origin=origin)
