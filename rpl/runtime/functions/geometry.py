"""Neutral functions on poses beyond products and offsets: component-wise sums, displaced targets, rotation vectors, ZYZ
angles, interpolation. Millimetres and degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import (
    AxesValue,
    ExternalValue,
    JointsValue,
    PoseValue,
    RotationValue,
    TargetValue,
    Value,
    VectorValue,
    needed,
    pose_of,
    rotation_of,
    used_axes,
    vector_of,
)


def as_pose(value: Value) -> PoseValue:
    """The pose of a pose or a target."""
    if isinstance(value, TargetValue):
        return value.pose
    if isinstance(value, PoseValue):
        return value
    raise ProgramError("no_value" if value is None else "wrong_kind", "a pose is needed here")


# ---- component by component


def _element_wise(sign: float) -> Callable[[Value, Value], Value]:
    def combined(one: Value, two: Value) -> Value:
        if isinstance(one, JointsValue) and isinstance(two, JointsValue):
            axes = AxesValue(_numbers(one.axes.values, two.axes.values, sign))
            return JointsValue(axes, _external(one.ext, two.ext, sign))
        if isinstance(one, VectorValue) and isinstance(two, VectorValue):
            return VectorValue(*_numbers(one, two, sign))
        first, second = as_pose(one), as_pose(two)
        place = VectorValue(*_numbers(first.trans, second.trans, sign))
        angles = _numbers(_zyx(first.rot), _zyx(second.rot), sign)
        turn = RotationValue("zyx", angles)
        if first.rot.convention != "zyx":
            turn = rotation_of(turn.rigid(), first.rot.convention)
        pose = PoseValue(place, turn)
        if isinstance(one, TargetValue):
            other = two.ext if isinstance(two, TargetValue) else ExternalValue((None,) * 6)
            return one._replace(pose=pose, ext=_external(one.ext, other, sign))
        return pose

    return combined


def _zyx(turn: RotationValue) -> tuple[float | None, ...]:
    """The angles as they are written, else those of the rotation."""
    return turn.parts if turn.convention == "zyx" else turn.rigid().zyx


def _numbers(one: tuple[float | None, ...], two: tuple[float | None, ...], sign: float) -> tuple[float, ...]:
    return tuple(p + sign * q for p, q in zip(needed(one), needed(two), strict=True))


def _external(one: ExternalValue, two: ExternalValue, sign: float) -> ExternalValue:
    """External axes that either value leaves unused stay as the first has them."""
    pairs = zip(one.values, used_axes(one.values), used_axes(two.values), strict=True)
    return ExternalValue(tuple(kept if p is None or q is None else p + sign * q for kept, p, q in pairs))


# ---- targets displaced by a pose


def _moved(value: Value, pose: rigid.Pose) -> Value:
    given = as_pose(value)
    done = pose_of(pose, given.rot.convention)
    return value._replace(pose=done) if isinstance(value, TargetValue) else done


def _displaced(value: Value, by: Value) -> Value:
    return _moved(value, as_pose(by).rigid().then(as_pose(value).rigid()))


def _displaced_in_tool(value: Value, by: Value) -> Value:
    return _moved(value, as_pose(value).rigid().then(as_pose(by).rigid()))


# ---- rotation vectors (URScript)


def rotation_vector(turn: rigid.Rotation) -> rigid.Triple:
    """Axis times angle in degrees, the angle in [0, 180]."""
    w, x, y, z = turn.quaternion
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < 1e-15:
        return 0.0, 0.0, 0.0
    factor = math.degrees(2.0 * math.atan2(sine, w)) / sine
    return rigid.clean(x * factor), rigid.clean(y * factor), rigid.clean(z * factor)


def rotation_of_vector(rx: float, ry: float, rz: float) -> rigid.Rotation:
    """The rotation about the vector (degrees) by its length."""
    angle = math.sqrt(rx * rx + ry * ry + rz * rz)
    if angle == 0.0:
        return rigid.NO_TURN
    half = math.radians(angle / 2.0)
    factor = math.sin(half) / angle
    found = rigid.rotation_of_quaternion(math.cos(half), rx * factor, ry * factor, rz * factor)
    return found if found is not None else rigid.NO_TURN


def _vector_part(place: int) -> Callable[[RotationValue], float]:
    return lambda turn: rotation_vector(turn.rigid())[place]


def _from_rotation_vector(x: float, y: float, z: float, rx: float, ry: float, rz: float) -> PoseValue:
    return PoseValue(VectorValue(x, y, z), rotation_of(rotation_of_vector(rx, ry, rz), "quaternion"))


# ---- angles about z, new y, new z (V+)


def zyz_angles(turn: rigid.Rotation) -> rigid.Triple:
    """Yaw, pitch, roll of Rz(yaw)·Ry(pitch)·Rz(roll); pitch in [0, 180]. At pitch 0 and 180 yaw is 0."""
    (_, xy, xz), (_, yy, yz), (zx, zy, zz) = turn.rows
    sine = math.hypot(xz, yz)
    if sine < 1e-9:
        down = zz < 0.0
        return 0.0, 180.0 if down else 0.0, rigid.angle_of(xy if down else -xy, yy)
    return rigid.angle_of(yz, xz), rigid.angle_of(sine, zz), rigid.angle_of(zy, -zx)


def rotation_of_zyz(yaw: float, pitch: float, roll: float) -> rigid.Rotation:
    """Rz(yaw)·Ry(pitch)·Rz(roll) of angles in degrees."""
    about_z, about_y = rigid.rotation_of_zyx(yaw, 0.0, 0.0), rigid.rotation_of_zyx(0.0, pitch, 0.0)
    return about_z.then(about_y).then(rigid.rotation_of_zyx(roll, 0.0, 0.0))


def _pose_zyz(x: float, y: float, z: float, yaw: float, pitch: float, roll: float) -> PoseValue:
    return PoseValue(VectorValue(x, y, z), rotation_of(rotation_of_zyz(yaw, pitch, roll), "quaternion"))


def _zyz_part(place: int) -> Callable[[Value], float]:
    return lambda value: zyz_angles(as_pose(value).rot.rigid())[place]


# ---- between two poses


def _interpolated(start: Value, end: Value, share: float) -> PoseValue:
    """Straight in position, at even speed about one axis in rotation."""
    first, second = as_pose(start), as_pose(end)
    one, two = first.rigid(), second.rigid()
    way = two.position.plus(one.position, -1.0)
    rx, ry, rz = rotation_vector(one.rotation.inverse.then(two.rotation))
    turn = one.rotation.then(rotation_of_vector(rx * share, ry * share, rz * share))
    return PoseValue(vector_of(one.position.plus(way, share)), rotation_of(turn, first.rot.convention))


def _angle_between(one: Value, two: Value) -> float:
    turn = as_pose(one).rot.rigid().inverse.then(as_pose(two).rot.rigid())
    return math.hypot(*rotation_vector(turn))


def _aligned(value: Value) -> PoseValue:
    """The pose turned by as little as it takes to lay its z axis along an axis of its frame."""
    pose = as_pose(value)
    here = pose.rigid()
    z = here.rotation.turn(rigid.Vector(0.0, 0.0, 1.0))
    parts = (z.x, z.y, z.z)
    longest = max(range(3), key=lambda axis: round(abs(parts[axis]), 9))  # of equals the first
    goal = rigid.Vector(*(math.copysign(1.0, parts[axis]) if axis == longest else 0.0 for axis in range(3)))
    across = z.cross(goal)
    angle = math.degrees(math.atan2(across.length, z.dot(goal)))
    if across.length < 1e-12:
        return pose
    about = across.times(angle / across.length)
    turn = rotation_of_vector(about.x, about.y, about.z).then(here.rotation)
    return PoseValue(pose.trans, rotation_of(turn, pose.rot.convention))


PURE: dict[str, Callable[..., Value]] = {
    "aligned": _aligned,
    "element_sum": _element_wise(1.0),
    "element_difference": _element_wise(-1.0),
    "displaced": _displaced,
    "displaced_in_tool": _displaced_in_tool,
    "rotation_vector_x": _vector_part(0),
    "rotation_vector_y": _vector_part(1),
    "rotation_vector_z": _vector_part(2),
    "pose_from_rotation_vector": _from_rotation_vector,
    "pose_zyz": _pose_zyz,
    "zyz_yaw": _zyz_part(0),
    "zyz_pitch": _zyz_part(1),
    "zyz_roll": _zyz_part(2),
    "interpolate_pose": _interpolated,
    "rotation_angle": _angle_between,
}
