"""Spline blocks as moves: the smooth runs between two stops of a block, each one path with one time law.

The curve itself is `rpl.passes.curves`. Here it is a path even in distance, with the speed of each segment as a
ceiling, lowered where the tool turns fast, where the curve is tight (M: the way along it and across it each get the
path acceleration) and where an axis would be too fast. Blocks of joint moves run smoothly through their joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.mechanisms import ExternalWay, along
from rpl.emulator.model import RobotModel
from rpl.emulator.planner import (
    Geometry,
    MoveRequest,
    PathGeometry,
    PlannedMove,
    WristGeometry,
    bad_request,
    finished,
    joint_target,
    path_track,
    tool_at,
    within_axis_speeds,
)
from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_angle, rotation_vector_to_matrix
from rpl.emulator.splinerules import BlockRule, ruled
from rpl.emulator.timelaw import Profile, mean_acceleration, of_constant_time
from rpl.emulator.tracking import MotionFault
from rpl.passes.curves import SAME_MM, Leg, Segment, block, cubic, smooth_numbers
from rpl.passes.rigid import Pose, pose_of_matrix

Kind = Literal["joint", "linear", "circular", "spline"]
# Knots per curved segment: of the table of lengths, of the speed ceilings.
_TABLE, _CEILINGS = 64, 16
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
_LEGS: dict[str, Literal["spline", "line", "arc"]] = {"linear": "line", "circular": "arc"}


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """One move over several segments; `marks` are the fractions of the move at which each of them ends."""

    move: PlannedMove
    marks: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class BlockFault:
    """Which segment (from 0) of a block cannot be driven, and why."""

    segment: int
    fault: MotionFault


# ---- paths


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """One segment ready for arrays: coefficients (3, 6) of position and (3, m) of the rotation vector over u = 0..1;
    its length at the knots (k,) and how u changes with it."""

    segment: Segment
    position: FloatArray
    rotation: FloatArray
    start: FloatArray
    knots: FloatArray
    lengths: FloatArray

    def u_at(self, distance: FloatArray) -> FloatArray:
        """The parameter 0..1 at distances (k,) from the segment's start."""
        if self.segment.kind != "spline":
            return np.asarray(distance / self.lengths[-1])
        return _hermite(distance, self.lengths, self.knots, 1.0 / np.maximum(self.pace(self.knots), 1e-9))

    def pace(self, u: FloatArray) -> FloatArray:
        """Millimetres per parameter (k,)."""
        return np.asarray(np.linalg.norm(_values(_derivative(self.position), u), axis=-1))

    def positions(self, u: FloatArray) -> FloatArray:
        circle = self.segment.circle
        if circle is None:
            return _values(self.position, u)
        centre = np.array([circle.centre.x, circle.centre.y, circle.centre.z])
        return np.asarray(centre + self._around(u) @ (self.start[:3, 3] - centre))

    def _around(self, u: FloatArray) -> FloatArray:
        circle = self.segment.circle
        assert circle is not None  # only asked for an arc
        axis = np.array([circle.axis.x, circle.axis.y, circle.axis.z])
        return rotation_vector_to_matrix(u[..., None] * circle.sweep * axis)

    def rotations(self, u: FloatArray) -> FloatArray:
        own = self.start[:3, :3] @ rotation_vector_to_matrix(_values(self.rotation, u))
        return np.asarray(self._around(u) @ own if self.segment.follow else own)

    def direction(self, u: float) -> FloatArray:
        """Unit vector (3,) along the curve."""
        circle = self.segment.circle
        at = np.array([u])
        if circle is None:
            way = _values(_derivative(self.position), at)[0]
        else:
            axis = np.array([circle.axis.x, circle.axis.y, circle.axis.z])
            centre = np.array([circle.centre.x, circle.centre.y, circle.centre.z])
            way = np.cross(axis, self.positions(at)[0] - centre)
        return np.asarray(way / max(float(np.linalg.norm(way)), 1e-300))

    def bends(self, u: FloatArray) -> FloatArray:
        """Curvatures (k,) in 1/mm."""
        first = _derivative(self.position)
        one, two = _values(first, u), _values(_derivative(first), u)
        area = np.linalg.norm(np.cross(one, two), axis=-1)
        return np.asarray(area / np.maximum(np.linalg.norm(one, axis=-1) ** 3, 1e-9))


