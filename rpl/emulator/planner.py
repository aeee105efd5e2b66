"""One move: from a request in the controller's terms to joints and poses at every moment, or the reason why not.

`plan` checks what a controller checks before or while it moves (reach, limits, configuration, singularity, speed of
the axes) and returns a `PlannedMove` that can be asked for any time. Joint moves start and stop all axes together; path
moves synchronise translation, orientation and external axes, the slowest governs. Moves begin and end at rest; joining
them in a corner is the business of `rpl.emulator.blending`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.configuration import Selection
from rpl.emulator.mechanisms import Carried, Carrier, ExternalWay, along
from rpl.emulator.model import RobotModel
from rpl.emulator.paths import Arc, Line, Path, arc_through
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix, rotation_angle
from rpl.emulator.rounding import NO_WAY, NOISE, first_least, steps_of
from rpl.emulator.timelaw import Profile, TimeLaw, mean_acceleration, of_constant_time, slowed_to
from rpl.emulator.tracking import MotionFault, Track, solve_arm_joints, track_flanges, track_wrist_joints
from rpl.ir.rules import SLOWEST
from rpl.motionmodel import PLAIN, MotionModel

__all__ = ["MotionFault", "MoveRequest", "MoveSamples", "PlannedMove", "plan"]

Select = Callable[[FloatArray, FloatArray], Selection]
CheckEnd = Callable[[FloatArray], str | None]
SPEED_SLACK, NO_SHARE = 1e-3, 1e-15  # shares of an axis' speed: more by sampling does not count; less never ends a move
# A path that needs too fast an axis is called singular when the Jacobian's condition (lengths per arm reach) is worse.
SINGULAR_CONDITION = 25.0
# Where a flange on a carried path is looked at first, to tell how finely the path has to be followed.
_ROUGH = np.linspace(0.0, 1.0, 17)


@dataclass(frozen=True, slots=True, eq=False)
class MoveRequest:
    """What a program asks of one robot: poses are of the tool centre point in the robot's base frame, mm.

    Give `target_joints` (n,) in pendant units or `target_pose` (4, 4). Axis speeds are fractions of their maximum (one
    number or (n,)). `select` chooses the configuration of a joint move to a pose (default: the nearest solution);
    `check_end` may refuse the configuration in which a path move arrives. External axes move evenly from
    `external_start` to `external_target` at most at `external_speeds` (deg/s or mm/s), with `external_accs` and within
    `external_limits` where these are known. With a `carrier` poses are of the tool in its work, not in the base.
    `effort` is the acceleration in force as a share, which the accelerations contain already; ramps of a constant time
    get longer by it. `braking`: the deceleration by the acceleration. `stop_ramp`: how fast the deceleration before a
    stop changes, as a share of how fast it changes elsewhere.
    """

    kind: Literal["joint", "linear", "circular", "spline"]
    target_joints: FloatArray | None = None
    target_pose: FloatArray | None = None
    via_pose: FloatArray | None = None
    swept_deg: float | None = None
    tool: FloatArray = field(default_factory=lambda: np.eye(4))
    select: Select | None = None
    check_end: CheckEnd | None = None
    path_speed_mm_s: float = 250.0
    path_acc_mm_s2: float = 2500.0
    ori_speed_deg_s: float = 180.0
    ori_acc_deg_s2: float = 600.0
    joint_speed: FloatArray | float = 1.0
    joint_acc: FloatArray | float = 1.0
    duration_s: float | None = None
    tcp_speed_for_joint_move: float | None = None
    orientation: Literal["interpolated", "constant", "wrist_joints"] = "interpolated"
    circle_orientation: Literal["base", "path"] = "base"
    reduce_speed_near_singularity: bool = False
    external_start: tuple[float, ...] = ()
    external_target: tuple[float, ...] = ()
    external_speeds: tuple[float, ...] = ()
    controller: MotionModel = PLAIN
    effort: float = 1.0
    braking: float = 1.0
    stop_ramp: float = 1.0
    external_accs: tuple[float | None, ...] = ()
    external_limits: tuple[tuple[float, float] | None, ...] = ()
    carrier: Carrier | None = None
    external_way: ExternalWay | None = None

    def carried(self) -> Carried | None:
        """The carrier over the external axes of this move."""
        if self.carrier is None:
            return None
        start = self.external_start or (0.0,)
        return Carried(self.carrier, np.array([start, self.external_target or start]), self.external_way)


class Geometry(Protocol):
    """Joints and tool poses over the fraction 0..1 of a move."""

    @property
    def tool(self) -> FloatArray:
        """The tool centre point in the flange (4, 4)."""

    def joints(self, fraction: FloatArray) -> FloatArray:
        """Joints (k, n) at fractions (k,)."""

    def tcp(self, fraction: FloatArray) -> FloatArray:
        """Poses of the tool centre point (k, 4, 4) at fractions (k,), in its work where that is carried."""

    def distance(self, fraction: FloatArray) -> FloatArray:
        """Millimetres (k,) that the tool centre point has travelled."""

    def fraction_at(self, distance_mm: float) -> float:
        """The fraction at which that many millimetres are travelled."""


@dataclass(frozen=True, slots=True, eq=False)
class JointGeometry:
    """All joints move evenly; the tool draws whatever curve that gives, measured at `knots` once."""

    model: RobotModel
    start: FloatArray
    end: FloatArray
    tool: FloatArray
    knots: FloatArray
    travelled: FloatArray
    carried: Carried | None = None

    def joints(self, fraction: FloatArray) -> FloatArray:
        return np.asarray(self.start + fraction[..., None] * (self.end - self.start))

    def tcp(self, fraction: FloatArray) -> FloatArray:
        flanges = self.model.forward(self.joints(fraction))
        return np.asarray(flanges @ self.tool if self.carried is None else self.carried.in_work(flanges, fraction))

    def distance(self, fraction: FloatArray) -> FloatArray:
        return np.interp(fraction, self.knots, self.travelled)

    def fraction_at(self, distance_mm: float) -> float:
        if self.travelled[-1] <= 0.0:
            return 0.0
        return float(np.interp(distance_mm, self.travelled, self.knots))


@dataclass(frozen=True, slots=True, eq=False)
class PathGeometry:
    """The tool follows a path exactly; joints are solved anew at each question, guided by the track."""

    model: RobotModel
    path: Path
    tool: FloatArray
    track: Track
    carried: Carried | None = None

    def joints(self, fraction: FloatArray) -> FloatArray:
        near = self.track.at(fraction)
        ends = (fraction <= 0.0) | (fraction >= 1.0)
        if ends.all():
            return near
        found = self.model.inverse_batch(flanges_of(self.path, self.tool, self.carried, fraction), near)
        # Axis by axis, as the inverse lays its results out: (n, branch, k).
        off = found.joints.T - near.T[:, None]
        off -= 360.0 * np.rint(off * (1.0 / 360.0))
        largest = np.abs(off, out=off)[self.model.revolute].max(axis=0)
        largest[~found.valid.T] = np.inf
        best, rows = first_least(largest, 0), np.arange(len(near))
        joints = found.joints[rows, best]
        joints += np.where(self.model.revolute, 360.0 * np.rint((near - joints) / 360.0), 0.0)
        return np.where(((largest[best, rows] < 5.0) & ~ends)[:, None], joints, near)

    def tcp(self, fraction: FloatArray) -> FloatArray:
        return self.path.poses(fraction)

    def distance(self, fraction: FloatArray) -> FloatArray:
        return np.asarray(fraction * self.path.length_mm)

    def fraction_at(self, distance_mm: float) -> float:
        return min(max(distance_mm / self.path.length_mm, 0.0), 1.0) if self.path.length_mm > 0.0 else 0.0


def flanges_of(path: Path, tool: FloatArray, carried: Carried | None, fraction: FloatArray) -> FloatArray:
    """Flange poses (k, 4, 4) in the robot's base that put the tool on its path."""
    poses = path.poses(fraction)
    return np.asarray(poses @ invert_pose(tool) if carried is None else carried.flanges(poses, fraction))


