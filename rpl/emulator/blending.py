"""Corners: two consecutive moves joined without a stop.

The first move is left at the blend distance before its end, the second is met at the same distance after its start, and
a smooth curve runs between. Between two path moves the tool centre point follows a cubic tangent to both, which misses
a right-angled corner by the share of the distance that the controller is known for (a parabola: 0.354); where a path is
an arc the curve is the cubic with the same tangents. Orientation turns along the analogous curve. Where a joint move
takes part, the corner is the parabola in joint space. The corner's speed is what path acceleration, axis speeds, axis
accelerations and the two moves allow; speed is continuous along the whole chain.

Controllers that let two moves overlap in time (the next one speeds up while the last one slows down) draw the same
curves: the sum of two even ramps is a parabola whose size grows with the speed.
"""

from dataclasses import dataclass, replace

import numpy as np

from rpl.emulator.cornerpaths import (
    BezierPath,
    CornerPath,
    handle_of,
    is_even,
    path_corner,
    wide_corner,
)
from rpl.emulator.mechanisms import Carried
from rpl.emulator.model import RobotModel
from rpl.emulator.paths import Path
from rpl.emulator.planner import Geometry, JointGeometry, PathGeometry, PlannedMove, flanges_of
from rpl.emulator.rotations import FloatArray
from rpl.emulator.rounding import NO_WAY
from rpl.emulator.timelaw import Profile, TimeLaw
from rpl.emulator.tracking import MotionFault, track_flanges

# No corner takes more than this share of a move, so that the corners at its two ends never meet.
MOST = 0.5
SAMPLES = 33
# A shorter way of the tool (mm) is none: such a move turns it, or moves axes that it hides.
SHORTEST_MM = 1e-3
# A corner that would take longer than the inverse of this (1/s) is none: it turns on the spot into a way.
SLOWEST = 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class Corner:
    """Three moves instead of two, one after the other; `t_middle_s` is the middle of the corner, from its start."""

    first: PlannedMove
    corner: PlannedMove
    second: PlannedMove
    t_middle_s: float


@dataclass(frozen=True, slots=True)
class NoBlend:
    """The two moves are driven with a stop between them, and why."""

    reason: str


@dataclass(frozen=True, slots=True)
class Size:
    """How large a corner is asked for, in one of these ways.

    `distance_mm` is measured along the tool's way and is reduced to half of the shorter move; over `extended_mm`,
    reduced alike, tool and external axes go over to the second move. `fraction` (0..0.5) is a share of each move, or
    one of each, as for joint moves. `overlap` (0..1) is the share of the shorter of the two ramps in which both moves
    go on at once.
    """

    distance_mm: float | None = None
    extended_mm: float | None = None
    fraction: float | tuple[float, float] | None = None
    overlap: float | None = None


@dataclass(frozen=True, slots=True)
class Ends:
    """Where a corner leaves the first move and meets the second, as fractions of their whole geometry; `out`, `into`:
    the same of its curve, which is shorter where the tool begins to turn before its centre point leaves the path."""

    leave: float
    meet: float
    out: float
    into: float


def blend(
    model: RobotModel,
    first: PlannedMove,
    second: PlannedMove,
    size: Size,
    alone: tuple[bool, bool] = (False, False),
) -> Corner | NoBlend:
    """Join two moves, of which the second starts where the first ends, by a corner of the given size.

    `alone`: the robot stands at the other end of the first, of the second move. `first` may itself be the rest of a
    move that began with a corner.
    """
    gap = np.abs(first.end_joints - second.start_joints)
    if gap.max() > 1e-4:
        return NoBlend("the second move does not start where the first ends")
    if not (np.isfinite(first.profile.speed) and np.isfinite(second.profile.speed)):
        return NoBlend("a move without way has no corner")
    seconds = overlapping_s(first, second, size.overlap) if size.overlap is not None else None
    ends = _ends(first, second, size, seconds, alone)
    if isinstance(ends, NoBlend):
        return ends
    if ends.leave < first.span[0]:
        return NoBlend("the corner before takes up the first move")
    if size.extended_mm is not None and size.distance_mm is not None:
        ends = _extended(first, second, ends, size.extended_mm, alone)
    # Both moves up to and from the corner; their laws follow when its speed is known.
    trimmed = first.part((first.span[0], ends.leave), first.law)
    rest = second.part((ends.meet, 1.0), second.law)
    geometry = _corner_geometry(model, first, second, ends, (trimmed.end_joints, rest.start_joints), seconds is None)
    if isinstance(geometry, NoBlend):
        return geometry
    return _driven(model, (first, second), geometry, ends, (trimmed, rest), seconds)