def _part(segment: Segment) -> _Part:
    position, rotation = np.array(segment.position), np.array(segment.rotation)
    start = np.array(segment.start.matrix)
    ends = np.array([0.0, 1.0])
    bare = _Part(segment, position, rotation, start, ends, ends * segment.span)
    if segment.kind != "spline":
        return bare
    knots = np.linspace(0.0, 1.0, _TABLE + 1)
    inside = knots[:-1, None] + (0.5 + 0.5 * _NODES) / _TABLE
    steps = bare.pace(inside) @ _WEIGHTS * 0.5 / _TABLE
    return replace(bare, knots=knots, lengths=np.insert(np.cumsum(steps), 0, 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class SplinePath:
    """A smooth run of a block as a path, even in distance; `marks` (m+1,) mm are where its segments begin and end."""

    parts: tuple[_Part, ...]
    marks: FloatArray

    @property
    def length_mm(self) -> float:
        return float(self.marks[-1])

    @property
    def turn_rad(self) -> float:
        turns = self.poses(np.linspace(0.0, 1.0, _CEILINGS * len(self.parts) + 1))[:, :3, :3]
        return float(rotation_angle(np.swapaxes(turns[:-1], 1, 2) @ turns[1:]).sum())

    def _places(self, fraction: FloatArray) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.intp]], FloatArray]:
        """Segment and parameter at fractions (k,)."""
        if self.length_mm < SAME_MM:
            return np.zeros(fraction.shape, dtype=np.intp), fraction
        way = np.clip(fraction, 0.0, 1.0) * self.length_mm
        holder = np.clip(np.searchsorted(self.marks, way, side="right") - 1, 0, len(self.parts) - 1)
        u = np.empty(fraction.shape)
        for number in np.unique(holder):
            here = holder == number
            u[here] = self.parts[number].u_at(way[here] - self.marks[number])
        return holder, u

    def poses(self, fraction: ArrayLike) -> FloatArray:
        s = np.atleast_1d(np.asarray(fraction, dtype=np.float64))
        holder, u = self._places(s)
        done = np.empty((*s.shape, 4, 4))
        for number in np.unique(holder):
            here = holder == number
            part = self.parts[number]
            done[here] = pose_matrix(part.positions(u[here]), part.rotations(u[here]))
        return done if np.ndim(fraction) else done[0]

    def tangent(self, fraction: float) -> FloatArray:
        holder, u = self._places(np.array([fraction]))
        return self.parts[int(holder[0])].direction(float(u[0])) * self.length_mm

    def knots(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Fractions (k+1,), the segment (k,) and the greatest curvature (k,) between them, for the speed ceilings."""
        fractions, holders, bends = [np.zeros(1)], [], []
        for number, part in enumerate(self.parts):
            count = 1 if part.segment.kind == "line" else _CEILINGS
            steps = np.linspace(self.marks[number], self.marks[number + 1], count + 1)
            curved = np.zeros(count + 1)
            if part.segment.kind == "spline":
                curved = part.bends(part.u_at(steps - self.marks[number]))
            fractions.append(steps[1:] / max(self.length_mm, SAME_MM))
            holders.append(np.full(count, number))
            bends.append(np.maximum(curved[1:], curved[:-1]))
        joined = np.concatenate(fractions)
        joined[-1] = 1.0
        return joined, np.concatenate(holders), np.concatenate(bends)


def spline_path(segments: Sequence[Segment]) -> SplinePath:
    """The path of one run of `rpl.passes.curves.block`."""
    parts = tuple(_part(segment) for segment in segments)
    return SplinePath(parts, np.cumsum([0.0, *(part.lengths[-1] for part in parts)]))


# ---- planning


def plan_block(
    model: RobotModel,
    start_joints: ArrayLike,
    requests: Sequence[MoveRequest],
    kinds: Sequence[Kind],
    rules: Sequence[BlockRule] = (),
    mean: bool = False,
) -> list[Run] | BlockFault:
    """Plan a block from joints (n,) in pendant units: its requests (poses in the robot's base, mm) and their kinds, the
    points of a curve being `spline`; `rules` say more of its speeds, `mean`: its curves are means of parabolas. Runs
    begin and end at rest."""
    found = _planned_runs(model, start_joints, requests, kinds, mean)
    return found if isinstance(found, BlockFault) or not rules else ruled(found, rules)


def _planned_runs(
    model: RobotModel, start_joints: ArrayLike, requests: Sequence[MoveRequest], kinds: Sequence[Kind], mean: bool
) -> list[Run] | BlockFault:
    start = np.asarray(start_joints, dtype=np.float64)
    for number, request in enumerate(requests):
        fault = bad_request(request)
        if fault is not None:
            return BlockFault(number, fault)
    if all(kind == "joint" for kind in kinds):
        return _plan_joints(model, start, requests)
    if requests[0].carrier is not None and any(one.orientation == "wrist_joints" for one in requests):
        text = "evenly moving wrist joints go with a tool on the robot and a frame that stands still"
        return BlockFault(0, MotionFault("bad_target", text))
    legs = [_leg(model, request, kind) for request, kind in zip(requests, kinds, strict=True)]
    runs = block(pose_of_matrix(tool_at(model, start, requests[0], 0.0).tolist()), legs, mean)
    if isinstance(runs, int):
        flat = "the three points lie on a line or coincide: they fix no circle"
        return BlockFault(runs, MotionFault("degenerate_circle", flat))
    done: list[Run] = []
    before = 0
    for segments in runs:
        made = _plan_run(model, start, segments, requests[before : before + len(segments)])
        if isinstance(made, BlockFault):
            return BlockFault(before + made.segment, made.fault)
        done.append(made)
        start = made.move.end_joints
        before += len(segments)
    return done


def _leg(model: RobotModel, request: MoveRequest, kind: Kind) -> Leg:
    target = request.target_pose
    if target is None:
        joints = request.target_joints if request.target_joints is not None else model.home
        target = tool_at(model, joints, request, 1.0)
    via: Pose | None = pose_of_matrix(request.via_pose.tolist()) if request.via_pose is not None else None
    return Leg(
        _LEGS.get(kind, "spline"),
        pose_of_matrix(target.tolist()),
        via.position if via is not None else None,
        request.swept_deg,
        request.circle_orientation == "path",
        request.orientation == "constant",
    )


def _plan_run(
    model: RobotModel, start: FloatArray, segments: Sequence[Segment], requests: Sequence[MoveRequest]
) -> Run | BlockFault:
    path = spline_path(segments)
    # M: with evenly moving wrist joints they move evenly over the whole run, whatever its points say.
    by_wrist = any(request.orientation == "wrist_joints" for request in requests)
    mode: Literal["wrist_joints", "interpolated"] = "wrist_joints" if by_wrist else "interpolated"
    marks = np.linspace(0.0, 1.0, len(segments) + 1) if path.length_mm < SAME_MM else path.marks / path.length_mm
    whole = replace(_with_external(requests, marks), kind="spline", orientation=mode)
    track = path_track(model, start, path, whole)
    if isinstance(track, MotionFault):
        return _at_segment(marks, track)
    for number, request in enumerate(requests):
        if request.check_end is not None:
            reason = request.check_end(track.at(marks[number + 1 : number + 2])[0])
            if reason is not None:
                return BlockFault(number, MotionFault("configuration", reason, None, 1.0))
    geometry: Geometry = PathGeometry(model, path, whole.tool, track, whole.carried())
    if by_wrist:
        geometry = WristGeometry(model, path, whole.tool, track)
    own = _driven_by(whole, _beside(_profile(path, requests), whole, marks), joint=False)
    profile = within_axis_speeds(model, track, own, whole)
    if isinstance(profile, MotionFault):
        return _at_segment(marks, profile)
    move = finished(whole, geometry, profile if profile is own else _lower(own, profile))
    return Run(move, tuple(float(mark) for mark in marks[1:]))


def _with_external(requests: Sequence[MoveRequest], marks: FloatArray) -> MoveRequest:
    """The last request of a run for all of it: external axes go smoothly through what each point says (M)."""
    first, last = requests[0], requests[-1]
    points = [first.external_start, *(one.external_target or one.external_start for one in requests)]
    whole = replace(last, external_start=first.external_start)
    spans = np.diff(marks)
    if len(requests) == 1 or not any(a != b for a, b in pairwise(points)) or spans.min() < 1e-9:
        return whole
    places = np.array(points, dtype=np.float64)
    rates = _steady_rates(places, spans)
    ends = [(tuple(a), tuple(b)) for a, b in pairwise(places.tolist())]
    pieces = [cubic(ends[at], (tuple(rates[at]), tuple(rates[at + 1])), float(span)) for at, span in enumerate(spans)]
    return replace(whole, external_way=ExternalWay(np.array(pieces), marks))


def _steady_rates(places: FloatArray, spans: FloatArray) -> FloatArray:
    """Rates (m+1, e) at points with which the cubics between them never turn back (Fritsch and Butland 1984)."""
    slopes = np.diff(places, axis=0) / spans[:, None]
    before, behind = slopes[:-1], slopes[1:]
    short, long = spans[:-1, None], spans[1:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = 3.0 * (short + long) / ((short + 2.0 * long) / behind + (2.0 * short + long) / before)
    inner = np.where(before * behind > 0.0, mean, 0.0)
    return np.vstack([slopes[:1], inner, slopes[-1:]])


def _beside(profile: Profile, whole: MoveRequest, marks: FloatArray) -> Profile:
    """The profile with the ceilings of external axes that move on a run."""
    if not whole.external_speeds or (whole.external_way is None and whole.external_start == whole.external_target):
        return profile
    knots = np.unique(np.concatenate([np.linspace(a, b, _CEILINGS + 1) for a, b in pairwise(marks)]))
    ends = np.array([whole.external_start, whole.external_target or whole.external_start], dtype=np.float64)
    places = along(ends, knots) if whole.external_way is None else whole.external_way.at(knots)
    speeds = np.array(whole.external_speeds[: places.shape[1]])
    rates = (np.abs(np.diff(places, axis=0)) / np.diff(knots)[:, None])[:, : len(speeds)]
    given = (*whole.external_accs, *(None for _ in speeds))[: len(speeds)]
    efforts = np.array([top / 0.3 if own is None else own for own, top in zip(given, speeds, strict=True)])
    with np.errstate(divide="ignore"):
        ceilings = np.min(speeds / rates, axis=1)
        acceleration = float(np.min(efforts / rates))
    beside = Profile(float(ceilings.max()), min(profile.acceleration, acceleration), knots, ceilings)
    if not np.isfinite(beside.speed) and not np.isfinite(profile.speed):
        return profile
    lowered = _lower(profile, beside)
    return replace(lowered, acceleration=min(profile.acceleration, acceleration))


def _at_segment(marks: FloatArray, fault: MotionFault) -> BlockFault:
    """The fault with the segment on which it comes."""
    place = fault.fraction if fault.fraction is not None else 1.0
    return BlockFault(int(np.clip(np.searchsorted(marks, place) - 1, 0, len(marks) - 2)), fault)


def _profile(path: SplinePath, requests: Sequence[MoveRequest]) -> Profile:
    """Top speeds along the run: of each segment, of the turning tool, of tight places."""
    fractions, holders, bends = path.knots()
    if path.length_mm < SAME_MM:
        turn = max(float(np.rad2deg(path.turn_rad)), 1e-9)
        only = requests[-1]
        still = turn < 1e-6
        return Profile(
            np.inf if still else only.ori_speed_deg_s / turn, np.inf if still else only.ori_acc_deg_s2 / turn
        )
    poses = path.poses(fractions)[:, :3, :3]
    turns = np.rad2deg(rotation_angle(np.swapaxes(poses[:-1], 1, 2) @ poses[1:]))
    gaps = np.maximum(np.diff(fractions), 1e-12)
    each = {
        name: np.array([getattr(request, name) for request in requests])[holders]
        for name in ("path_speed_mm_s", "path_acc_mm_s2", "ori_speed_deg_s", "ori_acc_deg_s2")
    }
    rate = np.maximum(turns / gaps, 1e-9)
    with np.errstate(divide="ignore"):
        tight = np.sqrt(each["path_acc_mm_s2"] / bends)
    ceilings = np.minimum(np.minimum(each["path_speed_mm_s"], tight) / path.length_mm, each["ori_speed_deg_s"] / rate)
    acceleration = np.minimum(each["path_acc_mm_s2"] / path.length_mm, each["ori_acc_deg_s2"] / rate)
    return _of_ceilings(fractions, ceilings, float(acceleration.min()))


def _of_ceilings(fractions: FloatArray, ceilings: FloatArray, acceleration: float) -> Profile:
    top = float(ceilings.max())
    if float(ceilings.min()) >= top * (1.0 - 1e-9):
        return Profile(top, acceleration)
    return Profile(top, acceleration, fractions, ceilings)


def _lower(one: Profile, other: Profile) -> Profile:
    """The lower ceiling of two profiles everywhere."""
    if one.knots is None or one.ceilings is None:
        return replace(other, speed=min(one.speed, other.speed))
    if other.knots is None or other.ceilings is None:
        return replace(one, speed=min(one.speed, other.speed))
    knots = np.union1d(one.knots, other.knots)
    middle = 0.5 * (knots[:-1] + knots[1:])
    found = [
        each.ceilings[np.clip(np.searchsorted(each.knots, middle, side="right") - 1, 0, len(each.ceilings) - 1)]
        for each in (one, other)
        if each.knots is not None and each.ceilings is not None
    ]
    return replace(one, speed=min(one.speed, other.speed), knots=knots, ceilings=np.minimum(*found))


def _driven_by(request: MoveRequest, profile: Profile, joint: bool) -> Profile:
    """The profile with the ramps of the controller."""
    controller = request.controller
    ramp_s = (controller.joint_ramp_s if joint else controller.path_ramp_s) / request.effort
    ramp_s *= 0.5 * (1.0 + 1.0 / request.braking)
    smoothing_s = controller.joint_smoothing_s if joint else controller.path_smoothing_s
    acceleration = mean_acceleration(profile.acceleration, profile.acceleration * request.braking)
    if ramp_s > 0.0 and np.isfinite(profile.speed):
        acceleration = min(acceleration, of_constant_time(profile.speed, ramp_s))
    own = replace(profile, acceleration=acceleration, smoothing_s=smoothing_s)
    return own.braked(request.braking, request.stop_ramp)


# ---- joints


@dataclass(frozen=True, slots=True, eq=False)
class JointSpline:
    """Joints smoothly through several points: coefficients (m, n, 6) of pieces between the fractions `marks` (m+1,);
    the tool's way is measured at `knots` once."""

    model: RobotModel
    coefficients: FloatArray
    marks: FloatArray
    tool: FloatArray
    knots: FloatArray
    travelled: FloatArray

    def _at(self, fraction: FloatArray, coefficients: FloatArray) -> FloatArray:
        holder = np.clip(np.searchsorted(self.marks, fraction, side="right") - 1, 0, len(self.marks) - 2)
        u = (fraction - self.marks[holder]) / (self.marks[holder + 1] - self.marks[holder])
        chosen = coefficients[holder]
        value = chosen[..., -1]
        for power in range(chosen.shape[-1] - 2, -1, -1):
            value = value * u[..., None] + chosen[..., power]
        return np.asarray(value)

    def joints(self, fraction: FloatArray) -> FloatArray:
        return self._at(np.clip(fraction, 0.0, 1.0), self.coefficients)

    def rates(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """First and second derivatives (k, n) of the joints by the fraction."""
        spans = np.diff(self.marks)[:, None, None]
        first = _derivative(self.coefficients) / spans
        return self._at(fraction, first), self._at(fraction, _derivative(first) / spans)

    def tcp(self, fraction: FloatArray) -> FloatArray:
        return np.asarray(self.model.forward(self.joints(fraction)) @ self.tool)

    def distance(self, fraction: FloatArray) -> FloatArray:
        return np.interp(fraction, self.knots, self.travelled)

    def fraction_at(self, distance_mm: float) -> float:
        if self.travelled[-1] <= 0.0:
            return 0.0
        return float(np.interp(distance_mm, self.travelled, self.knots))


def _plan_joints(model: RobotModel, start: FloatArray, requests: Sequence[MoveRequest]) -> list[Run] | BlockFault:
    """M: the parameter between two points is the time that the slowest axis takes at its speed there."""
    points = [start]
    for number, request in enumerate(requests):
        goal = joint_target(model, points[-1], request)
        if isinstance(goal, MotionFault):
            return BlockFault(number, goal)
        points.append(goal)
    shares = [np.broadcast_to(request.joint_speed, start.shape) for request in requests]
    spans = [
        float(np.max(np.abs(b - a) / (model.speeds * share)))
        for a, b, share in zip(points, points[1:], shares, strict=False)
    ]
    kept = [number for number, span in enumerate(spans) if span > 1e-9]
    marks = np.cumsum([0.0, *spans])
    marks = marks / marks[-1] if marks[-1] > 0.0 else np.linspace(0.0, 1.0, len(marks))
    if not kept:
        flat = np.zeros((1, len(start), 6))
        flat[0, :, 0] = start
        still = JointSpline(model, flat, np.array([0.0, 1.0]), requests[-1].tool, np.array([0.0, 1.0]), np.zeros(2))
        move = finished(requests[-1], still, Profile(np.inf, np.inf))
        return [Run(move, tuple(float(mark) for mark in marks[1:]))]
    reached = [tuple(start.tolist()), *(tuple(points[number + 1].tolist()) for number in kept)]
    pieces = smooth_numbers(reached, [spans[number] for number in kept])
    bounds = np.append(marks[kept], 1.0)
    bare = JointSpline(model, np.array(pieces), bounds, requests[-1].tool, np.array([0.0, 1.0]), np.zeros(2))
    fine = np.unique(np.concatenate([np.linspace(a, b, _TABLE + 1) for a, b in pairwise(bounds)]))
    for joints, place in zip(bare.joints(fine), fine, strict=True):
        outside = model.within_limits(joints)
        if outside:
            low, high = model.limits[outside[0]]
            text = f"joint {outside[0] + 1} would be at {joints[outside[0]]:.3f}, outside {low:g}..{high:g}"
            return _at_segment(marks, MotionFault("joint_limit", text, outside[0], float(place)))
    way = np.linalg.norm(np.diff(bare.tcp(fine)[:, :3, 3], axis=0), axis=1)
    geometry = replace(bare, knots=fine, travelled=np.insert(np.cumsum(way), 0, 0.0))
    profile = _joint_profile(model, geometry, [shares[number] for number in kept], requests, kept)
    whole = _with_external(requests, marks)
    profile = _driven_by(whole, _beside(profile, whole, marks), joint=True)
    return [Run(finished(whole, geometry, profile), tuple(float(mark) for mark in marks[1:]))]


def _joint_profile(
    model: RobotModel,
    geometry: JointSpline,
    shares: Sequence[FloatArray],
    requests: Sequence[MoveRequest],
    kept: Sequence[int],
) -> Profile:
    """Ceilings from the speeds of the axes, and from half of their acceleration for what the curve bends (M)."""
    knots, ceilings, efforts = [np.zeros(1)], [], []
    for number, share in enumerate(shares):
        steps = np.linspace(geometry.marks[number], geometry.marks[number + 1], _CEILINGS + 1)
        inside = np.clip(steps, geometry.marks[number] + 1e-12, geometry.marks[number + 1] - 1e-12)
        rates, bends = geometry.rates(inside)
        effort = model.accelerations * requests[kept[number]].joint_acc
        with np.errstate(divide="ignore"):
            fast = np.min(model.speeds * share / np.abs(rates), axis=1)
            bent = np.sqrt(np.min(0.5 * effort / np.abs(bends), axis=1))
            efforts.append(np.min(effort / np.abs(rates), axis=1).min())
        each = np.minimum(fast, bent)
        knots.append(steps[1:])
        ceilings.append(np.minimum(each[1:], each[:-1]))
    return _of_ceilings(np.concatenate(knots), np.concatenate(ceilings), float(min(efforts)))


# ---- numbers


def _values(coefficients: FloatArray, u: FloatArray) -> FloatArray:
    """Polynomials with coefficients (3, m) at u (...) -> (..., 3)."""
    value = np.zeros((*u.shape, len(coefficients)))
    for power in range(coefficients.shape[-1] - 1, -1, -1):
        value = value * u[..., None] + coefficients[..., power]
    return value


def _derivative(coefficients: FloatArray) -> FloatArray:
    return np.asarray(coefficients[..., 1:] * np.arange(1, coefficients.shape[-1]))


def _hermite(x: FloatArray, knots: FloatArray, values: FloatArray, slopes: FloatArray) -> FloatArray:
    """The cubic through values with slopes at knots (k,), kept from turning back where a slope is very steep."""
    at = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, len(knots) - 2)
    gap = np.maximum(knots[at + 1] - knots[at], 1e-300)
    share = np.clip((x - knots[at]) / gap, 0.0, 1.0)
    way = values[at + 1] - values[at]
    first, last = (np.clip(slopes[at + k] * gap, 0.0, 3.0 * way) for k in (0, 1))
    bend = share * (1.0 - share) * ((1.0 - share) * (first - way) - share * (last - way))
    return np.asarray(values[at] + share * way + bend)


__all__ = ["BlockFault", "JointSpline", "Run", "SplinePath", "plan_block", "spline_path"]