@dataclass(frozen=True, slots=True, eq=False)
class WristGeometry:
    """The tool centre point follows a path while the wrist joints move evenly."""

    model: RobotModel
    path: Path
    tool: FloatArray
    track: Track

    def joints(self, fraction: FloatArray) -> FloatArray:
        near = self.track.at(fraction)
        exact = solve_arm_joints(self.model, near, self.path.poses(fraction)[:, :3, 3], self.tool, fraction)
        return near if isinstance(exact, MotionFault) else exact

    def tcp(self, fraction: FloatArray) -> FloatArray:
        return np.asarray(self.model.forward(self.joints(fraction)) @ self.tool)

    def distance(self, fraction: FloatArray) -> FloatArray:
        return np.asarray(fraction * self.path.length_mm)

    def fraction_at(self, distance_mm: float) -> float:
        return min(max(distance_mm / self.path.length_mm, 0.0), 1.0) if self.path.length_mm > 0.0 else 0.0


@dataclass(frozen=True, slots=True, eq=False)
class MoveSamples:
    """A move at k even moments: times (k,) s, joints (k, n) pendant units, tool poses (k, 4, 4) in the base frame."""

    times: FloatArray
    joints: FloatArray
    tcp: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class PlannedMove:
    """A move that can be made. `slowed` tells that the speed was reduced to keep an axis within its maximum.

    `span` is the part of the geometry that is driven: all of it, or less where a corner takes over.
    """

    kind: Literal["joint", "linear", "circular", "spline", "corner"]
    start_joints: FloatArray
    end_joints: FloatArray
    start_pose: FloatArray
    end_pose: FloatArray
    duration_s: float
    length_mm: float
    slowed: bool
    geometry: Geometry
    profile: Profile
    law: TimeLaw
    span: tuple[float, float]
    external_start: FloatArray
    external_end: FloatArray
    controller: MotionModel = PLAIN
    external_middle: FloatArray | None = None  # of a corner: inner control points (m, e) of the external axes' curve
    external_way: ExternalWay | None = None

    def _fraction(self, time_s: ArrayLike) -> FloatArray:
        begin, end = self.span
        return np.asarray(begin + (end - begin) * self.law.at(time_s))

    def _ask(self, question: Callable[[FloatArray], FloatArray], time_s: ArrayLike) -> FloatArray:
        fraction = self._fraction(time_s)
        return question(fraction) if fraction.ndim else question(fraction[None])[0]

    def _time_at(self, distance_mm: float) -> float:
        begin, end = self.span
        before = float(self.geometry.distance(np.array([begin]))[0])
        fraction = self.geometry.fraction_at(before + distance_mm)
        return float(self.law.time_of((fraction - begin) / max(end - begin, 1e-300)))

    def joints_at(self, time_s: ArrayLike) -> FloatArray:
        """Joints at a time (n,) or at times (k,) -> (k, n); s from the start of the move."""
        return self._ask(self.geometry.joints, time_s)

    def tcp_at(self, time_s: ArrayLike) -> FloatArray:
        """Pose of the tool centre point at a time (4, 4) or at times (k, 4, 4)."""
        return self._ask(self.geometry.tcp, time_s)

    def external_at(self, time_s: ArrayLike) -> FloatArray:
        """External axes at a time (e,) or at times (k, e)."""
        return self.external_along(self._fraction(time_s))

    def external_along(self, fraction: FloatArray) -> FloatArray:
        """External axes (..., e) at fractions (...) of the move."""
        if self.external_way is not None:
            return self.external_way.at(fraction)
        middle = () if self.external_middle is None else tuple(self.external_middle)
        return along(np.stack([self.external_start, *middle, self.external_end]), fraction)

    def time_at_distance_from_start(self, distance_mm: float) -> float:
        """The time at which the tool centre point has travelled that far; at most the whole duration."""
        return self._time_at(distance_mm)

    def time_at_distance_from_end(self, distance_mm: float) -> float:
        """The time at which the tool centre point still has that far to travel; at least 0."""
        return self._time_at(max(self.length_mm - distance_mm, 0.0))

    def part(self, span: tuple[float, float], law: TimeLaw) -> "PlannedMove":
        """A part `span` of the geometry with its own law. What is known of the ends stays as it is, bit for bit."""
        known = {
            self.span[0]: (self.start_joints, self.start_pose),
            self.span[1]: (self.end_joints, self.end_pose),
        }
        asked = [fraction for fraction in span if fraction not in known]
        if asked:
            places = np.array(asked)
            found = zip(self.geometry.joints(places), self.geometry.tcp(places), strict=True)
            known.update(zip(asked, found, strict=True))
        (start_joints, start_pose), (end_joints, end_pose) = known[span[0]], known[span[1]]
        distances = self.geometry.distance(np.array(span))
        return replace(
            self,
            start_joints=start_joints,
            end_joints=end_joints,
            start_pose=start_pose,
            end_pose=end_pose,
            duration_s=law.duration,
            length_mm=float(distances[1] - distances[0]),
            law=law,
            span=span,
        )

    def sample(self, count: int) -> MoveSamples:
        """The move at `count` even moments from its start to its end."""
        times = np.linspace(0.0, self.duration_s, count)
        return MoveSamples(times, self.joints_at(times), self.tcp_at(times))


