"""Actions on the path of a linear or circular move: the move is cut at the points where they happen.

A controller has no instruction that says a distance on a path. Where both ends of a move are constants, the point is
computed, and the robot goes through it with the smallest corner; the action stands behind that point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.emulator.rotations import rotation_angle
from rpl.writing.statements import CannotSayError

from . import tables
from .job import pose_of_joints
from .motion import Goal, Motion
from .operands import constant
from .places import WORLD, Position, Values, between, inverse, matrix, product

CUT = code(
    "inform-path-event",
    Severity.WARNING,
    "an action on the path stands behind a point that the move is cut at, {along:.1f} mm from its start",
)
IN_CORNER = code(
    "inform-corner-event",
    Severity.WARNING,
    "an action in the corner between two moves is done where the corner begins",
)
SMALLER = code(
    "inform-smaller-corner",
    Severity.WARNING,
    "an action on the path is {rest:.1f} mm before a corner of {corner:.1f} mm, which is cut to half of that way",
)
LOST = code(
    "inform-path-event-lost",
    Severity.LOSS,
    "INFORM cannot say an action at a place on the path here: {reason}",
    "the program stops there with PAUSE; teach a point where the action happens",
)
if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

Action = ir.Assign | ir.CallRoutine
_NEAR_MM = 0.5  # an action that near to an end of the move is at the end
_SAME_RAD = 1e-4
_CORNER_MM = tables.TAGS["CR"][0]


@dataclass(slots=True)
class Parts:
    """A move with what happens on its way: at its start, some time later, where it is cut, and at its end."""

    begun: list[Action] = field(default_factory=list)
    later: list[tuple[ir.Expression, Action]] = field(default_factory=list)  # so long after the start, in order
    cuts: list[tuple[ir.Move, list[Action]]] = field(default_factory=list)
    ended: list[Action] = field(default_factory=list)
    last: ir.Move | None = None  # what is left behind the cuts, where it is not the move itself


def parts_of(move: ir.Move, motion: Motion) -> Parts:
    """Raises CannotSayError for an action whose place cannot be said."""
    done = Parts()
    apart: list[ir.Trigger] = []
    for trigger in move.triggers:
        if not isinstance(trigger, ir.Trigger):
            raise CannotSayError("it is kept in a variable", LOST)
        if any(constant(one) != 0 for one in (trigger.distance, trigger.delay) if one is not None):
            apart.append(trigger)
        else:
            (done.begun if trigger.reference == "start" else done.ended).append(trigger.action)
    if apart:
        whole = replace(done, begun=[*done.begun], ended=[*done.ended])
        try:
            _cut(move, apart, motion, done)
        except CannotSayError:
            if not all(map(_by_time, apart)) or move.search is not None or move.concurrent:
                raise
            done = replace(whole, later=_in_order(apart))
    blended = move.blend is not None and move.blend != ir.BlendStop()
    if (done.ended and blended) or (done.begun and done.ended and not motion.stands):
        motion.report_once(IN_CORNER, move.origin, str(move.origin.line))
    return done


def _by_time(trigger: ir.Trigger) -> bool:
    """Does it come some time behind the start of the move?"""
    distance, delay = trigger.distance, trigger.delay
    if trigger.reference != "start" or delay is None or (distance is not None and constant(distance) != 0):
        return False
    known = constant(delay)
    return known is None or known > 0


def _in_order(triggers: Sequence[ir.Trigger]) -> list[tuple[ir.Expression, Action]]:
    """Each with the time behind the one before it."""
    if len(triggers) == 1 and triggers[0].delay is not None:
        return [(triggers[0].delay, triggers[0].action)]
    delays = [0.0 if one.delay is None else constant(one.delay) for one in triggers]
    found: list[tuple[ir.Expression, Action]] = []
    before = 0.0
    for delay, trigger in sorted(zip(delays, triggers, strict=True), key=lambda pair: pair[0] or 0.0):
        if delay is None:
            raise CannotSayError("several times behind its start, one of them computed", LOST)
        found.append((ir.RealLiteral(round(delay - before, 6)), trigger.action))
        before = delay
    return found


def _cut(move: ir.Move, triggers: Sequence[ir.Trigger], motion: Motion, done: Parts) -> None:
    """Puts the actions in the order of their places."""
    if move.kind not in ("linear", "circular") or move.relative or move.search or move.concurrent or move.swept:
        raise CannotSayError(f"the move is no plain linear or circular one ({move.kind})", LOST)
    way = _way(move, motion)
    events = sorted(((_along(one, move, way.length), one.action) for one in triggers), key=lambda event: event[0])
    for along, action in events:
        if not -_NEAR_MM <= along <= way.length + _NEAR_MM:
            raise CannotSayError(f"the place is outside of the move, {along:.1f} mm from its start", LOST)
        if along < _NEAR_MM:
            done.begun.append(action)
    last = way.length - _NEAR_MM - _CORNER_MM
    done.ended[:0] = [action for along, action in events if along > last]
    before = 0.0
    for along, action in events:
        if along < _NEAR_MM or along > last:
            continue
        motion.diagnostics.report(CUT, move.origin, along=along)
        if done.cuts and along < before + _NEAR_MM:
            done.cuts[-1][1].append(action)
            continue
        point = along + _CORNER_MM  # what stands behind it is done where its corner begins
        piece = replace(way.piece(move, before, point), blend=ir.BlendDistance(ir.RealLiteral(_CORNER_MM)))
        done.cuts.append((replace(piece, origin=replace(move.origin, comments=())), [action]))
        before = point
    size = constant(move.blend.distance) if isinstance(move.blend, ir.BlendDistance) else None
    if done.cuts and size is not None and way.length - before < 2 * size:
        motion.diagnostics.report(SMALLER, move.origin, rest=way.length - before, corner=size)
    if done.cuts and move.kind == "circular":
        done.last = way.piece(move, before, way.length)


def _along(trigger: ir.Trigger, move: ir.Move, length: float) -> float:
    """Where the action happens, mm from the start of the move; a time is a way at the move's speed."""
    distance, delay = (constant(one) if one is not None else 0.0 for one in (trigger.distance, trigger.delay))
    if distance is None or delay is None:
        raise CannotSayError("its distance is computed", LOST)
    if delay:
        speed = None if move.speed is None or move.speed.path is None else constant(move.speed.path)
        if speed is None:
            raise CannotSayError("a time before or behind a place, and the speed is computed", LOST)
        distance += delay * speed
    along = distance if trigger.reference == "start" else length + distance
    return max(along, 0.0) if delay < 0 else along  # a longer time than the move takes: at its start


