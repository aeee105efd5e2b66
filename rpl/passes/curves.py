"""The curve of a spline block: a fifth-degree polynomial from point to point, lines and arcs between them as they are.

Makers do not publish their curve. What is published of KRL's is the degree, that position, first and second derivative
are fixed at each point, that straight and circular segments dictate both to their neighbours, and that moving a point
changes at most the two segments before and the two behind it. M: at a point between two spline segments both
derivatives are those of the parabola through the point and its neighbours, the chords being the parameter. Three
points alone therefore give the parabola through them. Where a controller takes the mean of overlapping parabolas, that
is the cubic with the same directions at the points (Overhauser 1968). Orientation runs through the
points likewise, with a continuous angular speed. Plain Python: passes use it as well as the emulator.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rpl.passes.rigid import Pose, Rotation, Vector, rotation_of_quaternion

Numbers = tuple[float, ...]
# Points nearer than this (mm) are one place.
SAME_MM = 1e-6
# Directions, curvatures and angular speeds that agree that well go on without a corner.
_SAME_WAY, _SAME_BEND, _SAME_TURN = 1e-6, 1e-9, 1e-7
# Three points whose triangle is flatter than this sine fix no circle.
FLAT = 1e-6


@dataclass(frozen=True, slots=True)
class Leg:
    """One segment as a program asks for it: to `end`, on an arc over `via`. `turns`: where the orientation ends: as
    `end` says, kept as it is, or kept as it is to the arc. `follow`: on an arc it turns with the arc. `swept_deg`
    replaces the sweep that ends at `end`."""

    kind: Literal["spline", "line", "arc"]
    end: Pose
    via: Vector | None = None
    swept_deg: float | None = None
    follow: bool = False
    keeps: bool = False


@dataclass(frozen=True, slots=True)
class Circle:
    """An arc about `axis` (unit) through `centre` by `sweep` > 0 rad."""

    centre: Vector
    axis: Vector
    radius: float
    sweep: float

    def place(self, start: Vector, share: float) -> Vector:
        """The point at a share 0..1 of the arc."""
        return self.centre.plus(_turned(start.plus(self.centre, -1.0), self.axis, share * self.sweep))

    def turn(self, share: float) -> Rotation:
        """How far the arc's tangent has turned at a share."""
        return rotation_of_vector(self.axis.times(share * self.sweep))


@dataclass(frozen=True, slots=True)
class Segment:
    """A part of the curve over the parameter 0..`span` (mm). `position`: the three coordinates' coefficients of u, u^2
    .. at u = parameter / span; `rotation`: those of the rotation vector (rad) from the start's orientation. An arc has
    its `circle`, and with `follow` its rotation vector is relative to the arc's tangent."""

    kind: Literal["spline", "line", "arc"]
    start: Pose
    end: Pose
    span: float
    position: tuple[Numbers, Numbers, Numbers]
    rotation: tuple[Numbers, Numbers, Numbers]
    circle: Circle | None = None
    follow: bool = False

    def at(self, u: float) -> Pose:
        """The pose at 0..1 of the parameter."""
        own = rotation_of_vector(Vector(*(polynomial(each, u) for each in self.rotation)))
        if self.circle is None:
            place = Vector(*(polynomial(each, u) for each in self.position))
            return Pose(place, self.start.rotation.then(own))
        place = self.circle.place(self.start.position, u)
        turned = self.start.rotation.then(own)
        return Pose(place, self.circle.turn(u).then(turned) if self.follow else turned)


def polynomial(coefficients: Numbers, u: float) -> float:
    """Horner."""
    value = 0.0
    for coefficient in reversed(coefficients):
        value = value * u + coefficient
    return value


def rotation_of_vector(vector: Vector) -> Rotation:
    """The rotation about a vector by its length in rad."""
    angle = vector.length
    share = 0.5 if angle < 1e-12 else math.sin(0.5 * angle) / angle
    found = rotation_of_quaternion(math.cos(0.5 * angle), *(share * each for each in _xyz(vector)))
    assert found is not None  # it has unit length
    return found


def vector_of_rotation(rotation: Rotation) -> Vector:
    """The shortest rotation vector, rad."""
    w, x, y, z = rotation.quaternion
    sine = math.sqrt(x * x + y * y + z * z)
    share = 2.0 if sine < 1e-12 else 2.0 * math.atan2(sine, w) / sine
    return Vector(x * share, y * share, z * share)


