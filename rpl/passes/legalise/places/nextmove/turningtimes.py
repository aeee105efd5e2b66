"""Straight moves that say how fast they turn (TP `45deg/sec`), for targets whose moves say a time and no turning speed.

The time is the angle between two constant places, divided by the speed. Other such moves keep their speed; what the
target makes of it is named later.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes import rigid
from rpl.passes.capabilities import MoveSetting
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import Value, pose_of

BY_TIME = code(
    "turn-by-time",
    Severity.WARNING,
    "the turning speed of this move is kept by its time, worked out from its angle; its ramps are within that time",
)
_SMALLEST_DEG = 0.1  # less than this is no turn
_PLACES = (ir.System("tool"), ir.System("base"))


@legalising(
    unless=lambda context: (
        (
            not (
                MoveSetting.SPEED in context.capabilities.settings.of_moves
                and "duration" in context.capabilities.settings.speeds
            )
        )
        or "rotation" in context.capabilities.settings.speeds
        or "swivel_speed" in context.capabilities.system_variables
    ),
    sees=("Move",),
)
def turning_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose moves say a time, but no turning speed, neither in the move nor as a setting."""
    if not any(
        isinstance(one, ir.Move) and _turning_speed(one) is not None for one in walk_for({"Move"}, *program.modules)
    ):
        return program
    unchanged = unchanged_in(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def known(value: ir.Expression) -> Value | None:
            return constant(value, editor.scope, unchanged)

        return edit_bodies(routine, _Turns(context, known).body)

    return edit_routines(program, context, work)


def _turning_speed(move: ir.Move) -> ir.Expression | None:
    """The turning speed of a straight move that says nothing else."""
    speed = move.speed
    if move.kind != "linear" or move.relative or move.search is not None or move.motion_class == "process":
        return None
    if speed is None or speed.path is not None or speed.profile is not None or speed.duration is not None:
        return None
    return speed.rotation


class _Turns:
    """The moves of one routine. `last`: the move before, where nothing has changed the place or its frame since."""

    def __init__(self, context: Context, known: Callable[[ir.Expression], Value | None]) -> None:
        self.context, self.known = context, known
        self.last: ir.Move | None = None

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        self.last = None
        for statement in body:
            if isinstance(statement, ir.Move):
                done.append(self.timed(statement))
                self.last = statement
                continue
            if blocks(statement) or isinstance(statement, ir.CallRoutine | ir.Label):
                statement, self.last = inside(statement, self.body), None
            elif isinstance(statement, ir.Assign) and statement.target in _PLACES:
                self.last = None
            done.append(statement)
        self.last = None
        return tuple(done)

    def timed(self, move: ir.Move) -> ir.Move:
        rate, angle = _turning_speed(move), self.angle(move)
        if rate is None or angle is None or move.speed is None:
            return move
        speed = self.known(rate)
        if not isinstance(speed, int | float) or speed <= 0.0:
            return move
        self.context.diagnostics.report(BY_TIME, move.origin)
        time = ir.RealLiteral(float(f"{angle / speed:.4g}"))
        return replace(move, speed=replace(move.speed, rotation=None, duration=time))

    def angle(self, move: ir.Move) -> float | None:
        """From the place of the move before to this one, in deg."""
        before = self.last
        if before is None or before.relative or (before.tool, before.frame) != (move.tool, move.frame):
            return None
        here, there = pose_of(self.known(before.target)), pose_of(self.known(move.target))
        if here is None or there is None:
            return None
        angle = rigid.clean(here.rotation.inverse.then(there.rotation).angle)
        return angle if angle >= _SMALLEST_DEG else None


__all__ = ["turning_times"]
