"""Moves to a place times a written pose that turns nothing (KRL `SPOT:{X 0,Y 0,Z -120,..}`, V+ `p:TRANS(0,0,-80)`): the
place and a way along its own axes (`tool_offset`), so that the place can be a taught one where targets say a posture.

Only where the left side is a pose: the product of a place with a posture has none in its source, and goes on as it is.
A frame in front (URScript `pose_trans(rack, pose_trans(spot, p[0,0,-0.05,0,0,0]))`) stays in front of the place.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import Postures
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import holds_none, rewrite_for
from rpl.passes.legalise.rewriting.editing import edit_each
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

__all__ = ["ways_along_tool"]

_PRODUCTS = frozenset(("operator :", "function compose"))


@legalising(unless=lambda context: context.capabilities.places.postures is not Postures.FLAGS, sees=_PRODUCTS)
def ways_along_tool(program: ir.Program, context: Context) -> ir.Program:
    """The program with such products of its moves as ways along the tool."""
    scopes = ProgramScope(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        if holds_none(routine, _PRODUCTS):
            return routine
        scope = scopes.routine(module, routine)

        def change(node: object) -> object:
            if not isinstance(node, ir.Move) or node.relative is not None:
                return node
            target = _moved(node.target, scope)
            via = None if node.via is None else _moved(node.via, scope)
            return node if target is node.target and via is node.via else replace(node, target=target, via=via)

        return rewrite_for({"Move"}, routine, change)

    return edit_each(program, work)


def _moved(place: ir.Expression, scope: Scope) -> ir.Expression:
    match place:
        case (
            ir.Binary(op=":", left=left, right=ir.Aggregate(type_name="pose", entries=entries))
            | ir.Builtin(function="compose", arguments=(left, ir.Aggregate(type_name="pose", entries=entries)))
        ) if (way := _way(entries)) is not None and isinstance(type_of(left, scope), ir.PoseType):
            return ir.Builtin("tool_offset", (_moved(left, scope), *way), origin=place.origin)
        case ir.Binary(op=":", left=frame, right=right) | ir.Builtin(function="compose", arguments=(frame, right)) if (
            isinstance(type_of(frame, scope), ir.PoseType)
        ):
            inner = _moved(right, scope)
            if inner is not right and isinstance(inner, ir.Builtin):
                base, *rest = (
                    inner.arguments
                )  # a frame times (a place times a way): the way is the last in either order
                seen = ir.Builtin("compose", (frame, base), origin=place.origin)
                return replace(inner, arguments=(seen, *rest), origin=place.origin)
    return place


def _way(entries: Iterable[tuple[str | None, ir.Expression]]) -> tuple[ir.Expression, ...] | None:
    """x, y and z of a pose that is written out and turns nothing."""
    parts = dict(entries)
    if parts.keys() != set(ir.POSE) or not all(_is_zero(parts[angle]) for angle in "abc"):
        return None
    return tuple(parts[axis] for axis in "xyz")


def _is_zero(one: ir.Expression) -> bool:
    return isinstance(one, ir.IntLiteral | ir.RealLiteral) and one.value == 0