def overlapping_s(first: PlannedMove, second: PlannedMove, share: float) -> float:
    """How long two moves go on at once: a share of the shorter ramp, and not beyond the middle of a move."""
    moves = first, second
    if not all(np.isfinite(move.profile.speed) for move in moves):
        return 0.0
    accelerations = _beside_corner(first, second)
    ramps = [move.profile.peak / each for move, each in zip(moves, accelerations, strict=True)]
    rooms = [float(np.sqrt(2.0 * MOST / each)) for each in accelerations]
    return min(share * min(ramps), *rooms)


def _beside_corner(first: PlannedMove, second: PlannedMove) -> tuple[float, float]:
    """The accelerations (1/s²) with which the first move slows down into a corner and the second leaves it."""
    return corner_acceleration(first, first.profile.down), corner_acceleration(second, second.profile.acceleration)


def corner_acceleration(move: PlannedMove, acceleration: float) -> float:
    """The acceleration (1/s²) of a move's ramp beside a corner that is made by overlapping moves, where that beside a
    stop is `acceleration`."""
    controller = move.controller
    if move.kind == "joint":
        return acceleration
    if controller.corner_ramp_s > 0.0:
        acceleration *= (controller.path_ramp_s or move.profile.peak / acceleration) / controller.corner_ramp_s
    whole = whole_mm(move)
    if controller.corner_acceleration_mm_s2 is not None and whole > SHORTEST_MM:
        acceleration = min(acceleration, controller.corner_acceleration_mm_s2 / whole)
    return acceleration


def open_end(move: PlannedMove, share: float) -> tuple[float, float, Profile]:
    """Where a move leaves for a corner by overlap with a move like itself, as a fraction; its speed there, 1/s; the
    profile that slows down to it."""
    braking = corner_acceleration(move, move.profile.down)
    seconds = overlapping_s(move, move, share)
    return 1.0 - min(MOST, 0.5 * braking * seconds**2), braking * seconds, replace(move.profile, braking=braking)


def _ends(
    first: PlannedMove, second: PlannedMove, size: Size, seconds: float | None, alone: tuple[bool, bool]
) -> Ends | NoBlend:
    """Where to leave the first move and to meet the second."""
    if seconds is not None:
        shares = [0.5 * each * seconds * seconds for each in _beside_corner(first, second)]
        if min(shares) <= 1e-9:
            return NoBlend("the moves do not overlap")
        return _plain(1.0 - min(shares[0], MOST), min(shares[1], MOST))
    if size.fraction is not None:
        both = size.fraction if isinstance(size.fraction, tuple) else (size.fraction, size.fraction)
        out, into = (min(each, MOST) for each in both)
        return _plain(1.0 - out, into) if min(out, into) > 0.0 else NoBlend("the blend distance is zero")
    whole = [whole_mm(move) for move in (first, second)]
    distance = _reduced(first, second, size.distance_mm or 0.0, alone)
    if distance < NO_WAY:
        return NoBlend("the blend distance is zero" if not size.distance_mm else "a move without way has no corner")
    return _plain(first.geometry.fraction_at(whole[0] - distance), second.geometry.fraction_at(distance))


def _plain(leave: float, meet: float) -> Ends:
    return Ends(leave, meet, leave, meet)


def _reduced(first: PlannedMove, second: PlannedMove, wanted: float, alone: tuple[bool, bool]) -> float:
    """A blend distance (mm) as the two moves have room for it."""
    free = first.controller.corner_whole
    wholes = zip((whole_mm(first), whole_mm(second)), alone, strict=True)
    return min(wanted, *(each if free and each > wanted and at_rest else MOST * each for each, at_rest in wholes))


def _extended(
    first: PlannedMove, second: PlannedMove, ends: Ends, extended_mm: float, alone: tuple[bool, bool]
) -> Ends:
    """The same corner, beginning and ending with its extended zone, as far as the first move still has room for it."""
    a, b = first.geometry, second.geometry
    if not (isinstance(a, PathGeometry) and isinstance(b, PathGeometry) and _one_work(a, b)):
        return ends
    whole, left = whole_mm(first), first.geometry.distance(np.array([first.span[0]]))[0]
    distance = min(_reduced(first, second, extended_mm, alone), whole - float(left))
    if distance <= whole * (1.0 - ends.out) + SHORTEST_MM:
        return ends
    leave = max(first.geometry.fraction_at(whole - distance), first.span[0])
    return replace(ends, leave=leave, meet=second.geometry.fraction_at(distance))


