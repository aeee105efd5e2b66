"""Where the robot stands before each move, as far as it is constant: its joints, its flange, and the last place as it
was programmed.

A routine begins where the robot stands at all of its calls, and behind a call it stands where the routine ends; behind
labels and loops nothing is known. Tool and frame come from `flow`; where their values are not known, a place still
tells how far it is to the next one that is programmed in the same tool and frame.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

from rpl import ir, registry
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Arm, Context, array
from rpl.passes.legalise.facts.effects import blocks, statements_in
from rpl.passes.legalise.facts.framesinforce import FramesInForce
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.jumps import LOOPS
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.scope import ProgramScope
from rpl.passes.values import Record, Target, Value, component, pose_of

_NEAR = "target_to_joints_near"
_PLACES = ("tool", "base", "robot_root")
_SAME_DEG = 0.01
_ROUNDS = 4  # a routine that calls one that calls one that moves is known by then
Joints = tuple[float, ...]
Seen = tuple[ir.Expression | None, ir.Expression | None, rigid.Pose]


@dataclass(frozen=True, slots=True)
class Stand:
    """`joints` in the arm's units (deg, mm), `flange` in the robot's base, `seen`: tool, frame and the place in it."""

    joints: Joints | None = None
    flange: rigid.Pose | None = None
    seen: Seen | None = None


@dataclass(frozen=True, slots=True)
class Way:
    """The way of a move, as far as known: axes in deg (mm), millimetres and degrees of the tool."""

    axes: Joints | None
    length_mm: float | None
    turn_deg: float | None


NOWHERE_KNOWN = Stand()


class Whereabouts:
    """`ways`: the way of each move by identity, where something of it is known. `starts`, `ends`: where the robot
    stands before each move and behind it. `converted`: the flags of places are the target's already. `settled`: places
    that the beginning of the program sets once and for all are known, too. Without `postures` no joints are looked for
    at places, and no ways. `assuming`: from where nothing is known the arm goes to a place that says no posture as it
    does from all places that are known, if that is the same."""

    def __init__(
        self,
        program: ir.Program,
        context: Context,
        converted: bool = False,
        settled: bool = False,
        postures: bool = True,
        assuming: bool = False,
    ) -> None:
        self.converted, self.postures = converted, postures
        self.ways: dict[int, Way] = {}
        self.starts: dict[int, Stand] = {}
        self.ends: dict[int, Stand] = {}
        self.program = program  # keeps the identities alive
        arm, other = context.robot, context.to_robot
        self.arm: Arm | None = arm if other is None or other is arm else None
        self.scopes = ProgramScope(program)
        self.flow = FramesInForce(program)
        self.unchanged = unchanged_in(program, places=settled)
        self.moving = doing(program, _moves)
        make = registry.dialect(context.source).notation
        self.notation: Any = None if make is None else make()
        self.displaced = any(
            one == ir.System("displacement") for one in walk_for({"system displacement"}, *program.modules)
        )
        self.everywhere: tuple[Joints, ...] = ()  # from where the arm may come, when nothing else is known
        self.begins: dict[int, Stand] = {}  # where the robot stands at all calls of a routine, by identity
        self.finishes: dict[int, Stand] = {}  # where a routine leaves it
        if not self.displaced:
            self.follow()
            if assuming and self.arm is not None:
                self.everywhere = tuple(sorted({one.joints for one in self.ends.values() if one.joints is not None}))
                self.follow()

    def follow(self) -> None:
        """Through all routines, again while what is known of their beginnings and ends grows."""
        calls = _calls(self.program)
        for _ in range(_ROUNDS):
            met: dict[int, list[Stand]] = {}
            before = self.begins, self.finishes
            self.met = met
            finishes = {}
            for module, routine in self.scopes.routines():
                self.scope = self.scopes.routine(module, routine)
                end = self.body(routine.body, self.begins.get(id(routine), NOWHERE_KNOWN))
                handlers = [body for body in bodies(routine)[1:] if body]
                for body in handlers:
                    self.body(body, NOWHERE_KNOWN)
                if calls[routine.name.lower()] and not handlers and _ends_at_its_end(routine.body):
                    finishes[id(routine)] = replace(end, seen=None)
            self.finishes = finishes
            self.begins = {
                id(routine): replace(_common(met[id(routine)]), seen=None)
                for _, routine in self.scopes.routines()
                if 0 < len(met.get(id(routine), ())) == calls[routine.name.lower()]
            }
            if (self.begins, self.finishes) == before:
                break

    def of(self, move: ir.Move) -> Way:
        return self.ways.get(id(move), Way(None, None, None))

    def body(self, body: ir.Body, stand: Stand) -> Stand:
        for statement in body:
            stand = self.statement(statement, stand)
        return stand

    def statement(self, statement: ir.Statement, stand: Stand) -> Stand:
        match statement:
            case ir.Move():
                return self.moved(statement, stand)
            case ir.Label():
                return NOWHERE_KNOWN
            case ir.Assign(target=ir.System(name=name) | ir.Field(base=ir.System(name=name))) if name in _PLACES:
                return replace(stand, seen=None)
            case ir.CallRoutine(name=name, dynamic=None, arguments=given) if (
                routine := self.scope.routine(name)
            ) is not None and not any(isinstance(one, ir.Call) for one in walk(given)):
                self.met.setdefault(id(routine), []).append(stand)
                return self.finishes.get(id(routine), NOWHERE_KNOWN) if self.moves(statement) else stand
        inner = blocks(statement)
        if not inner:
            return NOWHERE_KNOWN if self.moves(statement) else stand
        if isinstance(statement, LOOPS) and self.moves(statement):
            self.body(inner[0], NOWHERE_KNOWN)
            return NOWHERE_KNOWN
        if self.moves(statement) or self.sets(statement):
            return _common([self.body(one, stand) for one in inner])
        return stand

    def moves(self, statement: ir.Statement) -> bool:
        """Does it move the robot, set a place, or call what does?"""
        for one in walk(statement):
            if _moves(one) or (isinstance(one, ir.CallRoutine | ir.Call) and one.name.lower() in self.moving):
                return True
        return False

    def sets(self, statement: ir.Statement) -> bool:
        return any(isinstance(one, ir.System) and one.name in _PLACES for one in walk(statement))

    def moved(self, move: ir.Move, stand: Stand) -> Stand:
        end = self.end(move, stand)
        if self.postures:
            self.ways[id(move)] = self.way(move, stand, end)
        self.starts[id(move)], self.ends[id(move)] = stand, end
        return end

    def end(self, move: ir.Move, stand: Stand) -> Stand:
        if move.search is not None:
            return NOWHERE_KNOWN
        if move.relative:
            return self.further(move, stand)
        target, near = move.target, None
        match target:
            case ir.Builtin(function=name, arguments=(place, asked)) if name == _NEAR:
                target, near = place, self.axes(constant(asked, self.scope, self.unchanged))
                if near is None or move.kind != "joint":
                    return NOWHERE_KNOWN
        goal = constant(target, self.scope, self.unchanged)
        axes = None if near is not None else self.axes(goal)
        if axes is not None:
            flange = None if self.arm is None else rigid.pose_of_matrix(_rows(self.arm.forward(array(axes))))
            return Stand(axes, flange)
        pose = pose_of(goal)
        frames = self.flow.frames.get(id(move))
        if pose is None:
            return NOWHERE_KNOWN
        flange = None if frames is None else frames.flange(pose)
        joints = self.solved(move, goal, flange, stand) if near is None else self.nearest(flange, near)
        return Stand(joints, flange, (move.tool, move.frame, pose))

    def nearest(self, flange: rigid.Pose | None, near: Joints) -> Joints | None:
        if self.arm is None or flange is None or not self.postures:
            return None
        found = self.arm.nearest(array(flange.matrix), array(near))
        return None if found is None else tuple(float(one) for one in found)

    def further(self, move: ir.Move, stand: Stand) -> Stand:
        """Where a relative move ends, along the tool, along the axes of the frame or by axes of the arm."""
        if move.relative == "joints":
            steps = self.axes(constant(_whole(move), self.scope, self.unchanged))
            known = stand.joints is not None and steps is not None
            return (
                Stand(tuple(a + b for a, b in zip(stand.joints or (), steps or (), strict=False))) if known else Stand()
            )
        by, start = pose_of(constant(_whole(move), self.scope, self.unchanged)), self.tools(move, stand, stand)[0]
        frames = self.flow.frames.get(id(move))
        if by is None or start is None or move.relative not in ("tool", "base"):
            return NOWHERE_KNOWN
        if move.relative == "tool":
            end = start.then(by)
        elif _angle(by.rotation, rigid.NO_TURN) < 1e-9:
            end = rigid.Pose(start.position.plus(by.position), start.rotation)
        else:
            return NOWHERE_KNOWN
        flange = None if frames is None else frames.flange(end)
        return Stand(self.solved(move, None, flange, stand), flange, (move.tool, move.frame, end))

    def axes(self, goal: Value | None) -> Joints | None:
        if not isinstance(goal, Record):
            return None
        inner = goal.part("robax")
        goal = inner if isinstance(inner, Record) else goal
        names = ir.AXES if self.arm is None else ir.AXES[: self.arm.axes]
        found = [component(goal, name) for name in names]
        return tuple(float(one) for one in found if isinstance(one, int | float)) if None not in found else None

    def solved(self, move: ir.Move, goal: Value | None, flange: rigid.Pose | None, stand: Stand) -> Joints | None:
        """The joints at a place: those that its flags and the controller's rule choose, for paths the ones nearest to
        the last."""
        if self.arm is None or flange is None or not self.postures:
            return None
        if self.converted and move.kind == "joint" and isinstance(goal, Target):
            return None  # what the source said about the posture is gone
        matrix = array(flange.matrix)
        near = None if stand.joints is None else array(stand.joints)
        flags = dict(goal.flags) if isinstance(goal, Target) and self.notation is not None else {}
        flags = {name: value for name, value in flags.items() if name in self.notation.fields} if flags else {}
        found: Any = None
        if move.kind == "joint" and self.notation is not None:
            if near is not None or 0 < len(flags) == len(self.notation.fields):
                found = self.notation.select(self.arm, matrix, flags, near).joints
            elif not flags:
                found = self.from_everywhere(matrix)
        elif near is not None and move.kind != "circular":  # an arc may turn an axis all around
            found = self.arm.nearest(matrix, near)
        return None if found is None else tuple(float(one) for one in found)

    def from_everywhere(self, flange: Any) -> Any:
        """The joints to which the arm goes from all places where it may be; None where these are not the same."""
        found = [self.notation.select(self.arm, flange, {}, array(one)).joints for one in self.everywhere]
        alike = all(one is not None and abs(one - found[0]).max() <= _SAME_DEG for one in found)
        return found[0] if found and alike else None

    def way(self, move: ir.Move, start: Stand, end: Stand) -> Way:
        axes = None
        if move.relative == "joints":
            steps = self.axes(constant(_whole(move), self.scope, self.unchanged))
            return Way(None if steps is None else tuple(abs(one) for one in steps), None, None)
        if start.joints is not None and end.joints is not None:
            axes = tuple(abs(to - of) for of, to in zip(start.joints, end.joints, strict=False))
        if move.kind == "joint":
            return Way(axes, None, None)
        by = pose_of(constant(_whole(move), self.scope, self.unchanged)) if move.relative in ("tool", "base") else None
        if by is not None:
            return Way(axes, by.position.length, _angle(by.rotation, rigid.NO_TURN))
        here, there = self.tools(move, start, end)
        if here is None or there is None:
            return Way(axes, None, None)
        turn = _angle(here.rotation, there.rotation)
        if move.kind == "linear":
            return Way(axes, _far(here.position, there.position), turn)
        via = pose_of(constant(move.via, self.scope, self.unchanged)) if move.via is not None else None
        if via is None or move.swept is not None or end.seen is None or start.seen is None:
            return Way(axes, None, turn)
        return Way(axes, arc_length(here.position, via.position, there.position), turn)

    def tools(self, move: ir.Move, start: Stand, end: Stand) -> tuple[rigid.Pose | None, rigid.Pose | None]:
        """Both ends of a path as places of the tool in the frame of the move."""
        if start.seen is not None and end.seen is not None and start.seen[:2] == end.seen[:2]:
            return start.seen[2], end.seen[2]
        frames = self.flow.frames.get(id(move))
        if frames is None or frames.tool is None or frames.base is None or start.flange is None or end.flange is None:
            return None, None
        back = frames.base.inverse
        return back.then(start.flange).then(frames.tool), back.then(end.flange).then(frames.tool)


def _calls(program: ir.Program) -> Counter[str]:
    """How often the routines (folded names) are named as what runs: those that may be started otherwise than by a plain
    call once more."""
    found = Counter[str](task.entry.lower() for task in program.tasks)
    found.update((program.entry.lower(),) if program.entry else ())
    for node in walk_for({"CallRoutine", "Call", "ConnectInterrupt", "TaskControl"}, *program.modules):
        match node:
            case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                found.update(one.name.lower() for module in program.modules for one in module.routines)
            case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.ConnectInterrupt(routine=name):
                found[name.lower()] += 1
            case ir.TaskControl(task=name):
                found[name.lower()] += 1
    return found


def _ends_at_its_end(body: ir.Body) -> bool:
    """Does nothing leave this body of a routine but its last statement?"""
    return not any(isinstance(one, ir.Return | ir.Goto | ir.Raise) for one in statements_in(body[:-1]))


def _common(stands: list[Stand]) -> Stand:
    """Where the robot stands in any case."""
    return stands[0] if all(one == stands[0] for one in stands) else NOWHERE_KNOWN


def _whole(move: ir.Move) -> ir.Expression:
    """The way of a relative move with every component: those that it does not name are 0."""
    target = move.target
    if not isinstance(target, ir.Aggregate) or any(name is None for name, _ in target.entries):
        return target
    names = ir.AXES if move.relative == "joints" else ir.POSE
    given = {name.lower() for name, _ in target.entries if name is not None}
    if not given <= set(names):
        return target
    missing = tuple((name, ir.RealLiteral(0.0)) for name in names if name not in given)
    return replace(target, entries=(*target.entries, *missing))


def _moves(node: object) -> bool:
    match node:
        case ir.Move() | ir.Spline() | ir.TaskControl() | ir.Vendor() | ir.Opaque():
            return True
        case ir.CallRoutine(dynamic=dynamic):
            return dynamic is not None
        case ir.Assign(target=ir.System(name=name) | ir.Field(base=ir.System(name=name))):
            return name in _PLACES
    return False


def arc_length(start: rigid.Vector, via: rigid.Vector, end: rigid.Vector) -> float | None:
    """Millimetres from start through via to end along a circle; None for points on a line."""
    one, two = via.plus(start, -1.0), end.plus(start, -1.0)
    normal = one.cross(two)
    square = 4.0 * normal.dot(normal)
    if square < 1e-9:
        return None
    # the centre, seen from the start: the circle through three points
    to_centre = normal.cross(one).times(two.dot(two)).plus(two.cross(normal), one.dot(one)).times(2.0 / square)
    from_centre, last = to_centre.times(-1.0), two.plus(to_centre, -1.0)
    sine = from_centre.cross(last).dot(normal) / normal.length
    angle = math.atan2(sine, from_centre.dot(last)) % (2.0 * math.pi)
    return angle * to_centre.length


def _angle(one: rigid.Rotation, two: rigid.Rotation) -> float:
    return one.inverse.then(two).angle


def _far(one: rigid.Vector, two: rigid.Vector) -> float:
    return two.plus(one, -1.0).length


def _rows(matrix: Any) -> list[list[float]]:
    return [[float(one) for one in row] for row in matrix]


__all__ = ["Way", "Whereabouts", "arc_length"]