@dataclass(frozen=True, slots=True)
class _Way:
    """The way of a linear move, or of a circular one about `centre` from the direction `first` towards `second`
    (its radius long), in the move's frame."""

    start: Values
    end: Values
    flags: tuple[tuple[str, int], ...]
    length: float
    centre: FloatArray | None = None
    first: FloatArray | None = None
    second: FloatArray | None = None

    def at(self, along: float) -> ir.Aggregate:
        values = between(self.start, self.end, along / self.length)
        if self.centre is not None and self.first is not None and self.second is not None:
            angle = along / float(np.linalg.norm(self.first))
            place = self.centre + np.cos(angle) * self.first + np.sin(angle) * self.second
            values = (*(float(round(float(one), 9)) + 0.0 for one in place), *values[3:])
        entries: list[tuple[str | None, ir.Expression]] = [
            (name, ir.RealLiteral(value)) for name, value in zip(ir.POSE, values, strict=True)
        ]
        entries.extend((name, ir.IntLiteral(value)) for name, value in self.flags)
        return ir.Aggregate(tuple(entries))

    def piece(self, move: ir.Move, begin: float, end: float) -> ir.Move:
        """The move from one place on the way to another."""
        target = move.target if end == self.length else self.at(end)
        via = None if move.via is None else self.at((begin + end) / 2)
        return replace(move, target=target, via=via, triggers=())


def _way(move: ir.Move, motion: Motion) -> _Way:
    start, end, flags = _ends(move, motion)
    if move.kind == "linear":
        return _Way(start, end, flags, float(np.linalg.norm(np.subtract(end[:3], start[:3]))))
    via = None if move.via is None else motion.positions.constants.known(move.via)
    if via is None or via.kind != "pose":
        raise CannotSayError("the point on the way of the circle is computed", LOST)
    if float(rotation_angle(matrix(inverse(start))[:3, :3] @ matrix(end)[:3, :3])) > _SAME_RAD:
        raise CannotSayError("the tool turns on the circle", LOST)
    return _arc(start, np.asarray(via.values[:3]), end, flags)


def _arc(start: Values, via: FloatArray, end: Values, flags: tuple[tuple[str, int], ...]) -> _Way:
    """The circle through three places."""
    one, other = via - np.asarray(start[:3]), np.asarray(end[:3]) - np.asarray(start[:3])
    normal = np.cross(one, other)
    size = float(normal @ normal)
    if size < 1e-9:
        raise CannotSayError("the points of the circle are on a line", LOST)
    out = (np.cross(normal, one) * float(other @ other) + np.cross(other, normal) * float(one @ one)) / (2 * size)
    first = -out
    second = np.cross(normal / np.sqrt(size), first)
    last = other - out
    angle = float(np.arctan2(last @ second, last @ first)) % (2 * np.pi)
    length = angle * float(np.linalg.norm(first))
    return _Way(start, end, flags, length, np.asarray(start[:3]) + out, first, second)


def _ends(move: ir.Move, motion: Motion) -> tuple[Values, Values, tuple[tuple[str, int], ...]]:
    """Start and end of the move in its frame, and the posture of its end."""
    constants, last = motion.positions.constants, motion.last
    target = constants.known(move.target)
    if target is None or target.kind != "pose":
        raise CannotSayError("the end of the move is computed", LOST)
    if last is None or last.tool != motion.tool(move.tool):
        raise CannotSayError("the start of the move is not known, or its tool is another one", LOST)
    seen = last.seen
    if seen is not None and seen.frame == move.frame and seen.changes == motion.positions.changes:
        return seen.position.values, target.values, target.flags
    frame = Position("pose", WORLD) if move.frame is None else constants.known(move.frame)
    if frame is None or last.position is None:
        raise CannotSayError("the start of the move is not known in its frame", LOST)
    return product(inverse(frame.values), _in_base(last, motion)), target.values, target.flags


def _in_base(goal: Goal, motion: Motion) -> Values:
    job, position = motion.positions.job, goal.position
    assert position is not None  # asked for by the caller
    if position.kind == "pose":
        return product(job.cell.value_of_frame(goal.frame), position.values)
    if job.robot is None:
        raise CannotSayError("the start of the move is in joints, and there is no arm (--robot)", LOST)
    return pose_of_joints(position, job.robot, job.cell.value_of_tool(goal.tool)).values