def plan(model: RobotModel, start_joints: ArrayLike, request: MoveRequest) -> PlannedMove | MotionFault:
    """Plan one move from joints (n,) in pendant units, at rest at both ends; a `MotionFault` when it cannot be made."""
    start = np.asarray(start_joints, dtype=np.float64)
    fault = bad_request(request)
    if fault is not None:
        return fault
    return _plan_joint(model, start, request) if request.kind == "joint" else _plan_path(model, start, request)


def bad_request(request: MoveRequest) -> MotionFault | None:
    """What is wrong with a request by itself."""
    speeds = {
        "path speed": request.path_speed_mm_s,
        "path acceleration": request.path_acc_mm_s2,
        "orientation speed": request.ori_speed_deg_s,
        "orientation acceleration": request.ori_acc_deg_s2,
        "joint speed": float(np.min(request.joint_speed)),
        "joint acceleration": float(np.min(request.joint_acc)),
    }
    for name, value in speeds.items():
        if not value > 0.0:
            return MotionFault("bad_speed", f"the {name} is {value:g}, but must be more than zero")
        if not (NO_SHARE if name.startswith("joint") else SLOWEST) <= value < np.inf:
            return MotionFault("bad_speed", f"the {name} is {value:g}: no robot moves like that")
    if request.target_joints is None and request.target_pose is None:
        return MotionFault("bad_target", "the move has no target")
    if request.kind == "circular" and (request.via_pose is None or request.target_pose is None):
        return MotionFault("bad_target", "a circular move needs a point on the way and an end pose")
    for place, (goal, limits) in enumerate(zip(request.external_target, request.external_limits, strict=False)):
        if limits is not None and not limits[0] - 1e-6 <= goal <= limits[1] + 1e-6:
            low, high = limits
            text = f"external axis {place + 1} would be at {goal:.3f}, outside {low:g}..{high:g}"
            return MotionFault("joint_limit", text, None, 1.0)
    return None


