"""Spline blocks as arcs along their curve, for targets without blocks, where the places of all points are constants.

The curve is that of `rpl.passes.curves`, which a run drives too. Each of its spline segments is cut into as many equal
parts as it takes until the arcs through their starts, middles and ends keep to it; straight and circular segments stay
as they are. Arcs that join almost tangentially meet in small corners; where the robot stops in the block, it stops.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import PathRule
from rpl.passes.curves import SAME_MM, Leg, Segment, block, circle_through, rotation_of_vector, vector_of_rotation
from rpl.passes.fold import Unchanged, constant, constant_number, lasting
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.values.taughtvalues import tell_written
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.places.partialplaces import may_move
from rpl.passes.legalise.source.ways.curvepoints import AS_POINTS, SAME_CURVE_MM, apart, through_points
from rpl.passes.rigid import Pose, Rotation, Vector
from rpl.passes.scope import Scope
from rpl.passes.typewords import type_word
from rpl.passes.values import pose_of, real

AS_ARCS = code(
    "spline-as-arcs",
    Severity.WARNING,
    "the target has no such splines: the block is written as {count} moves along the curve that a run takes, which they"
    " leave by at most {deviation:.3f} mm; the controller's own curve is not published",
    "look on the robot that the path goes where it should between the points",
)
SMALLER_CORNER = code(
    "spline-corner-smaller",
    Severity.WARNING,
    "the corner into the block takes at most half of its first arc, {size:.1f} mm",
    "where that corner matters, end the move before the block with a stop",
)
# How far arcs may be from the curve, and their turning from its; a middle that near to the chord makes a line.
CLOSE_MM, CLOSE_DEG, FLAT_MM = 0.005, 0.005, 0.001
# Corners between arcs, at most this share of the shorter one.
CORNER_MM, CORNER_SHARE = 0.3, 0.25
_MOST_PARTS, _LOOKS, _PLACES = 64, 8, 7
_FRAMES = ("tool", "base", "robot_root", "interpolation", "displacement")
_MODES = ("orientation_mode", "circle_orientation")


@dataclass(frozen=True, slots=True)
class _Piece:
    """A move of the result: of which segment, from where to where on the run (mm), over which middle (an arc)."""

    number: int
    begin: float
    end: float
    goal: Pose | None
    middle: Pose | None
    run: int
    stops: bool = False

    @property
    def length(self) -> float:
        return self.end - self.begin


_Curve = tuple[Pose, list[Leg], list[list[Segment]]]


def modes_set(program: ir.Program) -> set[str]:
    """The settings of circles' orientation and the like that a program sets anywhere."""
    assigned = [node.target for node in walk_for({"Assign"}, *program.modules) if isinstance(node, ir.Assign)]
    return {one.name for one in assigned if isinstance(one, ir.System) and one.name in _MODES}


