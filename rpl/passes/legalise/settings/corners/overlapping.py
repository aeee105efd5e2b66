"""Moves that a program's own controller leaves out because their corner overlaps with the one before (Universal
Robots), for controllers that make both corners smaller instead. Only places and sizes that are constant can be told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.cornersizes import written_size
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import pose_of

LEFT_OUT = code(
    "move-left-out",
    Severity.WARNING,
    "the blend of this move and the one before it are longer than the {way:g} mm between them: the controller leaves"
    " the move out, and so does this program",
)
_SLACK_MM = 1e-3


@legalising()
def left_out_moves(program: ir.Program, context: Context) -> ir.Program:
    """The program without the moves that its own controller leaves out, for controllers that drive them."""
    source, target = (bool(rules_of(one).inputs.overlapping_blends) for one in (context.source, context.target))
    if not source or target:
        return program

    def change(scope: Scope, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        last: _Corner | None = None
        for statement in body:
            corner = _corner(statement, scope)
            paths = last is not None and corner is not None and "joint" not in (last.move.kind, corner.move.kind)
            if paths and corner is not None and last is not None and last.overlaps(corner):
                context.diagnostics.report(LEFT_OUT, statement.origin, way=round(last.way_to(corner), 3))
                continue
            done.append(statement)
            if not isinstance(statement, ir.Nothing):
                last = corner
        return body if len(done) == len(body) else tuple(done)

    return _rewritten(program, change)


@dataclass(frozen=True, slots=True)
class _Corner:
    """A path move with a corner of constant size (mm; 0: it stops) at a constant place."""

    move: ir.Move
    place: rigid.Vector
    frames: tuple[object, object]
    size: float

    def way_to(self, other: _Corner) -> float:
        return other.place.plus(self.place, -1.0).length

    def overlaps(self, other: _Corner) -> bool:
        way = self.way_to(other)
        both = min(self.size, other.size) > 0.0 and self.frames == other.frames
        return both and way > _SLACK_MM and self.size + other.size > way + _SLACK_MM


def _corner(statement: ir.Statement, scope: Scope) -> _Corner | None:
    if not isinstance(statement, ir.Move) or statement.relative is not None:
        return None
    pose, size = pose_of(constant(statement.target, scope)), written_size(statement.blend, scope)
    if pose is None or size is None:
        return None
    return _Corner(statement, pose.position, (statement.tool, statement.frame), size)


def _rewritten(program: ir.Program, change: Callable[[Scope, ir.Body], ir.Body]) -> ir.Program:
    scopes = ProgramScope(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = scopes.routine(module, routine)

        def on_body(body: ir.Body) -> ir.Body:
            inner = [statement if isinstance(statement, ir.Move) else inside(statement, on_body) for statement in body]
            same = all(new is old for new, old in zip(inner, body, strict=True))
            return change(scope, body if same else tuple(inner))

        return edit_bodies(routine, on_body)

    return edit_each(program, work)


__all__ = ["left_out_moves", "written_size"]