def _plan_joint(model: RobotModel, start: FloatArray, request: MoveRequest) -> PlannedMove | MotionFault:
    end = joint_target(model, start, request)
    if isinstance(end, MotionFault):
        return end
    end = start if np.abs(end - start).max() < NOISE else end  # rounding alone is no way, with a speed and corners
    geometry = joint_geometry(model, start, end, request.tool, request.carried())
    way = np.abs(end - start)
    with np.errstate(divide="ignore"):
        speed = float(np.min(model.speeds * request.joint_speed / way))
        strength = request.controller.joint_acceleration_share
        acceleration = float(np.min(model.accelerations * strength * request.joint_acc / way))
    length = float(geometry.travelled[-1])
    if request.tcp_speed_for_joint_move is not None and length > NO_WAY:
        speed = min(speed, request.tcp_speed_for_joint_move / length)
    ramp, smoothing = _joint_ramp_s(model, request.controller, way), request.controller.joint_smoothing_s
    return finished(request, geometry, _profile(request, speed, acceleration, ramp, smoothing))


def _joint_ramp_s(model: RobotModel, controller: MotionModel, way: FloatArray) -> float:
    """How long all axes speed up together that go these ways (n,): each in the share of its ramp that it has of its
    speed, at least the ramp of the controller."""
    shares = way / model.speeds
    if not (controller.joint_ramps_s or controller.joint_ramp_deg > 0.0) or shares.max() <= 0.0:
        return controller.joint_ramp_s
    if len(controller.joint_ramps_s) == len(way):
        ramps = np.array(controller.joint_ramps_s)
    else:
        ramps = controller.joint_ramp_deg / model.speeds
    return max(controller.joint_ramp_s, float(np.max(ramps * shares) / shares.max()))


