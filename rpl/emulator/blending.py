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

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.mechanisms import Carried
from rpl.emulator.model import RobotModel
from rpl.emulator.paths import Path
from rpl.emulator.planner import Geometry, JointGeometry, PathGeometry, PlannedMove, flanges_of
from rpl.emulator.rotations import (
    FloatArray,
    matrix_to_rotation_vector,
    pose_matrix,
    rotation_vector_to_matrix,
    turned,
)
from rpl.emulator.timelaw import Profile, TimeLaw
from rpl.emulator.tracking import MotionFault, track_flanges

# No corner takes more than this share of a move, so that the corners at its two ends never meet.
MOST = 0.5
SAMPLES = 33
# In how many places the way along a corner is measured.
WAYS = 32
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


def blend(
    model: RobotModel,
    first: PlannedMove,
    second: PlannedMove,
    *,
    distance_mm: float | None = None,
    fraction: float | None = None,
    overlap: float | None = None,
    alone: tuple[bool, bool] = (False, False),
) -> Corner | NoBlend:
    """Join two moves, of which the second starts where the first ends, by a corner of the given size.

    `distance_mm` is measured along the tool's way and is reduced to half of the shorter move; `fraction` (0..0.5) is a
    share of each move, as for joint moves; `overlap` (0..1) is the share of the shorter of the two ramps in which both
    moves go on at once. `alone`: the robot stands at the other end of the first, of the second move.
    `first` may itself be the rest of a move that began with a corner.
    """
    gap = np.abs(first.end_joints - second.start_joints)
    if gap.max() > 1e-4:
        return NoBlend("the second move does not start where the first ends")
    seconds = overlapping_s(first, second, overlap) if overlap is not None else None
    ends = _ends(first, second, distance_mm, fraction, seconds, alone)
    if isinstance(ends, NoBlend):
        return ends
    leave, meet = ends
    if leave < first.span[0]:
        return NoBlend("the corner before takes up the first move")
    # Both moves up to and from the corner; their laws follow when its speed is known.
    trimmed, rest = first.part((first.span[0], leave), first.law), second.part((meet, 1.0), second.law)
    geometry = _corner_geometry(model, first, second, trimmed, rest, seconds is None)
    if isinstance(geometry, NoBlend):
        return geometry
    return _driven(model, first, second, geometry, (trimmed, rest), seconds)


def overlapping_s(first: PlannedMove, second: PlannedMove, share: float) -> float:
    """How long two moves go on at once: a share of the shorter ramp, and not beyond the middle of a move."""
    moves = first, second
    if not all(np.isfinite(move.profile.speed) for move in moves):
        return 0.0
    ramps = [move.profile.peak / corner_acceleration(move) for move in moves]
    rooms = [float(np.sqrt(2.0 * MOST / corner_acceleration(move))) for move in moves]
    return min(share * min(ramps), *rooms)


def corner_acceleration(move: PlannedMove) -> float:
    """The acceleration (1/s²) of a move's ramp beside a corner that is made by overlapping moves."""
    controller, acceleration = move.controller, move.profile.acceleration
    if move.kind == "joint":
        return acceleration
    if controller.corner_ramp_s > 0.0:
        acceleration *= (controller.path_ramp_s or move.profile.peak / acceleration) / controller.corner_ramp_s
    whole = float(move.geometry.distance(np.array([1.0]))[0])
    if controller.corner_acceleration_mm_s2 is not None and whole > SHORTEST_MM:
        acceleration = min(acceleration, controller.corner_acceleration_mm_s2 / whole)
    return acceleration


def open_end(move: PlannedMove, share: float) -> tuple[float, float, Profile]:
    """Where a move leaves for a corner by overlap with a move like itself, as a fraction; its speed there, 1/s; the
    profile that slows down to it."""
    braking = corner_acceleration(move)
    seconds = overlapping_s(move, move, share)
    return 1.0 - min(MOST, 0.5 * braking * seconds**2), braking * seconds, replace(move.profile, braking=braking)


