"""Spline blocks and moves of the spline kind for targets that have neither.

Also where the target has blocks, but the points say tools, frames and speeds of their own, which such a target has not.

Where all places are known, the moves follow the curve that a run takes (`splinearcs`). Else they are straight, with a
stop at each point: each such block is named, since its path bends between the points and has no stops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.places.partialplaces import moving_routines
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.source.ways.curvepoints import OTHER_CURVE, SAME_CURVE_MM
from rpl.passes.legalise.source.ways.splinearcs import SplineArcs, modes_set, settings_of, with_comments
from rpl.passes.legalise.stages import legalising

AS_LINES = code(
    "spline-as-lines",
    Severity.WARNING,
    "the target has no such splines: the block is written as {count} moves, {how} from point to point, with stops",
    "teach more points where the path has to bend, or give the points corners",
)
LEFT_OUT = code(
    "spline-speed-rule",
    Severity.WARNING,
    "the target has no {what} in a path: left out, the path stays and its speeds are those of its moves",
    "give the moves the speeds that make the time",
)
_RULES = {"time": "times of parts (TIME_BLOCK)", "constant": "parts of constant speed (CONST_VEL)"}


@legalising(unless=lambda context: "PathRule" in context.capabilities.statements, sees=("PathRule",))
def without_path_rules(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose blocks say nothing of times and constant speeds: told once for each part, where it begins."""

    def change(node: object) -> object:
        if not isinstance(node, ir.PathRule):
            return node
        what, _, edge = node.rule.partition("_")
        if edge == "start":
            context.diagnostics.report(LEFT_OUT, node.origin, what=_RULES[what])
        return ir.Nothing(origin=node.origin)

    return replace(program, modules=tuple(rewrite(module, change) for module in program.modules))


@legalising(sees=("Spline", "spline move"))
def straight_splines(program: ir.Program, context: Context) -> ir.Program:
    """For targets without spline blocks, or with blocks of points without settings."""
    blocks = "Spline" in context.capabilities.statements
    unchanged, moving, modes = unchanged_in(program), moving_routines(program), modes_set(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        arcs = SplineArcs(modes, context, editor.scope, unchanged, moving)

        def change(body: ir.Body) -> ir.Body:
            done: list[ir.Statement] = []
            for at, statement in enumerate(body):
                match statement:
                    case ir.Spline() if blocks and (said := _by_settings(statement, body[:at])) is not None:
                        deviation = arcs.apart(statement, body[:at])
                        written = arcs.written(statement, body[:at]) if deviation > SAME_CURVE_MM else None
                        if deviation > SAME_CURVE_MM and written is None:
                            context.diagnostics.report(OTHER_CURVE, statement.origin, deviation=deviation)
                        done += written or (said,)
                    case ir.Spline():
                        done += arcs.written(statement, body[:at]) or _segments(statement, context)
                    case ir.Move(motion_class="spline") if not blocks:
                        done.append(replace(statement, motion_class="classic"))
                    case _:
                        done.append(inside(statement, change))
            same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
            return body if same else tuple(done)

        return edit_bodies(routine, change)

    return edit_routines(program, context, work)


def _is_spline(node: object) -> bool:
    return isinstance(node, ir.Spline) or (isinstance(node, ir.Move) and node.motion_class == "spline")


def _by_settings(spline: ir.Spline, before: Sequence[ir.Statement]) -> ir.Spline | None:
    """The block as a target has it whose points say their speed as a setting, and whose tool and frame are those in
    force; None where that is not enough."""
    moves = [item for item in spline.body if isinstance(item, ir.Move)]
    if all((one.tool, one.frame, one.speed, one.acceleration) == (None,) * 4 for one in moves):
        return spline
    last = next((one for one in reversed(before) if not isinstance(one, ir.Nothing)), None)
    if not isinstance(last, ir.Move) or any((one.tool, one.frame) != (last.tool, last.frame) for one in moves):
        return None
    plain = [one.speed for one in moves if one.speed is not None]
    if any(one.acceleration is not None for one in moves) or any(one != ir.Speed(path=one.path) for one in plain):
        return None
    return replace(spline, body=tuple(_with_settings(one) if isinstance(one, ir.Move) else one for one in spline.body))


def _with_settings(move: ir.Move) -> ir.Move:
    speed = move.speed.path if move.speed is not None else None
    settings = ((ir.System("path_speed"), speed),) if speed is not None else ()
    more = (*settings, *move.settings)
    return replace(move, speed=None, settings=more, blend=None, motion_class="spline")


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
            item = replace(
                item,
                kind="joint" if joint else "linear" if item.kind == "spline" else item.kind,
                blend=spline.blend if item is moves[-1] else ir.BlendStop(),
                settings=settings_of(item, spline),
                motion_class="classic",
            )
        done.append(item)
    return with_comments(tuple(done), spline)


__all__ = ["straight_splines", "without_path_rules"]