def joint_geometry(
    model: RobotModel, start: FloatArray, end: FloatArray, tool: FloatArray, carried: Carried | None = None
) -> JointGeometry:
    """Even joint motion with the tool's way measured along chords, one every four degrees."""
    turn = np.abs(end - start).max()
    if carried is not None:
        turn = max(turn, np.abs(carried.control[-1] - carried.control[0]).max())
    count = steps_of(turn, 4.0, 8, 120) + 1
    knots = np.linspace(0.0, 1.0, count)
    empty = JointGeometry(model, start, end, tool, knots, np.zeros(count), carried)
    points = empty.tcp(knots)[:, :3, 3]
    return replace(empty, travelled=np.insert(np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)), 0, 0.0))


def joint_target(model: RobotModel, start: FloatArray, request: MoveRequest) -> FloatArray | MotionFault:
    """The joints (n,) in which a joint move ends, within their limits."""
    given = request.target_joints
    joints = _pose_target(model, start, request) if given is None else np.asarray(given, dtype=np.float64)
    if isinstance(joints, MotionFault):
        return joints
    outside = model.within_limits(joints)
    if outside:
        axis = outside[0]
        low, high = model.limits[axis]
        return MotionFault(
            "joint_limit", f"joint {axis + 1} would be at {joints[axis]:.3f}, outside {low:g}..{high:g}", axis, 1.0
        )
    return joints


def _pose_target(model: RobotModel, start: FloatArray, request: MoveRequest) -> FloatArray | MotionFault:
    pose = request.target_pose if request.target_pose is not None else np.eye(4)
    carried = request.carried()
    flange = pose @ invert_pose(request.tool) if carried is None else carried.flanges(pose[None], np.ones(1))[0]
    x, y, z = pose[:3, 3]
    if not model.inverse(flange, start):
        return MotionFault("unreachable", f"the pose at {x:.3f}, {y:.3f}, {z:.3f} mm is out of reach", None, 1.0)
    if request.select is not None:
        selection = request.select(flange, start)
        if selection.joints is None:
            return MotionFault("configuration", selection.reason, None, 1.0)
        return selection.joints
    nearest = model.nearest(flange, start)
    if nearest is not None:
        return nearest
    axis = model.within_limits(model.inverse(flange, start)[0].joints)[0]
    return MotionFault(
        "joint_limit", f"every solution at {x:.3f}, {y:.3f}, {z:.3f} mm exceeds a joint limit", axis, 1.0
    )


def _plan_path(model: RobotModel, start: FloatArray, request: MoveRequest) -> PlannedMove | MotionFault:
    outside = model.within_limits(start)
    if outside:
        return MotionFault("joint_limit", f"joint {outside[0] + 1} is outside its limits", outside[0], 0.0)
    carried = request.carried()
    if carried is not None and request.orientation == "wrist_joints":
        text = "evenly moving wrist joints go with a tool on the robot and a frame that stands still"
        return MotionFault("bad_target", text)
    path = _path(model, tool_at(model, start, request, 0.0), request)
    if isinstance(path, MotionFault):
        return path
    track = path_track(model, start, path, request)
    if isinstance(track, MotionFault):
        return track
    if request.check_end is not None:
        reason = request.check_end(track.joints[-1])
        if reason is not None:
            return MotionFault("configuration", reason, None, 1.0)
    geometry: Geometry
    if request.orientation == "wrist_joints":
        geometry = WristGeometry(model, path, request.tool, track)
    else:
        geometry = PathGeometry(model, path, request.tool, track, carried)
    turn = np.rad2deg(path.turn_rad)
    with np.errstate(divide="ignore"):
        speed = min(_over(request.path_speed_mm_s, path.length_mm), _over(request.ori_speed_deg_s, turn))
        acceleration = min(_over(request.path_acc_mm_s2, path.length_mm), _over(request.ori_acc_deg_s2, turn))
    if request.orientation == "wrist_joints":
        wrist = float(np.min(model.speeds[3:] / np.maximum(np.abs(track.joints[-1] - track.joints[0])[3:], 1e-12)))
        speed, acceleration = min(speed, wrist), min(acceleration, wrist / 0.1)
    ramp, smoothing = request.controller.path_ramp_s, request.controller.path_smoothing_s
    profile = within_axis_speeds(model, track, _profile(request, speed, acceleration, ramp, smoothing), request)
    return profile if isinstance(profile, MotionFault) else finished(request, geometry, profile)