def _ends(
    first: PlannedMove,
    second: PlannedMove,
    distance_mm: float | None,
    fraction: float | None,
    seconds: float | None,
    alone: tuple[bool, bool],
) -> tuple[float, float] | NoBlend:
    """Where to leave the first move and to meet the second, as fractions of their whole geometry."""
    if seconds is not None:
        shares = [0.5 * corner_acceleration(move) * seconds * seconds for move in (first, second)]
        if min(shares) <= 1e-9 or not np.isfinite(shares).all():
            return NoBlend("the moves do not overlap")
        return 1.0 - min(shares[0], MOST), min(shares[1], MOST)
    if fraction is not None:
        share = min(fraction, MOST)
        return (1.0 - share, share) if share > 0.0 else NoBlend("the blend distance is zero")
    whole = [float(move.geometry.distance(np.array([1.0]))[0]) for move in (first, second)]
    wanted, free = distance_mm or 0.0, first.controller.corner_whole
    rooms = [
        each if free and each > wanted and at_rest else MOST * each for each, at_rest in zip(whole, alone, strict=True)
    ]
    distance = min(wanted, *rooms)
    if distance < 1e-6:
        return NoBlend("the blend distance is zero" if not distance_mm else "a move without way has no corner")
    return first.geometry.fraction_at(whole[0] - distance), second.geometry.fraction_at(distance)


def _corner_geometry(
    model: RobotModel, first: PlannedMove, second: PlannedMove, trimmed: PlannedMove, rest: PlannedMove, sized: bool
) -> Geometry | NoBlend:
    before, leave = trimmed.end_joints, trimmed.span[1]
    after, meet = rest.start_joints, rest.span[0]
    a, b = first.geometry, second.geometry
    carried = _carried_corner(first, second, leave, meet)
    if not (isinstance(a, PathGeometry) and isinstance(b, PathGeometry) and _one_work(a, b)):
        return _joint_corner(model, before, first.end_joints, after, b.tool, carried)
    share = _tangent_share(first, second, leave) if sized else 2.0 / 3.0
    curve = _path_corner(a.path, b.path, leave, meet, share)
    if sized and first.controller.corner_even > 0.0:
        curve = curve.evenly()
    if curve.length_mm < 1e-9:
        return NoBlend("the path turns back on itself")
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


def _carried_corner(first: PlannedMove, second: PlannedMove, leave: float, meet: float) -> Carried | None:
    """The carrier of the second move while external axes round the corner between both moves."""
    geometry = second.geometry
    carried = geometry.carried if isinstance(geometry, PathGeometry | JointGeometry) else None
    middle = _external_middle(first, second)
    if carried is None or middle is None:
        return None
    return Carried(carried.carrier, np.stack([_external(first, leave), middle, _external(second, meet)]))


def _external_middle(first: PlannedMove, second: PlannedMove) -> FloatArray | None:
    """External axes at the corner point; None where the two moves have not the same ones."""
    return first.external_end if len(first.external_end) == len(second.external_start) else None


