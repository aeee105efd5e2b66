"""The least time of a move (V+ DURATION) for targets without that setting: the time that a move says where it can say
one (RAPID `\\T`), else the speed that drives a straight move for so long, worked out from its length.

The length is taken from where the robot stands, so it has to stand there. A move in joints, and a time that depends on
the run, keep the setting; what the target makes of it is named later.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.effects import blocks
from rpl.passes.legalise.jumps import inside
from rpl.passes.legalise.modalflow import Flow
from rpl.passes.legalise.speeds import USUAL

BY_SPEED = code(
    "move-time-by-speed",
    Severity.WARNING,
    "the time of this move is kept by a speed that is worked out from its length; its ramps take their time on top",
)
_TIME, _SPEED = ir.System("move_duration"), ir.System("path_speed")


def move_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the setting."""
    can = context.capabilities
    if _TIME.name in can.system_variables or _TIME not in list(walk(*program.modules)):
        return program
    said = "duration" in (can.speeds or USUAL) and (not can.modal_motion or "speed" in can.move_settings)
    flow = Flow.of(program, dict(rules_of(context.source).system_defaults))

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Times(editor, said, flow).body)

    return edit_routines(program, context, work)


class _Times:
    """The moves of one routine. `said`: the target's moves say a time."""

    def __init__(self, editor: Editor, said: bool, flow: Flow) -> None:
        self.editor, self.said, self.flow = editor, said, flow

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        stands = False
        for statement in body:
            if isinstance(statement, ir.Move):
                statement = self.with_time(statement) if self.said else statement
                statement = self.with_speed(statement, done, stands)
                stands = isinstance(statement.blend, ir.BlendStop)
            elif isinstance(statement, ir.WaitForMotion):
                stands = True
            elif blocks(statement) or isinstance(statement, ir.CallRoutine | ir.Label):
                statement, stands = inside(statement, self.body), False
            done.append(statement)
        return tuple(done)

    def with_time(self, move: ir.Move) -> ir.Move:
        """A move with a speed of its own keeps that, and gets no time: it would be faster where the way is long."""
        kept, time = _taken(move)
        if time is None or any(name == _SPEED for name, _ in kept):
            return move
        return replace(move, settings=kept, speed=replace(move.speed or ir.Speed(), duration=time))

    def with_speed(self, move: ir.Move, before: list[ir.Statement], stands: bool) -> ir.Move:
        kept, time = _taken(move)
        goal = self.editor.type_of(move.target)
        placed = isinstance(move.target, ir.Name | ir.Index) and isinstance(goal, ir.PoseType)
        if time is None or move.kind != "linear" or move.relative or move.speed is not None or not placed:
            return move
        if not stands:
            before.append(ir.WaitForMotion(origin=replace(move.origin, comments=())))
        self.editor.context.diagnostics.report(BY_SPEED, move.origin)
        here = ir.Field(ir.Builtin("current_target", ()), "trans")
        length = ir.Builtin("distance", (here, ir.Field(move.target, "trans")))
        known = self.editor.temporary("move_speed", ir.RealType())
        origin = replace(move.origin, comments=())
        speed: ir.Expression = ir.Binary("/", known, time)
        most = next((value for name, value in kept if name == _SPEED), self.flow.at(move)[_SPEED.name])
        if most is not None:
            speed = ir.Builtin("min", (most, speed))
        before += (ir.Assign(known, length, origin=origin), ir.Assign(known, speed, origin=origin))
        rest = tuple(pair for pair in kept if pair[0] != _SPEED)
        return replace(move, settings=(*rest, (_SPEED, known)))


def _taken(move: ir.Move) -> tuple[tuple[tuple[ir.Expression, ir.Expression], ...], ir.Expression | None]:
    """The settings of the move without its time, and the time."""
    time = next((value for name, value in move.settings if name == _TIME), None)
    return tuple(pair for pair in move.settings if pair[0] != _TIME), time


__all__ = ["move_times"]