def whole_mm(move: PlannedMove) -> float:
    """The tool's way along the whole geometry of a move."""
    return float(move.geometry.distance(np.array([1.0]))[0])


def _corner_geometry(
    model: RobotModel,
    first: PlannedMove,
    second: PlannedMove,
    ends: Ends,
    joints: tuple[FloatArray, FloatArray],
    sized: bool,
) -> Geometry | NoBlend:
    (before, after), a, b = joints, first.geometry, second.geometry
    if not (isinstance(a, PathGeometry) and isinstance(b, PathGeometry) and _one_work(a, b)):
        carried = _carried_corner(first, second, ends, None)
        return _joint_corner(model, before, first.end_joints, after, b.tool, carried)
    share = _tangent_share(first, second, ends.out) if sized else 2.0 / 3.0
    plain = path_corner(a.path, b.path, ends.out, ends.into, share)
    if plain.length_mm < 1e-9 and not (a.path.length_mm < SHORTEST_MM and b.path.length_mm < SHORTEST_MM):
        return NoBlend("the path turns back on itself")
    curve: CornerPath = plain.evenly() if sized and first.controller.corner_even > 0.0 else plain
    if ends.leave < ends.out:
        curve = wide_corner(a.path, b.path, (ends.leave, ends.meet), (ends.out, ends.into), share)
    carried = _carried_corner(first, second, ends, curve)
    track = track_flanges(model, lambda u: flanges_of(curve, b.tool, carried, u), before, SAMPLES)
    if isinstance(track, MotionFault):
        return NoBlend(f"no corner: {track.message}")
    if np.abs(track.joints[-1] - after).max() > 1e-3:
        return NoBlend("no corner: the arm would change its configuration")
    return PathGeometry(model, curve, b.tool, track, carried)


def _one_work(a: PathGeometry, b: PathGeometry) -> bool:
    """Are both paths in one work, so that their corner is a curve in it? (Paths in the robot's base always are.)"""
    if a.carried is None or b.carried is None:
        return a.carried is b.carried
    return a.carried.carrier.same_work(b.carried.carrier)


def _carried_corner(first: PlannedMove, second: PlannedMove, ends: Ends, curve: CornerPath | None) -> Carried | None:
    """The carrier of the second move while external axes round the corner between both moves."""
    geometry = second.geometry
    carried = geometry.carried if isinstance(geometry, PathGeometry | JointGeometry) else None
    middle = _external_middle(first, second, ends, curve)
    if carried is None or middle is None:
        return None
    return Carried(carried.carrier, np.vstack([_external(first, ends.leave), middle, _external(second, ends.meet)]))


def _external_middle(first: PlannedMove, second: PlannedMove, ends: Ends, curve: Path | None) -> FloatArray | None:
    """The inner control points (m, e) of the external axes' curve: the corner point, or two where the corner's fraction
    is the way along it; None where the two moves have not the same axes."""
    if len(first.external_end) != len(second.external_start):
        return None
    corner = first.external_end
    if curve is None or not is_even(curve):
        return corner[None]
    begin, end = _external(first, ends.leave), _external(second, ends.meet)
    out = handle_of(curve.length_mm, whole_mm(first) * (1.0 - ends.leave))
    into = handle_of(curve.length_mm, whole_mm(second) * ends.meet)
    return np.stack([begin + out * (corner - begin), end + into * (corner - end)])


def _tangent_share(first: PlannedMove, second: PlannedMove, leave: float) -> float:
    """Where the inner control points lie: by the controller's cut and the speed of the corner."""
    wholes = [whole_mm(move) for move in (first, second)]
    tops = [move.profile.speed * whole for move, whole in zip((first, second), wholes, strict=True)]
    speed = min(top for top in (*tops, np.inf) if top > 0.0)
    speed = speed if np.isfinite(speed) else 0.0
    return first.controller.tangent_share((1.0 - leave) * wholes[0], speed, _turned(first.geometry, second.geometry))


def _turned(first: Geometry, second: Geometry) -> float:
    """The difference of the directions in which two paths meet at their corner point: 0 straight on, 2 back again."""
    if not (isinstance(first, PathGeometry) and isinstance(second, PathGeometry)):
        return 0.0
    ways = first.path.tangent(1.0), second.path.tangent(0.0)
    lengths = [float(np.linalg.norm(way)) for way in ways]
    if min(lengths) <= 1e-9:
        return 0.0
    return float(np.linalg.norm(ways[1] / lengths[1] - ways[0] / lengths[0]))