class SplineArcs:
    """Writes the blocks of one routine. `modes`: what the program sets (`modes_set`). `moving`: routines that move the
    robot, folded."""

    def __init__(self, modes: set[str], context: Context, scope: Scope, unchanged: Unchanged, moving: set[str]) -> None:
        self.context, self.scope, self.unchanged, self.moving = context, scope, unchanged, moving
        self.mean = rules_of(context.source).mean_parabolas
        self.modes = modes

    def written(self, spline: ir.Spline, before: Sequence[ir.Statement]) -> ir.Body | None:
        """The moves of a block behind these statements; None where its curve is not known here."""
        moves = [item for item in spline.body if isinstance(item, ir.Move)]
        if spline.kind != "path" or not moves or not all(_is_plain(move, spline) for move in moves):
            return None
        curve = self._curve(spline, moves, before)
        if curve is None:
            return None
        start, legs, runs = curve
        if not self._known_modes([start, *(leg.end for leg in legs)], spline):
            return None
        points = self._points(spline, moves, before, curve)
        if points is not None:
            return points
        found = _pieces(runs)
        if found is None:
            return None
        pieces, deviation = found
        triggers = self._triggers(spline, pieces)
        if triggers is None:
            return None
        if any(piece.goal is not None for piece in pieces):
            rests_on = [_begins(before), *(one for move in moves for one in (move.target, move.via))]
            tell_written(self.context, self.scope, spline.origin, "this curve", *rests_on)
        self.context.diagnostics.report(AS_ARCS, spline.origin, count=len(pieces), deviation=max(deviation, 0.001))
        if _blends(before):
            self.context.diagnostics.report(SMALLER_CORNER, spline.origin, size=0.5 * pieces[0].length)
        return self._body(spline, moves, pieces, triggers)

    def apart(self, spline: ir.Spline, before: Sequence[ir.Statement]) -> float:
        """How far the target's own curve through the points of a block is from the source's, mm, as far as known."""
        moves = [item for item in spline.body if isinstance(item, ir.Move)]
        mean = rules_of(self.context.target).mean_parabolas
        if mean == self.mean or not moves or spline.kind != "path" or not all(_is_plain(one, spline) for one in moves):
            return 0.0
        curve = self._curve(spline, moves, before)
        return self._leaves(curve, mean) if curve is not None else 0.0

    def _leaves(self, curve: _Curve, mean: bool) -> float:
        start, legs, runs = curve
        theirs = block(start, legs, mean)
        assert not isinstance(theirs, int)  # the same legs have the same circles
        return apart(runs, theirs)

    def _points(
        self, spline: ir.Spline, moves: Sequence[ir.Move], before: Sequence[ir.Statement], curve: _Curve
    ) -> ir.Body | None:
        """The block as points of the target's own curve, where that is the same within a tolerance."""
        if PathRule.CURVE_POINTS not in self.context.capabilities.motion.paths or len(curve[2]) != 1 or _blends(before):
            return None
        deviation = self._leaves(curve, rules_of(self.context.target).mean_parabolas)
        last = next((one for one in reversed(before) if isinstance(one, ir.Move | ir.Spline)), None)
        parted = isinstance(last, ir.Spline)
        said = [replace(move, settings=settings_of(move, spline)) for move in moves]
        begins = _begins(before)  # known, so it is the same again; of taught data it stays what it is
        if begins is None or lasting(begins, self.scope) is not None:
            begins = self._place(curve[0])
        done = through_points(spline, begins, said, parted) if deviation <= SAME_CURVE_MM else None
        if done is None:
            return None
        self.context.diagnostics.report(AS_POINTS, spline.origin, count=len(moves) + 1, deviation=max(deviation, 0.001))
        return with_comments(done, spline)

    # ---- what is known

    def _curve(self, spline: ir.Spline, moves: Sequence[ir.Move], before: Sequence[ir.Statement]) -> _Curve | None:
        """Where the block begins, its legs and its runs, where all of that is known."""
        start = self._start(before, moves[0], frames_set(spline.settings))
        legs = [leg for leg in (self._leg(move, spline) for move in moves) if leg is not None]
        if start is None or len(legs) < len(moves):
            return None
        runs = block(start, legs, self.mean)
        return None if isinstance(runs, int) else (start, legs, runs)

    def _start(self, before: Sequence[ir.Statement], first: ir.Move, frames: frozenset[object]) -> Pose | None:
        """Where the robot comes from, seen from the frame of the block."""
        for statement in reversed(before):
            if isinstance(statement, ir.Move):
                sees = (first.tool, first.frame, frames)
                same = sees == (statement.tool, statement.frame, frames_set(statement.settings))
                plain = statement.relative is None and statement.search is None and statement.swept is None
                return self._pose(statement.target) if same and plain else None
            if isinstance(statement, ir.Spline):
                last = [item for item in statement.body if isinstance(item, ir.Move)][-1:]
                same = frames_set(statement.settings) == frames and bool(last)
                return self._start(last, first, frozenset()) if same else None
            if may_move(statement, self.moving):
                return None
        return None

    def _pose(self, place: ir.Expression) -> Pose | None:
        return pose_of(constant(place, self.scope, self.unchanged))

    def _leg(self, move: ir.Move, spline: ir.Spline) -> Leg | None:
        end = self._pose(move.target)
        via = self._pose(move.via) if move.via is not None else None
        if end is None or (move.kind == "circular" and via is None):
            return None
        swept = constant_number(move.swept, self.scope, self.unchanged) if move.swept is not None else None
        if move.swept is not None and swept is None:
            return None
        kinds: dict[str, Literal["line", "arc"]] = {"linear": "line", "circular": "arc"}
        usual = str(rules_of(self.context.source).system_defaults.get("circle_orientation", "base"))
        follow = move.kind == "circular" and (move.circle_orientation or usual) == "path"
        place = via.position if via is not None else None
        return Leg(kinds.get(move.kind, "spline"), end, place, swept, follow, move.orientation == "constant")

    def _known_modes(self, poses: Sequence[Pose], spline: ir.Spline) -> bool:
        """Does the program's own choice of how the tool turns not matter, or not exist?"""
        still = all(_degrees(poses[0].rotation, pose.rotation) < 1e-4 for pose in poses)
        moves = [item for item in spline.body if isinstance(item, ir.Move)]
        circular = any(move.kind == "circular" for move in moves)
        given = [*spline.settings, *(one for move in moves for one in move.settings)]
        changes = self.modes | {place.name for place, _ in given if isinstance(place, ir.System)}
        return ("orientation_mode" not in changes or still) and not (circular and "circle_orientation" in changes)

    # ---- what is written

    def _triggers(self, spline: ir.Spline, pieces: Sequence[_Piece]) -> dict[int, list[ir.Statement]] | None:
        """What stands between the points, by the piece in front of which it goes; None where that is not known."""
        done: dict[int, list[ir.Statement]] = {}
        number = 0
        for item in spline.body:
            if isinstance(item, ir.Move):
                number += 1
                continue
            own = [at for at, piece in enumerate(pieces) if piece.number == number] or [len(pieces)]
            place, moved = own[0], item
            if isinstance(item, ir.Trigger):
                found = self._trigger(item, pieces, own) if place < len(pieces) else None
                if found is None:
                    return None
                place, moved = found
            elif not isinstance(item, ir.Nothing) and not self._switches(item):
                return None
            done.setdefault(place, []).append(moved)
        return done

    def _switches(self, item: ir.Statement) -> bool:
        """Is it an output that gets a constant?"""
        if not isinstance(item, ir.Assign) or not isinstance(item.target, ir.Signal | ir.Name):
            return False
        return constant(item.value, self.scope, self.unchanged) is not None

    def _trigger(
        self, trigger: ir.Trigger, pieces: Sequence[_Piece], own: Sequence[int]
    ) -> tuple[int, ir.Trigger] | None:
        """The piece on which it is due."""
        starts = trigger.reference == "start"
        distance = 0.0
        if trigger.distance is not None:
            known = constant_number(trigger.distance, self.scope, self.unchanged)
            if known is None:
                return None
            distance = known
        place = (pieces[own[0]].begin if starts else pieces[own[-1]].end) + distance
        if distance == 0.0:
            joins = starts and place > 0.0  # the end of the move before is the point itself, in a corner its middle
            ends = replace(trigger, reference="end", distance=None) if joins else trigger
            return own[0] - joins if starts else own[-1], ends
        for at, piece in enumerate(pieces):
            if piece.run == pieces[own[0]].run and piece.begin <= place < piece.end:
                inside = real(round(place - pieces[at].begin, 4))
                return at, replace(trigger, reference="start", distance=inside)
        return None

    def _body(
        self,
        spline: ir.Spline,
        moves: Sequence[ir.Move],
        pieces: Sequence[_Piece],
        triggers: dict[int, list[ir.Statement]],
    ) -> ir.Body:
        done: list[ir.Statement] = []
        written: set[int] = set()
        for at, piece in enumerate(pieces):
            done += triggers.get(at, ())
            move = moves[piece.number]
            if piece.number in written:
                move = replace(move, origin=replace(move.origin, comments=()))
            written.add(piece.number)
            done.append(self._move(move, spline, piece, pieces[at + 1] if at + 1 < len(pieces) else None))
        done += triggers.get(len(pieces), ())
        return with_comments(tuple(done), spline)

    def _move(self, move: ir.Move, spline: ir.Spline, piece: _Piece, next: _Piece | None) -> ir.Move:
        blend: ir.Blend | None = spline.blend
        if next is not None:
            size = round(min(CORNER_MM, CORNER_SHARE * piece.length, CORNER_SHARE * next.length), 3)
            blend = ir.BlendStop() if piece.stops or size <= 0.0 else ir.BlendDistance(real(size))
        kind = "linear" if move.kind == "spline" else move.kind
        if piece.goal is not None:
            kind = "linear" if piece.middle is None else "circular"
            via = self._place(piece.middle) if piece.middle is not None else None
            orientation = None if move.orientation == "constant" else move.orientation
            move = replace(move, target=self._place(piece.goal), via=via, orientation=orientation)
            if piece.middle is not None:
                move = replace(move, circle_orientation=None)
        return replace(move, kind=kind, settings=settings_of(move, spline), blend=blend, motion_class="classic")

    def _place(self, pose: Pose) -> ir.Expression:
        values = (pose.position.x, pose.position.y, pose.position.z, *pose.rotation.zyx)
        entries = tuple((name, real(round(value, _PLACES))) for name, value in zip(ir.POSE, values, strict=True))
        return ir.Aggregate(entries, type_name=type_word(ir.TargetType(self.scope.rules.name)))