@dataclass(frozen=True, slots=True, eq=False)
class BezierPath:
    """Poses on a cubic through four control positions (4, 3), orientation on the curve of three rotations (3, 3, 3).

    `share`: of the way to the corner point, where the inner control positions lie. `ways` (k,): of the whole length at
    k even places of the curve, where its fraction is the way along it; None: it is the curve's own parameter.
    """

    positions: FloatArray
    rotations: FloatArray
    share: float = 2.0 / 3.0
    ways: FloatArray | None = None
    turns: FloatArray = field(init=False)  # rotation vectors (2, 3) between the three rotations, radians

    def __post_init__(self) -> None:
        between = np.swapaxes(self.rotations[:-1], 1, 2) @ self.rotations[1:]
        object.__setattr__(self, "turns", matrix_to_rotation_vector(between))

    def evenly(self) -> "BezierPath":
        """The same curve, its fraction in proportion to the way of the tool centre point."""
        speeds = np.linalg.norm(self._velocity(np.linspace(0.0, 1.0, 2 * WAYS + 1)), axis=1)
        steps = (speeds[:-2:2] + 4.0 * speeds[1::2] + speeds[2::2]) / (6.0 * WAYS)
        ways = np.insert(np.cumsum(steps), 0, 0.0)
        return replace(self, ways=ways / ways[-1]) if speeds.min() > 1e-9 else self

    def _parameter(self, fraction: FloatArray) -> FloatArray:
        """The curve's own parameter: a cubic between the measured places, with the slopes of the curve."""
        if self.ways is None:
            return fraction
        i = np.clip(np.searchsorted(self.ways, fraction, side="right") - 1, 0, WAYS - 1)
        span = self.ways[i + 1] - self.ways[i]
        t = np.clip((fraction - self.ways[i]) / span, 0.0, 1.0)
        ends = np.stack([i, i + 1]) / WAYS
        slopes = span * self._length() / np.linalg.norm(self._velocity(ends), axis=-1)
        bends = t * (1.0 - t) * ((1.0 - t) * (slopes[0] - 1.0 / WAYS) - t * (slopes[1] - 1.0 / WAYS))
        return np.asarray((i + t) / WAYS + bends)

    def _length(self) -> float:
        speeds = np.linalg.norm(self._velocity(np.linspace(0.0, 1.0, 2 * WAYS + 1)), axis=1)
        return float((speeds[:-2:2] + 4.0 * speeds[1::2] + speeds[2::2]).sum() / (6.0 * WAYS))

    @property
    def length_mm(self) -> float:
        points = self._points(np.linspace(0.0, 1.0, 65))
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    @property
    def turn_rad(self) -> float:
        steps = self._turns(np.linspace(0.0, 1.0, 9))
        between = np.swapaxes(steps[:-1], 1, 2) @ steps[1:]
        return float(np.linalg.norm(matrix_to_rotation_vector(between), axis=1).sum())

    def _points(self, u: FloatArray) -> FloatArray:
        s, w = u[..., None], 1.0 - u[..., None]
        p = self.positions
        return np.asarray(w**3 * p[0] + 3 * w * w * s * p[1] + 3 * w * s * s * p[2] + s**3 * p[3])

    def _turns(self, u: FloatArray) -> FloatArray:
        """De Casteljau on rotations: tangent to the first turn at 0 and to the second at 1."""
        if not self.turns.any():
            return np.broadcast_to(self.rotations[0], (*np.shape(u), 3, 3))
        share = u[..., None]
        one = turned(self.rotations[0], self.turns[0], u)
        two = turned(self.rotations[1], self.turns[1], u)
        between = matrix_to_rotation_vector(np.swapaxes(one, -1, -2) @ two)
        return np.asarray(one @ rotation_vector_to_matrix(share * between))

    def poses(self, fraction: ArrayLike) -> FloatArray:
        u = self._parameter(np.asarray(fraction, dtype=np.float64))
        return pose_matrix(self._points(u), self._turns(u))

    def tangent(self, fraction: float) -> FloatArray:
        way = self._velocity(self._parameter(np.array([fraction])))[0]
        return way if self.ways is None else np.asarray(way * self._length() / np.linalg.norm(way))

    def _velocity(self, u: FloatArray) -> FloatArray:
        p, s, w = self.positions, u[..., None], 1.0 - u[..., None]
        return np.asarray(3 * (w * w * (p[1] - p[0]) + 2 * w * s * (p[2] - p[1]) + s * s * (p[3] - p[2])))


def _tangent_share(first: PlannedMove, second: PlannedMove, leave: float) -> float:
    """Where the inner control points lie: by the controller's cut and the speed of the corner."""
    wholes = [float(move.geometry.distance(np.array([1.0]))[0]) for move in (first, second)]
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