@dataclass(frozen=True, slots=True, eq=False)
class JointCorner:
    """The parabola in joint space with control points (3, n); the tool's way measured at `knots`."""

    model: RobotModel
    control: FloatArray
    tool: FloatArray
    knots: FloatArray
    travelled: FloatArray
    carried: Carried | None = None

    def joints(self, fraction: FloatArray) -> FloatArray:
        s, w = fraction[..., None], 1.0 - fraction[..., None]
        return np.asarray(w * w * self.control[0] + 2.0 * w * s * self.control[1] + s * s * self.control[2])

    def tcp(self, fraction: FloatArray) -> FloatArray:
        flanges = self.model.forward(self.joints(fraction))
        return np.asarray(flanges @ self.tool if self.carried is None else self.carried.in_work(flanges, fraction))

    def distance(self, fraction: FloatArray) -> FloatArray:
        return np.interp(fraction, self.knots, self.travelled)

    def fraction_at(self, distance_mm: float) -> float:
        return float(np.interp(distance_mm, self.travelled, self.knots)) if self.travelled[-1] > 0.0 else 0.0


def _joint_corner(
    model: RobotModel,
    before: FloatArray,
    corner: FloatArray,
    after: FloatArray,
    tool: FloatArray,
    carried: Carried | None,
) -> JointCorner | NoBlend:
    empty = JointCorner(model, np.stack([before, corner, after]), tool, np.zeros(2), np.zeros(2), carried)
    knots = np.linspace(0.0, 1.0, SAMPLES)
    for joints in empty.joints(knots):
        outside = model.within_limits(joints)
        if outside:
            return NoBlend(f"no corner: joint {outside[0] + 1} would leave its limits")
    points = empty.tcp(knots)[:, :3, 3]
    travelled = np.insert(np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)), 0, 0.0)
    return replace(empty, knots=knots, travelled=travelled)


def _driven(
    model: RobotModel,
    moves: tuple[PlannedMove, PlannedMove],
    geometry: Geometry,
    corner_ends: Ends,
    parts: tuple[PlannedMove, PlannedMove],
    seconds: float | None,
) -> Corner | NoBlend:
    """Time the three parts: one speed through the corner where the moves have room to reach it, else accelerating.

    Speeds are of fractions: a parabola at rate w leaves the first move at 2 (1 - leave) w and meets the second at
    2 meet w, since the corner's tangents are the rest and the beginning of the two moves; a cubic in proportion.
    """
    (first, second), ((begin, leave), (meet, _)) = moves, (part.span for part in parts)
    tail, head = _steepness(geometry, first, second, leave, meet)
    if seconds is not None:
        braking, rising = _beside_corner(first, second)
        first = replace(first, profile=replace(first.profile, braking=braking))
        second = replace(second, profile=replace(second.profile, rising=rising))
    arriving = float(first.law.speeds[0]) * (first.span[1] - first.span[0])
    room = 2.0 * first.profile.acceleration * (leave - begin)
    slowing = 2.0 * first.profile.down * (leave - begin)
    stopping = float(np.sqrt(2.0 * second.profile.down * (1.0 - meet)))
    rate = min(
        _ceiling(first.profile, leave) / tail,
        float(np.sqrt(arriving * arriving + room)) / tail,
        _ceiling(second.profile, meet) / head,
        stopping / head,
        _corner_rate(model, first, second, geometry, corner_ends, seconds),
    )
    if rate < SLOWEST:
        return NoBlend("the corner allows no speed")
    entry = max(rate, float(np.sqrt(max(arriving * arriving - slowing, 0.0))) / tail)
    law = TimeLaw(np.array([0.0, 2.0 / (entry + rate)]), np.array([0.0, 1.0]), np.array([entry, rate]))
    trimmed = _timed(parts[0], first.profile, arriving, tail * entry)
    rest = _timed(parts[1], second.profile, head * rate, 0.0)
    ends = np.array([0.0, 1.0])
    joints, poses = geometry.joints(ends), geometry.tcp(ends)
    corner = PlannedMove(
        kind="corner",
        controller=first.controller,
        start_joints=joints[0],
        end_joints=joints[1],
        start_pose=poses[0],
        end_pose=poses[1],
        duration_s=law.duration,
        length_mm=float(geometry.distance(ends)[1]),
        slowed=first.slowed or second.slowed,
        geometry=geometry,
        profile=Profile(max(entry, rate), np.inf),
        law=law,
        span=(0.0, 1.0),
        external_start=_external(first, leave),
        external_end=_external(second, meet),
        external_middle=_external_middle(
            first, second, corner_ends, geometry.path if isinstance(geometry, PathGeometry) else None
        ),
    )
    return Corner(trimmed, corner, rest, float(law.time_of(0.5)))