def circle_through(start: Vector, via: Vector, end: Vector, swept_deg: float | None = None) -> Circle | None:
    """The arc from `start` over `via` to `end`; None where the three fix no circle. `swept_deg` replaces its sweep:
    its sign tells the direction (positive: that of the three points), and it may exceed 360."""
    a, b = via.plus(start, -1.0), end.plus(start, -1.0)
    normal = a.cross(b)
    area = normal.length
    if area <= FLAT * a.length * b.length or area < 1e-9 or swept_deg == 0.0:
        return None
    lift = b.times(a.dot(a)).plus(a.times(b.dot(b)), -1.0).cross(normal)
    to_centre = lift.times(1.0 / (2.0 * area * area))
    axis = normal.times(1.0 / area)
    radial, toward = to_centre.times(-1.0), b.plus(to_centre, -1.0)
    sweep = math.atan2(axis.dot(radial.cross(toward)), radial.dot(toward)) % (2.0 * math.pi)
    if swept_deg is not None:
        sweep, axis = abs(math.radians(swept_deg)), axis if swept_deg > 0.0 else axis.times(-1.0)
    return Circle(start.plus(to_centre), axis, to_centre.length, sweep)


# ---- numbers: the same for positions (mm over mm) and joints (deg over time)


def parabola(before: Numbers, here: Numbers, behind: Numbers, h1: float, h2: float) -> tuple[Numbers, Numbers]:
    """First and second derivative at the middle one of three points, which are h1 and h2 apart in the parameter."""
    one = [(b - a) / h1 for a, b in zip(before, here, strict=True)]
    two = [(b - a) / h2 for a, b in zip(here, behind, strict=True)]
    rate = tuple((h2 * a + h1 * b) / (h1 + h2) for a, b in zip(one, two, strict=True))
    return rate, tuple(2.0 * (b - a) / (h1 + h2) for a, b in zip(one, two, strict=True))


def quintic(
    ends: tuple[Numbers, Numbers], rates: tuple[Numbers, Numbers], bends: tuple[Numbers, Numbers], h: float
) -> tuple[Numbers, ...]:
    """Coefficients in u = 0..1 of each coordinate, from position, first and second derivative at both ends."""
    done = []
    for p, q, v, w, a, b in zip(*ends, *rates, *bends, strict=True):
        way, v, w, a, b = q - p, v * h, w * h, a * h * h, b * h * h
        done.append(
            (
                *(p, v, 0.5 * a, 10.0 * way - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b),
                *(-15.0 * way + 8.0 * v + 7.0 * w + 1.5 * a - b, 6.0 * way - 3.0 * (v + w) - 0.5 * (a - b)),
            )
        )
    return tuple(done)


def cubic(ends: tuple[Numbers, Numbers], rates: tuple[Numbers, Numbers], h: float) -> tuple[Numbers, ...]:
    """Coefficients in u = 0..1 of each coordinate, from position and first derivative at both ends."""
    rows = zip(*ends, *rates, strict=True)
    return tuple(
        (p, v * h, 3.0 * (q - p) - (2.0 * v + w) * h, 2.0 * (p - q) + (v + w) * h, 0.0, 0.0) for p, q, v, w in rows
    )


def smooth_numbers(points: Sequence[Numbers], spans: Sequence[float]) -> list[tuple[Numbers, ...]]:
    """The curve through points without fixed segments: coefficients for each of the spans."""
    fixed: list[tuple[Numbers, Numbers] | None] = [None] * len(points)
    found = _derivatives(points, spans, fixed, [True] * len(spans))
    done = []
    for at, span in enumerate(spans):
        (v, a), (w, b) = found[at]
        done.append(quintic((points[at], points[at + 1]), (v, w), (a, b), span))
    return done


Ends = tuple[tuple[Numbers, Numbers], tuple[Numbers, Numbers]]


def _derivatives(
    points: Sequence[Numbers],
    spans: Sequence[float],
    fixed: Sequence[tuple[Numbers, Numbers] | None],
    free: Sequence[bool],
) -> list[Ends]:
    """First and second derivatives at both ends of each span. `fixed`: what a segment dictates at a point; `free`: is
    the span a spline? (What is found for the others is of no use.)"""
    at_point: list[tuple[Numbers, Numbers] | None] = list(fixed)
    for at in range(1, len(points) - 1):
        if at_point[at] is None and free[at - 1] and free[at]:
            at_point[at] = parabola(points[at - 1], points[at], points[at + 1], spans[at - 1], spans[at])
    return [_span_ends(points, spans[at], at_point, at) for at in range(len(spans))]


