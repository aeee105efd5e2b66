"""Relative moves that also turn the tool, for targets whose relative moves only shift it, and joint moves by a way in
the axes of the frame or the tool, for those that count such ways in joints.

Such a move goes to a place that is computed from where the one before it ends: a way in the tool's axes is a product of
places, a way in the axes of the frame shifts the place and turns it about itself. Constants are computed here.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes import rigid
from rpl.passes.capabilities import TurnedWay
from rpl.passes.fold import Unchanged, constant, lasting
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.paths.movebefore import MovesBefore
from rpl.passes.legalise.paths.targets import Whole, here
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.settings.usualplaces import usual_places
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.passes.typewords import type_word
from rpl.passes.values import Target, real

_POSITION = ("x", "y", "z")
_PLACES = 9


@legalising(
    unless=lambda context: context.capabilities.motion.turned_ways == frozenset(TurnedWay),
    sees=("move relative to base", "move relative to tool"),
)
def turned_ways(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such relative moves."""
    scopes, unchanged, usual = ProgramScope(program), unchanged_in(program), usual_places(program)
    before = MovesBefore(program, unchanged)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            worker = _Turned(context, scopes.routine(module, routine), unchanged, before, usual)
            done = edit_bodies(routine, worker.body)
            routines.append(replace(done, declarations=(*routine.declarations, *worker.declared)))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


class _Turned(Whole):
    """The moves of one routine. `usual`: the tool, the frame, that a move has which names none although others do."""

    def __init__(
        self, context: Context, scope: Scope, unchanged: Unchanged, before: MovesBefore, usual: frozenset[str]
    ) -> None:
        super().__init__(context, scope, unchanged, before)
        self.usual = usual

    def needs_work(self, move: ir.Move) -> bool:
        can = self.context.capabilities.motion.turned_ways
        type = self.type_of(move.target)
        if move.relative not in ("base", "tool") or move.via is not None or type is None:
            return False
        if isinstance(type, ir.JointsType):
            return False
        joint = move.kind == "joint" and TurnedWay.JOINT not in can
        return joint or (move.relative not in can and self.turns(move.target))

    def via_needs_work(self, move: ir.Move) -> bool:
        return False

    def turns(self, way: ir.Expression) -> bool:
        """Does it turn the tool, or may it?"""
        if isinstance(way, ir.Aggregate):
            angles = [value for name, value in way.entries if name in ir.ANGLES]
            parts = [constant(one, self.scope, self.unchanged) for one in angles]
            return any(part is None or part != 0 for part in parts)
        pose = self.pose(way)
        return pose is None or abs(pose.rotation.quaternion[0]) < 1.0 - 1e-12

    def pose(self, place: ir.Expression) -> rigid.Pose | None:
        """The constant place."""
        value = constant(place, self.scope, self.unchanged)
        value = value.pose if isinstance(value, Target) else value
        return value if isinstance(value, rigid.Pose) else None

    def whole(self, move: ir.Move, done: list[ir.Statement]) -> list[ir.Statement]:
        start = self.last_pose(done, move) or self.noted(done, move)
        if start is None:
            self.stop_before(done, move)
            tool, frame = (ir.System("null_frame") if name in self.usual else None for name in ("tool", "base"))
            start = here(replace(move, tool=move.tool or tool, frame=move.frame or frame))
        known, way = self.pose(start), self.way(move.target)
        shift = self.pose(way)
        steady = lasting(start, self.scope) is not None and lasting(way, self.scope) is not None
        if known is not None and shift is not None and steady:
            return [replace(move, target=self.goal(known, shift, move), relative=None)]
        later = replace(move.origin, comments=())
        if move.relative == "tool":
            return [replace(move, target=ir.Builtin("displaced_in_tool", (start, way)), relative=None)]
        type = self.type_of(start) or ir.TargetType(self.scope.rules.name)
        begin, goal = (ir.Name(self.context.fresh(name)) for name in ("rpl_here", "rpl_turned"))
        self.declared += [ir.Variable(name.id, type, scope="routine") for name in (begin, goal)]
        steps: list[ir.Statement] = [
            ir.Assign(begin, start, origin=move.origin),
            ir.Assign(goal, ir.Builtin("displaced", (begin, self.turn(way))), origin=later),
        ]
        for name in _POSITION:
            moved = ir.Binary("+", ir.Field(begin, name), _part(way, name))
            steps.append(ir.Assign(ir.Field(goal, name), moved, origin=later))
        return [*steps, replace(move, target=goal, relative=None, origin=later)]

    def way(self, target: ir.Expression) -> ir.Expression:
        """The way as a whole pose."""
        if isinstance(target, ir.Aggregate):
            given = {name: value for name, value in target.entries if name is not None}
            entries = tuple((name, given.get(name, ir.RealLiteral(0.0))) for name in (*_POSITION, *ir.ANGLES))
            return ir.Aggregate(entries, type_name="pose")
        return ir.Builtin("pose_of", (target,)) if isinstance(self.type_of(target), ir.TargetType) else target

    def turn(self, way: ir.Expression) -> ir.Expression:
        """What turns a place about itself; how it shifts does not matter."""
        if not isinstance(way, ir.Aggregate):
            return way
        none = tuple((name, ir.RealLiteral(0.0)) for name in _POSITION)
        return ir.Aggregate((*none, *((name, _part(way, name)) for name in ir.ANGLES)), type_name="pose")

    def goal(self, start: rigid.Pose, way: rigid.Pose, move: ir.Move) -> ir.Expression:
        """The place that a way leads to, without flags."""
        if move.relative == "tool":
            goal = start.then(way)
        else:
            goal = rigid.Pose(start.position.plus(way.position), way.rotation.then(start.rotation))
        values = (goal.position.x, goal.position.y, goal.position.z, *goal.rotation.zyx)
        named = zip((*_POSITION, *ir.ANGLES), values, strict=True)
        entries = tuple((name, real(round(value, _PLACES))) for name, value in named)
        return ir.Aggregate(entries, type_name=type_word(ir.TargetType(self.scope.rules.name)))


def _part(way: ir.Expression, name: str) -> ir.Expression:
    """A component of a way."""
    if isinstance(way, ir.Aggregate):
        return dict(way.entries)[name]
    base = way.arguments[0] if isinstance(way, ir.Builtin) and way.function == "pose_of" else way
    return ir.Field(base, name)


__all__ = ["turned_ways"]