def _timed(part: PlannedMove, profile: Profile, start_speed: float, end_speed: float) -> PlannedMove:
    """A part of a move with the law between two speeds, 1/s of the whole move."""
    return replace(part, profile=profile).part(part.span, profile.law(*part.span, start_speed, end_speed))


def _steepness(
    geometry: Geometry, first: PlannedMove, second: PlannedMove, leave: float, meet: float
) -> tuple[float, float]:
    """The fractions of the two moves per fraction of the corner, where they meet it."""
    if not isinstance(geometry, PathGeometry):
        return 2.0 * (1.0 - leave), 2.0 * meet
    if is_even(geometry.path):
        length = float(np.linalg.norm(geometry.path.tangent(0.0)))
        return length / whole_mm(first), length / whole_mm(second)
    share = geometry.path.share if isinstance(geometry.path, BezierPath) else 2.0 / 3.0
    return 3.0 * share * (1.0 - leave), 3.0 * share * meet


def _ceiling(profile: Profile, fraction: float) -> float:
    """Top speed of a move at one place, 1/s."""
    if profile.knots is None or profile.ceilings is None:
        return profile.speed
    holder = int(np.clip(np.searchsorted(profile.knots, fraction, side="right") - 1, 0, len(profile.ceilings) - 1))
    return min(profile.speed, float(profile.ceilings[holder]))


def _corner_rate(
    model: RobotModel,
    first: PlannedMove,
    second: PlannedMove,
    geometry: Geometry,
    ends: Ends,
    seconds: float | None,
) -> float:
    """The fastest even rate (1/s) through the corner that keeps path acceleration and the axes within their limits;
    where two moves overlap, their ramps decide in place of the path acceleration."""
    knots = np.linspace(0.0, 1.0, SAMPLES)
    step = knots[1]
    # A track from these knots on has the joints there already.
    joints = geometry.track.at(knots) if isinstance(geometry, PathGeometry) else geometry.joints(knots)
    fastest = np.abs(np.diff(joints, axis=0)).max(axis=0) / step
    rate = float(np.min(model.speeds / np.maximum(fastest, 1e-9)))
    if seconds is not None:
        return min(rate, 1.0 / seconds)
    moves = (first, second)
    if not isinstance(geometry, PathGeometry):
        strongest = np.abs(np.diff(joints, n=2, axis=0)).max(axis=0) / step**2
        available = model.accelerations * min(_acceleration_share(model, move) for move in moves)
        return min(rate, float(np.sqrt(np.min(available / np.maximum(strongest, 1e-9)))))
    wholes = [whole_mm(move) for move in moves]
    if max(wholes) < SHORTEST_MM:  # the parabola of what turns: each move goes over with twice its share
        shares = (1.0 - ends.out, ends.into)
        strongest = [2.0 * each / move.profile.acceleration for each, move in zip(shares, moves, strict=True)]
        return min(rate, float(1.0 / np.sqrt(max(strongest))))
    points = geometry.tcp(knots)[:, :3, 3]
    bend = float(np.linalg.norm(np.diff(points, n=2, axis=0), axis=1).max()) / step**2
    limit = min(moves[0].profile.down * wholes[0], moves[1].profile.acceleration * wholes[1])
    controller = first.controller
    if controller.corner_acceleration_mm_s2 is None:
        return min(rate, float(np.sqrt(limit / max(bend, 1e-9))))
    share = min(1.0, limit / (controller.path_acceleration_mm_s2 or limit))
    size = whole_mm(first) * (1.0 - ends.out)
    speed = controller.corner_speed(size, _turned(first.geometry, second.geometry), share)
    even = (
        isinstance(geometry, PathGeometry) and isinstance(geometry.path, BezierPath) and geometry.path.ways is not None
    )
    way = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) if even else 2.0 * size
    return min(rate, speed / max(way, 1e-9))


def _acceleration_share(model: RobotModel, move: PlannedMove) -> float:
    """The share of the axes' accelerations that a joint move uses; 1 for a path move."""
    if not isinstance(move.geometry, JointGeometry):
        return 1.0
    way = np.abs(move.geometry.end - move.geometry.start)
    return min(1.0, float(np.max(way / model.accelerations)) * move.profile.acceleration)


def _external(move: PlannedMove, fraction: float) -> FloatArray:
    return move.external_along(np.asarray(fraction))