def _span_ends(points: Sequence[Numbers], h: float, known: Sequence[tuple[Numbers, Numbers] | None], at: int) -> Ends:
    """Where one end of the whole curve is free it is the parabola that arrives at the other end as that dictates."""
    start, end = points[at], points[at + 1]
    chord = tuple((b - a) / h for a, b in zip(start, end, strict=True))
    first, last = known[at], known[at + 1]
    if first is not None and last is not None:
        return first, last
    if first is None and last is None:
        still = tuple(0.0 for _ in chord)
        return (chord, still), (chord, still)
    if last is not None:
        rate = tuple(2.0 * c - w for c, w in zip(chord, last[0], strict=True))
        bend = tuple(2.0 * (w - c) / h for c, w in zip(chord, last[0], strict=True))
        return (rate, bend), last
    assert first is not None  # one of them is known
    rate = tuple(2.0 * c - v for c, v in zip(chord, first[0], strict=True))
    bend = tuple(2.0 * (c - v) / h for c, v in zip(chord, first[0], strict=True))
    return first, (rate, bend)


# ---- blocks


@dataclass(frozen=True, slots=True)
class _Raw:
    """A segment before its curve is known: where it begins and ends; what a line or an arc dictates at its two ends:
    direction, curvature vector and angular speed (in the frame of the tool)."""

    leg: Leg
    start: Pose
    end: Pose
    span: float
    circle: Circle | None
    first: tuple[Vector, Vector, Vector] | None
    last: tuple[Vector, Vector, Vector] | None


def block(start: Pose, legs: Sequence[Leg], mean: bool = False) -> list[list[Segment]] | int:
    """The smooth runs of a block, each a row of segments between two stops; or the number of a leg without a circle.
    `mean`: curves are the mean of the parabolas that overlap.

    The robot stops inside a block where a straight or circular segment meets another one, unless it goes on in the same
    direction, bend and turn, and where two points have the same position (KSS system variables and spline chapters)."""
    raw: list[_Raw] = []
    for number, leg in enumerate(legs):
        made = _raw(start, leg)
        if made is None:
            return number
        raw.append(made)
        start = made.end
    runs: list[list[_Raw]] = []
    for one in raw:
        if runs and _goes_on(runs[-1][-1], one):
            runs[-1].append(one)
        else:
            runs.append([one])
    return [_run(run, mean) for run in runs]


def _raw(start: Pose, leg: Leg) -> _Raw | None:
    place = leg.end.position
    if leg.kind == "arc":
        return _raw_arc(start, leg)
    rotation = start.rotation if leg.keeps else leg.end.rotation
    end = Pose(place, rotation)
    way = place.plus(start.position, -1.0)
    span = way.length
    if leg.kind == "spline" or span < SAME_MM:
        return _Raw(leg, start, end, span, None, None, None)
    turn = vector_of_rotation(start.rotation.inverse.then(rotation)).times(1.0 / span)
    dictated = (way.times(1.0 / span), Vector(0.0, 0.0, 0.0), turn)
    return _Raw(leg, start, end, span, None, dictated, dictated)


def _raw_arc(start: Pose, leg: Leg) -> _Raw | None:
    assert leg.via is not None  # whoever asks for an arc says over which point
    circle = circle_through(start.position, leg.via, leg.end.position, leg.swept_deg)
    if circle is None:
        return None
    place = circle.place(start.position, 1.0)
    around = circle.turn(1.0)
    rotation = leg.end.rotation
    if leg.keeps:
        rotation = around.then(start.rotation) if leg.follow else start.rotation
    end = Pose(place, rotation)
    span = circle.radius * circle.sweep
    goal = around.inverse.then(rotation) if leg.follow else rotation
    own = vector_of_rotation(start.rotation.inverse.then(goal)).times(1.0 / span)
    dictated = []
    for pose in (start, end):
        radial = pose.position.plus(circle.centre, -1.0)
        turn = own
        if leg.follow:  # the arc's own turn, seen from the tool
            turn = turn.plus(pose.rotation.inverse.turn(circle.axis.times(1.0 / circle.radius)))
        tangent = circle.axis.cross(radial).times(1.0 / circle.radius)
        dictated.append((tangent, radial.times(-1.0 / circle.radius**2), turn))
    return _Raw(leg, start, end, span, circle, dictated[0], dictated[1])


def _goes_on(one: _Raw, other: _Raw) -> bool:
    if one.span < SAME_MM or other.span < SAME_MM:
        return False
    if one.last is None or other.first is None:
        return True
    limits = (_SAME_WAY, _SAME_BEND, _SAME_TURN)
    pairs = zip(one.last, other.first, limits, strict=True)
    return all(a.plus(b, -1.0).length < limit for a, b, limit in pairs)


