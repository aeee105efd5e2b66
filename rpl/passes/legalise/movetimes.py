"""Times of moves for targets that cannot say them: the least time as a setting (V+ DURATION), and the time of one move
(URScript `t=`, TP `2.0sec`).

A least time becomes the time that a move says where it can say one (RAPID `\\T`). Else the move gets the speed that
takes so long: a straight move by its length, a move to joints by the axis that is the slowest. Where the way is not
constant it is taken from where the robot stands, so it has to stand there. Other moves keep their speed, which is
named later.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.effects import blocks
from rpl.passes.legalise.jumps import inside
from rpl.passes.legalise.modalflow import Flow
from rpl.passes.legalise.speeds import USUAL
from rpl.passes.legalise.walk import unchanged_in
from rpl.passes.values import Record, Value, component, pose_of

BY_SPEED = code(
    "move-time-by-speed",
    Severity.WARNING,
    "the time of this move is kept by a speed that is worked out from its length; its ramps take their time on top",
)
_TIME, _SPEED, _PERCENT = ir.System("move_duration"), ir.System("path_speed"), ir.System("joint_speed")
_AXES = ("j1", "j2", "j3", "j4", "j5", "j6")
Settings = tuple[tuple[ir.Expression, ir.Expression], ...]


@dataclass(frozen=True, slots=True)
class _Wanted:
    """Which times the target cannot say, and whether its moves say their own."""

    least: bool
    own: bool
    said: bool


def move_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the setting, or whose moves say no time."""
    can = context.capabilities
    said = "duration" in (can.speeds or USUAL) and (not can.modal_motion or "speed" in can.move_settings)
    nodes = list(walk(*program.modules))
    wanted = _Wanted(
        _TIME.name not in can.system_variables and _TIME in nodes,
        not said and any(isinstance(one, ir.Speed) and one.duration is not None for one in nodes),
        said,
    )
    if not wanted.least and not wanted.own:
        return program
    flow = Flow.of(program, dict(rules_of(context.source).system_defaults))
    unchanged = unchanged_in(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def known(value: ir.Expression) -> Value | None:
            return constant(value, editor.scope, unchanged)

        return edit_bodies(routine, _Times(editor, wanted, flow, known).body)

    return edit_routines(program, context, work)


class _Times:
    """The moves of one routine. `last`: the move before, where nothing has changed the place or its frame since."""

    def __init__(
        self, editor: Editor, wanted: _Wanted, flow: Flow, known: Callable[[ir.Expression], Value | None]
    ) -> None:
        self.editor, self.wanted, self.flow, self.known = editor, wanted, flow, known
        self.last: ir.Move | None = None

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        stands, self.last = False, None
        for statement in body:
            if isinstance(statement, ir.Move):
                move = self.with_time(statement) if self.wanted.said else statement
                done.append(self.with_speed(move, done, stands))
                stands, self.last = isinstance(statement.blend, ir.BlendStop), statement
                continue
            if isinstance(statement, ir.WaitForMotion):
                stands = True
            elif blocks(statement) or isinstance(statement, ir.CallRoutine | ir.Label):
                statement, stands = inside(statement, self.body), False
                self.last = None
            elif isinstance(statement, ir.Assign) and statement.target in (ir.System("tool"), ir.System("base")):
                self.last = None
            done.append(statement)
        self.last = None
        return tuple(done)

    def with_time(self, move: ir.Move) -> ir.Move:
        """A move with a speed of its own keeps that, and gets no time: it would be faster where the way is long."""
        kept, time = _taken(move)
        if time is None or any(name == _SPEED for name, _ in kept):
            return move
        return replace(move, settings=kept, speed=replace(move.speed or ir.Speed(), duration=time))

    def with_speed(self, move: ir.Move, before: list[ir.Statement], stands: bool) -> ir.Move:
        kept, time = _taken(move)
        least = time is not None and self.wanted.least
        own = move.speed.duration if move.speed is not None and self.wanted.own else None
        if move.relative or move.search is not None or (own is None and (not least or move.speed is not None)):
            return move
        if time is None or own is not None:
            kept, time = move.settings, own
        assert time is not None  # one of the two is there
        name = _SPEED if move.kind == "linear" else _PERCENT
        most = (
            next((value for one, value in kept if one == name), self.flow.at(move)[name.name]) if own is None else None
        )
        speed = self.constant_speed(move, time) if own is not None else None
        if speed is None:
            steps = self.way(move, time)
            if not steps:
                return move
            origin = replace(move.origin, comments=())
            if not stands:
                before.append(ir.WaitForMotion(origin=origin))
            before += (replace(one, origin=origin) for one in steps)
            result = steps[0].target
            speed = ir.Binary("/", result, time)
            if most is not None:
                speed = ir.Builtin("min", (most, speed))
            if move.kind == "joint":
                speed = ir.Builtin("min", (ir.RealLiteral(100.0), speed))
            before.append(ir.Assign(result, speed, origin=origin))
            speed = result
        self.editor.context.diagnostics.report(BY_SPEED, move.origin)
        rest = tuple(pair for pair in kept if pair[0] != name)
        own_speed = None if move.speed is None else replace(move.speed, duration=None, path=None, joint=None)
        if own_speed is not None:
            which = "path" if move.kind == "linear" else "joint"
            own_speed = replace(own_speed, path=speed) if which == "path" else replace(own_speed, joint=speed)
            return replace(move, settings=rest, speed=own_speed)
        return replace(move, settings=(*rest, (name, speed)))

    def constant_speed(self, move: ir.Move, time: ir.Expression) -> ir.Expression | None:
        """The speed (mm/s) or the share of the axes' speeds (percent) of a way between constant places."""
        before, seconds = self.last, self.known(time)
        if before is None or before.relative or not isinstance(seconds, int | float) or seconds <= 0:
            return None
        start, goal = self.known(before.target), self.known(move.target)
        if move.kind == "joint":
            arm, here, there = self.editor.context.robot, self.axes(start), self.axes(goal)
            if arm is None or here is None or there is None:
                return None
            way = max(abs(to - of) / top for of, to, top in zip(here, there, arm.speeds, strict=False)) * 100.0
            return ir.RealLiteral(round(float(min(way / seconds, 100.0)), 4)) if way > 0.0 else None
        here_pose, there_pose = pose_of(start), pose_of(goal)
        same = (before.tool, before.frame) == (move.tool, move.frame)
        if move.kind != "linear" or here_pose is None or there_pose is None or not same:
            return None
        one, two = here_pose.position, there_pose.position
        way = math.dist((one.x, one.y, one.z), (two.x, two.y, two.z))
        return ir.RealLiteral(round(way / seconds, 3)) if way > 0.001 else None

    def axes(self, value: Value | None) -> list[float] | None:
        if not isinstance(value, Record):
            return None
        found = [component(value, name) for name in _AXES]
        return [float(one) for one in found if isinstance(one, int | float)] if None not in found else None

    def way(self, move: ir.Move, time: ir.Expression) -> list[ir.Assign]:
        """Steps whose first target ends as the length of the way (mm), or as 100 times the seconds at full speed: no
        less than 1 percent takes in the time, as a move to where the arm is has a speed too."""
        goal, arm = self.editor.type_of(move.target), self.editor.context.robot
        if not isinstance(move.target, ir.Name | ir.Index):
            return []
        if move.kind == "linear" and isinstance(goal, ir.PoseType):
            length = self.editor.temporary("move_speed", ir.RealType())
            here = ir.Field(ir.Builtin("current_target", ()), "trans")
            return [ir.Assign(length, ir.Builtin("distance", (here, ir.Field(move.target, "trans"))))]
        if move.kind != "joint" or not isinstance(goal, ir.JointsType) or arm is None:
            return []
        share = self.editor.temporary("move_share", ir.RealType())
        now = self.editor.temporary("joints_now", ir.JointsType())
        steps = [ir.Assign(share, time), ir.Assign(now, ir.Builtin("current_joints", ()))]
        for name, top in zip(_AXES, arm.speeds, strict=False):
            turn = ir.Builtin("abs", (ir.Binary("-", ir.Field(move.target, name), ir.Field(now, name)),))
            needed = ir.Binary("*", turn, ir.RealLiteral(round(100.0 / float(top), 6)))
            steps.append(ir.Assign(share, ir.Builtin("max", (share, needed))))
        return steps


def _taken(move: ir.Move) -> tuple[Settings, ir.Expression | None]:
    """The settings of the move without its time, and the time."""
    time = next((value for name, value in move.settings if name == _TIME), None)
    return tuple(pair for pair in move.settings if pair[0] != _TIME), time


__all__ = ["move_times"]
