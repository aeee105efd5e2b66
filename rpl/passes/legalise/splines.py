"""Spline blocks and moves of the spline kind for targets that have neither: straight moves through the points.

Also where the target has blocks, but the points say tools, frames and speeds of their own, which such a target has not.

A run drives a block as its segments one behind the other, each point but the last an exact stop; so it is written.
On a controller with splines the path bends between the points, and the robot does not stop: each block is named.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.jumps import inside

AS_LINES = code(
    "spline-as-lines",
    Severity.WARNING,
    "the target has no such splines: the block is written as {count} moves, {how} from point to point, with stops",
    "teach more points where the path has to bend, or give the points corners",
)


def straight_splines(program: ir.Program, context: Context) -> ir.Program:
    """For targets without spline blocks, or with blocks of points without settings."""
    blocks = "Spline" in context.capabilities.statements
    if not any(map(_is_spline, walk(*program.modules))):
        return program

    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Spline() if not blocks or _has_settings(statement):
                return _segments(statement, context)
            case ir.Move(motion_class="spline") if not blocks:
                return (replace(statement, motion_class="classic"),)
        return (inside(statement, lambda body: map_body(body, change)),)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _is_spline(node: object) -> bool:
    return isinstance(node, ir.Spline) or (isinstance(node, ir.Move) and node.motion_class == "spline")


def _has_settings(spline: ir.Spline) -> bool:
    """Do its points say what is modal or said by the block elsewhere?"""
    moves = [item for item in spline.body if isinstance(item, ir.Move)]
    return any((one.tool, one.frame, one.speed, one.acceleration) != (None,) * 4 for one in moves)


def _segments(spline: ir.Spline, context: Context) -> ir.Body:
    """The moves of a block with its settings, and what stands between them. The block's corner is that of its end."""
    moves = [item for item in spline.body if isinstance(item, ir.Move)]
    joint = spline.kind == "joint"
    if moves:
        how = "joints" if joint else "straight"
        context.diagnostics.report(AS_LINES, spline.origin, count=len(moves), how=how)
    done: list[ir.Statement] = []
    for item in spline.body:
        if isinstance(item, ir.Move):
            own = {_name(place) for place, _ in item.settings}
            outer = tuple(one for one in spline.settings if _name(one[0]) not in own)
            item = replace(
                item,
                kind="joint" if joint else "linear" if item.kind == "spline" else item.kind,
                blend=spline.blend if item is moves[-1] else ir.BlendStop(),
                settings=(*outer, *item.settings),
                motion_class="classic",
            )
        done.append(item)
    if not done or not spline.origin.comments:
        return tuple(done)
    first = done[0].origin
    comments = (*spline.origin.comments, *(one for one in first.comments if one not in spline.origin.comments))
    return (replace(done[0], origin=replace(first, comments=comments)), *done[1:])


def _name(place: ir.Expression) -> tuple[str, object]:
    """What a setting sets."""
    if isinstance(place, ir.Magnitude):
        place = place.value
    return (place.name, place.indices) if isinstance(place, ir.System) else ("", place)


__all__ = ["straight_splines"]