def _run(run: Sequence[_Raw], mean: bool) -> list[Segment]:
    if run[0].span < SAME_MM:  # alone: it turns on the spot, or stays
        return [_on_the_spot(run[0])]
    free = [one.leg.kind == "spline" for one in run]
    points = [_xyz(run[0].start.position), *(_xyz(one.end.position) for one in run)]
    spans = [one.span for one in run]
    met: list[tuple[Vector, Vector, Vector] | None] = [
        (run[at - 1].last if at > 0 else None) or (run[at].first if at < len(run) else None)
        for at in range(len(run) + 1)
    ]
    fixed = [(_xyz(one[0]), _xyz(one[1])) if one is not None else None for one in met]
    ends = _derivatives(points, spans, fixed, free)
    turns = _turn_rates(run, [one[2] if one is not None else None for one in met])
    done = []
    for at, one in enumerate(run):
        (v, a), (w, b) = ends[at]
        bounds = points[at], points[at + 1]
        curve = cubic(bounds, (v, w), one.span) if mean else quintic(bounds, (v, w), (a, b), one.span)
        done.append(_segment(one, curve if free[at] else (), turns[at]))
    return done


def _segment(one: _Raw, curve: tuple[Numbers, ...], turns: tuple[Vector, Vector]) -> Segment:
    start, end = _xyz(one.start.position), _xyz(one.end.position)
    whole = one.end.rotation
    if one.circle is not None and one.leg.follow:
        whole = one.circle.turn(1.0).inverse.then(whole)
    turn = vector_of_rotation(one.start.rotation.inverse.then(whole))
    if one.leg.kind != "spline":
        rotation = _three([(0.0, each) for each in _xyz(turn)])
        line = _three([(a, b - a) for a, b in zip(start, end, strict=True)])
        kind: Literal["line", "arc"] = "line" if one.circle is None else "arc"
        follow = one.circle is not None and one.leg.follow
        return Segment(kind, one.start, one.end, one.span, line, rotation, one.circle, follow)
    first, last = turns[0].times(one.span), _chart_rate(turn, turns[1].times(one.span))
    cubic = [
        (0.0, v, 3.0 * way - 2.0 * v - w, v + w - 2.0 * way)
        for way, v, w in zip(_xyz(turn), _xyz(first), _xyz(last), strict=True)
    ]
    return Segment("spline", one.start, one.end, one.span, _three(curve), _three(cubic))


def _on_the_spot(one: _Raw) -> Segment:
    turn = vector_of_rotation(one.start.rotation.inverse.then(one.end.rotation))
    pairs = zip(_xyz(one.start.position), _xyz(one.end.position), strict=True)
    position = _three([(a, b - a) for a, b in pairs])
    return Segment("line", one.start, one.end, one.span, position, _three([(0.0, each) for each in _xyz(turn)]))


def _turn_rates(run: Sequence[_Raw], fixed: Sequence[Vector | None]) -> list[tuple[Vector, Vector]]:
    """Angular speeds (rad/mm, in the frame of the tool) at both ends of each segment, as for positions."""
    ways = [vector_of_rotation(one.start.rotation.inverse.then(one.end.rotation)) for one in run]
    known: list[Vector | None] = list(fixed)
    for at in range(1, len(run)):
        if known[at] is None:
            back = ways[at - 1].times(-1.0)
            rate, _ = parabola(_xyz(back), (0.0, 0.0, 0.0), _xyz(ways[at]), run[at - 1].span, run[at].span)
            known[at] = Vector(*rate)
    done = []
    for at, one in enumerate(run):
        even = ways[at].times(1.0 / one.span)
        first, last = known[at], known[at + 1]
        if first is None:
            first = even if last is None else even.times(2.0).plus(last, -1.0)
        if last is None:
            last = even.times(2.0).plus(first, -1.0)
        done.append((first, last))
    return done


def _chart_rate(vector: Vector, speed: Vector) -> Vector:
    """The change of a rotation vector whose rotation turns with an angular speed in its own frame (the inverse of the
    right Jacobian; Chirikjian, Stochastic Models, Information Theory and Lie Groups 2, 2012)."""
    angle = vector.length
    square = 1.0 / 12.0 + angle * angle / 720.0
    if angle > 1e-3:
        square = 1.0 / (angle * angle) - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
    once = vector.cross(speed)
    return speed.plus(once, 0.5).plus(vector.cross(once), square)


def _turned(vector: Vector, axis: Vector, angle: float) -> Vector:
    """A vector at right angles to the axis, turned about it."""
    return vector.times(math.cos(angle)).plus(axis.cross(vector), math.sin(angle))


def _xyz(vector: Vector) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z


def _three(rows: Sequence[Numbers]) -> tuple[Numbers, Numbers, Numbers]:
    return rows[0], rows[1], rows[2]


__all__ = ["Circle", "Leg", "Segment", "block", "circle_through", "polynomial", "smooth_numbers"]