def _begins(before: Sequence[ir.Statement]) -> ir.Expression | None:
    """Where the statements in front of a block lead to, as the program says it."""
    for statement in reversed(before):
        if isinstance(statement, ir.Move):
            return statement.target
        if isinstance(statement, ir.Spline):
            return _begins(statement.body)
    return None


def _pieces(runs: Sequence[Sequence[Segment]]) -> tuple[list[_Piece], float] | None:
    """The moves along a block's runs, and how far they are from its curve; None where no number of arcs is enough."""
    done: list[_Piece] = []
    number, worst = 0, 0.0
    for at, run in enumerate(runs):
        way = 0.0
        for segment in run:
            found = _of_segment(segment)
            if found is None:
                return None
            ends, deviation = found
            worst = max(worst, deviation)
            for length, goal, middle in ends:
                done.append(_Piece(number, way, way + length, goal, middle, at))
                way += length
            number += 1
        done[-1] = replace(done[-1], stops=True)
    return done, worst


_End = tuple[float, Pose | None, Pose | None]


def _of_segment(segment: Segment) -> tuple[list[_End], float] | None:
    """Length, goal and middle of each move; a straight or circular segment has its own goal."""
    if segment.kind != "spline":
        return [(segment.span, None, None)], 0.0
    count = 1
    while count <= _MOST_PARTS:
        ends: list[_End] = []
        off = turned = 0.0
        for at in range(count):
            length, middle, apart, turn = _fitted(segment, at / count, (at + 1) / count)
            ends.append((length, segment.at((at + 1) / count), middle))
            off, turned = max(off, apart), max(turned, turn)
        if off <= CLOSE_MM and turned <= CLOSE_DEG:
            return ends, off
        count += max(1, count // 3)
    return None


def _fitted(segment: Segment, first: float, last: float) -> tuple[float, Pose | None, float, float]:
    """Length, middle of the arc (none: a line) over a part of a segment, and how far it is from it: mm, degrees."""
    start, middle, end = (segment.at(u) for u in (first, 0.5 * (first + last), last))
    circle = circle_through(start.position, middle.position, end.position)
    chord = end.position.plus(start.position, -1.0)
    if circle is not None and chord.length**2 / (8.0 * circle.radius) < FLAT_MM:
        circle = None
    length = circle.radius * circle.sweep if circle is not None else chord.length
    turn = start.rotation.inverse.then(end.rotation)
    worst = off = 0.0
    for look in range(1, _LOOKS):
        pose = segment.at(first + (last - first) * look / _LOOKS)
        if circle is not None:
            out = pose.position.plus(circle.centre, -1.0)
            height = out.dot(circle.axis)
            flat = out.plus(circle.axis, -height)
            apart = ((flat.length - circle.radius) ** 2 + height**2) ** 0.5
            share = _angle(start.position.plus(circle.centre, -1.0), flat, circle.axis) / circle.sweep
        else:
            share = pose.position.plus(start.position, -1.0).dot(chord) / max(chord.dot(chord), SAME_MM)
            apart = pose.position.plus(start.position.plus(chord, share), -1.0).length
        even = start.rotation.then(rotation_of_vector(vector_of_rotation(turn).times(share)))
        worst, off = max(worst, apart), max(off, _degrees(even, pose.rotation))
    return length, middle if circle is not None else None, worst, off


def _angle(one: Vector, other: Vector, axis: Vector) -> float:
    """The angle (rad, 0 to a whole turn) from one vector to another about an axis."""
    return math.atan2(axis.dot(one.cross(other)), one.dot(other)) % (2.0 * math.pi)


def _degrees(one: Rotation, other: Rotation) -> float:
    return math.degrees(vector_of_rotation(one.inverse.then(other)).length)


def _is_plain(move: ir.Move, spline: ir.Spline) -> bool:
    own = (move.relative, move.search, move.load, move.speed and move.speed.duration)
    frames = frames_set(move.settings)
    return all(one is None for one in own) and not move.triggers and frames <= frames_set(spline.settings)


def _blends(before: Sequence[ir.Statement]) -> bool:
    """Does the move before go on without a stop?"""
    last = next((one for one in reversed(before) if isinstance(one, ir.Move)), None)
    return last is not None and last.blend is not None and not isinstance(last.blend, ir.BlendStop)


def frames_set(settings: Sequence[tuple[ir.Expression, ir.Expression]]) -> frozenset[object]:
    """The settings of a move that say from where its places are seen."""
    return frozenset(one for one in settings if not isinstance(one[0], ir.System) or one[0].name in _FRAMES)


def settings_of(move: ir.Move, spline: ir.Spline) -> tuple[tuple[ir.Expression, ir.Expression], ...]:
    """A segment's settings with those of its block."""
    own = {_name(place) for place, _ in move.settings}
    return (*(one for one in spline.settings if _name(one[0]) not in own), *move.settings)


def _name(place: ir.Expression) -> tuple[str, object]:
    """What a setting sets."""
    if isinstance(place, ir.Magnitude):
        place = place.value
    return (place.name, place.indices) if isinstance(place, ir.System) else ("", place)


def with_comments(body: ir.Body, spline: ir.Spline) -> ir.Body:
    """The moves of a block with the comments that stand at the block."""
    if not body or not spline.origin.comments:
        return body
    first = body[0].origin
    comments = (*spline.origin.comments, *(one for one in first.comments if one not in spline.origin.comments))
    return (replace(body[0], origin=replace(first, comments=comments)), *body[1:])


__all__ = ["AS_ARCS", "SplineArcs", "settings_of", "with_comments"]