def _over(rate: float, way: float) -> float:
    return rate / way if way > NO_WAY else np.inf


def tool_at(model: RobotModel, joints: FloatArray, request: MoveRequest, fraction: float) -> FloatArray:
    """Where the tool is (4, 4), as the poses of the request count, at the start (0) or end (1) of the external axes."""
    carried = request.carried()
    flange = model.forward(joints)
    return flange @ request.tool if carried is None else carried.in_work(flange[None], np.array([fraction]))[0]


def _path(model: RobotModel, first: FloatArray, request: MoveRequest) -> Path | MotionFault:
    if request.target_pose is None:
        goal = tool_at(model, request.target_joints if request.target_joints is not None else model.home, request, 1.0)
    else:
        goal = request.target_pose
    constant = request.orientation == "constant"
    if request.kind == "linear" or request.via_pose is None:
        return Line(first, pose_matrix(goal[:3, 3], first[:3, :3]) if constant else goal)
    arc: Arc | None = arc_through(
        first,
        request.via_pose,
        goal,
        swept_deg=request.swept_deg,
        constant_orientation=constant,
        follow_path=request.circle_orientation == "path",
    )
    if arc is None:
        return MotionFault("degenerate_circle", "the three points lie on a line or coincide: they fix no circle")
    return arc


def path_track(model: RobotModel, start: FloatArray, path: Path, request: MoveRequest) -> Track | MotionFault:
    """The joints along a path, from `start` (n,) on."""
    length, turn = path.length_mm, np.rad2deg(path.turn_rad)
    carried = request.carried()
    if carried is not None:
        length, turn = _swept(carried.flanges(path.poses(_ROUGH), _ROUGH), length, turn)
    if length <= NO_WAY and turn <= NO_WAY:
        return Track(np.array([0.0, 1.0]), np.stack([start, start]))
    samples = max(steps_of(length, 10.0, 8, 400), steps_of(turn, 3.0, 8, 400)) + 1
    inverse_tool = invert_pose(request.tool)
    if request.orientation == "wrist_joints":
        if model.axes < 6:
            return MotionFault("bad_target", "evenly moving wrist joints need an arm with six joints")
        end = model.nearest(path.poses(np.ones(1))[0] @ inverse_tool, start)
        if end is None:
            return MotionFault("unreachable", "the end of the path is out of reach", None, 1.0)
        return track_wrist_joints(model, lambda s: path.poses(s)[:, :3, 3], request.tool, start, end, samples)
    return track_flanges(model, lambda s: flanges_of(path, request.tool, carried, s), start, samples)


def _swept(flanges: FloatArray, length: float, turn: float) -> tuple[float, float]:
    """How far (mm) and how much (degrees) a flange moves at least, beside the tool's own way and turn."""
    way = float(np.linalg.norm(np.diff(flanges[:, :3, 3], axis=0), axis=1).sum())
    between = np.swapaxes(flanges[:-1, :3, :3], 1, 2) @ flanges[1:, :3, :3]
    return max(length, way), max(turn, float(np.rad2deg(rotation_angle(between)).sum()))