def _path_corner(first: Path, second: Path, leave: float, meet: float, share: float) -> BezierPath:
    """The cubic that leaves and meets two paths along their tangents; between straight lines a `share` of two thirds is
    the parabola."""
    start, goal = first.poses(np.array([leave, 1.0]))
    end = second.poses(np.array([meet]))[0]
    out = first.tangent(leave) * (1.0 - leave) * share
    into = second.tangent(meet) * meet * share
    positions = np.stack([start[:3, 3], start[:3, 3] + out, end[:3, 3] - into, end[:3, 3]])
    return BezierPath(positions, np.stack([start[:3, :3], goal[:3, :3], end[:3, :3]]), share)


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
    first: PlannedMove,
    second: PlannedMove,
    geometry: Geometry,
    parts: tuple[PlannedMove, PlannedMove],
    seconds: float | None,
) -> Corner | NoBlend:
    """Time the three parts: one speed through the corner where the moves have room to reach it, else accelerating.

    Speeds are of fractions: a parabola at rate w leaves the first move at 2 (1 - leave) w and meets the second at
    2 meet w, since the corner's tangents are the rest and the beginning of the two moves; a cubic in proportion.
    """
    (begin, leave), (meet, _) = (part.span for part in parts)
    tail, head = _steepness(geometry, first, second, leave, meet)
    if seconds is not None:
        first = replace(first, profile=replace(first.profile, braking=corner_acceleration(first)))
        second = replace(second, profile=replace(second.profile, rising=corner_acceleration(second)))
    arriving = float(first.law.speeds[0]) * (first.span[1] - first.span[0])
    room = 2.0 * first.profile.acceleration * (leave - begin)
    stopping = float(np.sqrt(2.0 * second.profile.acceleration * (1.0 - meet)))
    rate = min(
        _ceiling(first.profile, leave) / tail,
        float(np.sqrt(arriving * arriving + room)) / tail,
        _ceiling(second.profile, meet) / head,
        stopping / head,
        _corner_rate(model, first, second, geometry, leave, seconds),
    )
    if rate < SLOWEST:
        return NoBlend("the corner allows no speed")
    entry = max(rate, float(np.sqrt(max(arriving * arriving - room, 0.0))) / tail)
    law = TimeLaw(np.array([0.0, 2.0 / (entry + rate)]), np.array([0.0, 1.0]), np.array([entry, rate]))
    trimmed = _timed(parts[0], first.profile, arriving, tail * entry)
    rest = _timed(parts[1], second.profile, head * rate, 0.0)
    ends = np.array([0.0, 1.0])
    joints, poses = geometry.joints(ends), geometry.tcp(ends)
    corner = PlannedMove(
        kind="corner",
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
        external_middle=_external_middle(first, second),
    )
    return Corner(trimmed, corner, rest, float(law.time_of(0.5)))


def _timed(part: PlannedMove, profile: Profile, start_speed: float, end_speed: float) -> PlannedMove:
    """A part of a move with the law between two speeds, 1/s of the whole move."""
    return replace(part, profile=profile).part(part.span, profile.law(*part.span, start_speed, end_speed))


def _steepness(
    geometry: Geometry, first: PlannedMove, second: PlannedMove, leave: float, meet: float
) -> tuple[float, float]:
    """The fractions of the two moves per fraction of the corner, where they meet it."""
    if not (isinstance(geometry, PathGeometry) and isinstance(geometry.path, BezierPath)):
        return 2.0 * (1.0 - leave), 2.0 * meet
    if geometry.path.ways is None:
        return 3.0 * geometry.path.share * (1.0 - leave), 3.0 * geometry.path.share * meet
    wholes = [float(move.geometry.distance(np.array([1.0]))[0]) for move in (first, second)]
    length = float(np.linalg.norm(geometry.path.tangent(0.0)))
    return length / wholes[0], length / wholes[1]


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
    leave: float,
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
    points = geometry.tcp(knots)[:, :3, 3]
    bend = float(np.linalg.norm(np.diff(points, n=2, axis=0), axis=1).max()) / step**2
    wholes = [float(move.geometry.distance(np.array([1.0]))[0]) for move in moves]
    limit = min(move.profile.acceleration * whole for move, whole in zip(moves, wholes, strict=True))
    controller = first.controller
    if controller.corner_acceleration_mm_s2 is None:
        return min(rate, float(np.sqrt(limit / max(bend, 1e-9))))
    share = min(1.0, limit / (controller.path_acceleration_mm_s2 or limit))
    size = float(first.geometry.distance(np.array([1.0]))[0]) * (1.0 - leave)
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
    return np.asarray(move.external_start + fraction * (move.external_end - move.external_start))
