"""Which moves begin and end at constants, as a writer sees them, and their places in the robot's base."""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.passes.fold import Unchanged, constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of


def in_base(move: ir.Move, target: ir.Expression, type: ir.Type | None) -> ir.Expression:
    """A target of a move as a pose in the robot's base."""
    if isinstance(target, ir.Builtin) and target.function == "target_to_joints_near":
        target, type = target.arguments[0], ir.PoseType()
    if isinstance(type, ir.JointsType):
        return ir.Builtin("joints_to_target", (target,))
    return target if move.frame is None else ir.Binary(":", move.frame, target)


def seen_by_writers(program: ir.Program, context: Context) -> Unchanged:
    """What a writer sees as a constant: what nothing sets, data lists neither, and the controller's own tables."""
    own = {name.lower() for name in context.capabilities.storage.own}
    return Unchanged(usage_of(program).assigned - own, unchanged_in(program).initialised)


def ends_known(last: ir.Move | None, move: ir.Move, scope: Scope, unchanged: Unchanged) -> bool:
    """Are both ends of a move constants that a writer sees as such?"""
    if last is None or any(isinstance(one.target, ir.Builtin) for one in (last, move)):
        return False  # not known, or computed from a constant by the program itself
    type = type_of(last.target, scope)
    start = last.target if type is None else in_base(last, last.target, type)
    ends = (start, in_base(move, move.target, type_of(move.target, scope)))
    return all(constant(one, scope, unchanged) is not None for one in ends)


def written(move: ir.Move, triggers: Sequence[ir.Trigger], scope: Scope, unchanged: Unchanged) -> bool:
    """Are the places of these actions along the move constants?"""
    parts = [one for trigger in triggers for one in (trigger.distance, trigger.delay) if one is not None]
    delays = [plain(one.delay) for one in triggers if one.delay is not None]
    if (
        move.speed is not None
        and move.speed.path is not None
        and any(constant_number(one, scope) != 0 for one in delays)
    ):
        parts.append(move.speed.path)
    return all(constant_number(plain(one), scope, unchanged) is not None for one in parts)


__all__ = ["ends_known", "in_base", "seen_by_writers", "written"]