def within_axis_speeds(
    model: RobotModel, track: Track, profile: Profile, request: MoveRequest
) -> Profile | MotionFault:
    """The profile itself, a slower one, or the fault that an axis would have to turn too fast."""
    steps = np.abs(np.diff(track.joints, axis=0))
    spans = np.maximum(np.diff(profile.unsmoothed(0.0, 1.0).time_of(track.fractions)), 1e-12)
    excess = steps / spans[:, None] / model.speeds
    if not steps.any() or excess.max() <= 1.0 + SPEED_SLACK:
        return profile
    if request.reduce_speed_near_singularity:
        gaps = np.diff(track.fractions)
        with np.errstate(divide="ignore"):
            ceilings = np.min(model.speeds * gaps[:, None] / np.maximum(steps, 1e-12), axis=1)
        return replace(profile, knots=track.fractions, ceilings=ceilings)
    place, axis = (int(i) for i in np.unravel_index(first_least(-excess.ravel()), excess.shape))
    kind: Literal["singularity", "axis_speed"] = "singularity" if _ill(model, track.joints[place]) else "axis_speed"
    return MotionFault(
        kind,
        f"joint {axis + 1} would have to move at {100.0 * excess[place, axis]:.0f} % of its maximum speed",
        axis,
        float(track.fractions[place]),
    )


def _ill(model: RobotModel, joints: FloatArray) -> bool:
    """Is the arm close to a singular posture?"""
    jacobian = model.jacobian(joints)
    reach = max(float(np.linalg.norm(model.forward(joints)[:3, 3])), 1.0)
    values = np.linalg.svd(np.vstack([jacobian[:3] / reach, jacobian[3:]]), compute_uv=False)
    smallest = values[min(model.axes, 6) - 1]
    return bool(values[0] > SINGULAR_CONDITION * smallest)


def _profile(request: MoveRequest, speed: float, acceleration: float, ramp_s: float, smoothing_s: float) -> Profile:
    """Top speed and acceleration of the whole move, external axes and a programmed duration included."""
    tops = zip(request.external_start, request.external_target, request.external_speeds, strict=False)
    for place, (begin, goal, top) in enumerate(tops):
        own = request.external_accs[place] if place < len(request.external_accs) else None
        speed = min(speed, _over(top, abs(goal - begin)))
        acceleration = min(acceleration, _over(top / 0.3 if own is None else own, abs(goal - begin)))
    ramp_s *= 0.5 * (1.0 + 1.0 / request.braking) / request.effort
    acceleration = mean_acceleration(acceleration, acceleration * request.braking)
    if request.duration_s is not None and request.duration_s > 0.0 and np.isfinite(speed):
        moving_s = max(request.duration_s - smoothing_s, 0.5 * request.duration_s)
        if ramp_s > 0.0 and moving_s > ramp_s:
            speed = min(speed, 1.0 / (moving_s - ramp_s))
        elif ramp_s <= 0.0:
            speed = slowed_to(speed, acceleration, moving_s)
    if ramp_s > 0.0 and np.isfinite(speed):
        acceleration = min(acceleration, of_constant_time(speed, ramp_s))
    return Profile(speed, acceleration, smoothing_s=smoothing_s).braked(request.braking, request.stop_ramp)


def finished(request: MoveRequest, geometry: Geometry, profile: Profile) -> PlannedMove:
    """The whole geometry as a move from rest to rest."""
    law = profile.law()
    ends = np.array([0.0, 1.0])
    joints, poses = geometry.joints(ends), geometry.tcp(ends)
    begin = np.array(request.external_start, dtype=np.float64)
    goal = np.array(request.external_target, dtype=np.float64) if request.external_target else begin
    return PlannedMove(
        kind=request.kind,
        start_joints=joints[0],
        end_joints=joints[1],
        start_pose=poses[0],
        end_pose=poses[1],
        duration_s=law.duration,
        length_mm=float(geometry.distance(ends)[1]),
        slowed=profile.ceilings is not None,
        geometry=geometry,
        profile=profile,
        law=law,
        span=(0.0, 1.0),
        external_start=begin,
        external_end=goal,
        controller=request.controller,
        external_way=request.external_way,
    )
