"""Points moved by a frame that turns nothing (KRL `Over:XP1`) as `Offs`: RAPID multiplies poses, not robtargets, so
that the point would be put together in four lines in front of its move. Offs moves the point along the same axes and
keeps its configuration and external axes, as the product does.

The frame is data that nothing assigns and that only moves points. One that moves a single point is its numbers at the
move, as most of Offs is written (counted: 84 % have literal numbers); one that moves several keeps its name. What would
not follow the frame when it is taught anew is reported.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from rpl import ir
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.values.taughtvalues import tell_written
from rpl.passes.legalise.kinds import holds_none, rewrite_for, walk_for
from rpl.passes.legalise.rewriting.editing import edit_each
from rpl.passes.legalise.rewriting.unreaddata import without_unread
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rigid import Pose
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

_PRODUCTS = frozenset(("operator :", "function compose"))
_PLAIN = (ir.Name, ir.Index, ir.Field)
_NO_TURN_DEG = 1e-9
NUMBERS = "the way that this point is moved by"
NOT_NAMED = "that the way of this point has no turn, and the parts of it that are 0"


@legalising(sees=tuple(sorted(_PRODUCTS)))
def points_offset(program: ir.Program, context: Context) -> ir.Program:
    """Where the point is a robtarget: what is put together of poses alone stays a product."""
    unchanged, scopes = unchanged_in(program), ProgramScope(program)
    moving = Counter(
        name.id.lower() for module, routine in scopes.routines() for name in _moving(module, routine, scopes)
    )
    used = Counter(one.id.lower() for one in walk_for({"Name"}, *program.modules) if isinstance(one, ir.Name))
    only_moving = {name: count for name, count in moving.items() if used[name] == count}
    if not only_moving:
        return program
    done: set[str] = set()

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        if holds_none(routine, _PRODUCTS):
            return routine
        scope = scopes.routine(module, routine)

        def change(node: object) -> object:
            product = _moved(node, scope)
            if product is None or product[0].id.lower() not in only_moving:
                return node
            frame, point = product
            by_name = only_moving[frame.id.lower()] > 1
            way = _way(frame, scope, unchanged, by_name)
            if way is None:
                return node
            assert isinstance(node, ir.Binary | ir.Builtin)  # as `_moved` found it
            if frame.id.lower() not in done:
                tell_written(context, scope, node.origin, NOT_NAMED if by_name else NUMBERS, frame)
                done.add(frame.id.lower())
            return ir.Builtin("offset", (point, *way), origin=node.origin)

        return rewrite_for(_PRODUCTS, routine, change)

    changed = edit_each(program, work)
    return without_unread(changed, done) if done else program


def _moving(module: ir.Module, routine: ir.Routine, scopes: ProgramScope) -> Iterator[ir.Name]:
    """The frames that a routine moves points by, once for each use."""
    if holds_none(routine, _PRODUCTS):
        return
    scope = scopes.routine(module, routine)
    for node in walk_for({"Binary", "Builtin"}, routine):
        product = _moved(node, scope)
        if product is not None:
            yield product[0]


def _moved(node: object, scope: Scope) -> tuple[ir.Name, ir.Expression] | None:
    """The frame and the point of a product that is a point."""
    match node:
        case (
            ir.Binary(op=":", left=ir.Name() as frame, right=point)
            | ir.Builtin(function="compose", arguments=(ir.Name() as frame, point))
        ) if isinstance(point, _PLAIN) and isinstance(type_of(point, scope), ir.TargetType):
            return frame, point
    return None


def _way(frame: ir.Name, scope: Scope, unchanged: Unchanged, by_name: bool) -> tuple[ir.Expression, ...] | None:
    """x, y and z of a frame that is known and turns nothing; a part that is 0 is not named."""
    if frame.id.lower() in unchanged.assigned:
        return None
    pose = constant(frame, scope, unchanged)
    if not isinstance(pose, Pose) or pose.rotation.angle > _NO_TURN_DEG:
        return None
    parts = ((part, getattr(pose.position, part)) for part in ("x", "y", "z"))
    return tuple(ir.Field(frame, part) if by_name and value else ir.RealLiteral(value) for part, value in parts)
