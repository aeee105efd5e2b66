"""Neutral functions on arcs and on positions as lists of numbers. Millimetres and degrees."""

from __future__ import annotations

import math
from collections.abc import Callable

from rpl.passes import rigid
from rpl.runtime.functions.geometry import PURE as GEOMETRY
from rpl.runtime.functions.geometry import as_pose
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
    rotation_of,
    vector_of,
)

# Points closer to one line than this (mm, as the height of their triangle) have no circle through them.
STRAIGHT_MM = 1e-6


def _product(value: Value, factor: Value) -> Value:
    """Each component times a number: x, y, z and the ZYX angles of a pose, or every joint."""
    scale = float(factor)
    if isinstance(value, JointsValue):
        axes = AxesValue(tuple(None if each is None else each * scale for each in value.axes.values))
        return JointsValue(axes, ExternalValue(tuple(None if e is None else e * scale for e in value.ext.values)))
    pose = as_pose(value)
    place = VectorValue(*(each * scale for each in needed(pose.trans)))
    parts = needed(pose.rot.parts) if pose.rot.convention == "zyx" else list(pose.rot.rigid().zyx)
    turn = RotationValue("zyx", tuple(each * scale for each in parts))
    if pose.rot.convention != "zyx":
        turn = rotation_of(turn.rigid(), pose.rot.convention)
    done = PoseValue(place, turn)
    return value._replace(pose=done) if isinstance(value, TargetValue) else done


def _arc_middle(other: Value, start: Value, end: Value) -> Value:
    """Halfway from `start` to `end` on the circle through all three, on the side where `other` is not; the rotation is
    halfway too. Points on one line give the middle of the line."""
    middle = GEOMETRY["interpolate_pose"](start, end, 0.5)
    a, b, c = (rigid.Vector(*needed(as_pose(point).trans)) for point in (other, start, end))
    place = _on_circle(a, b, c)
    pose = PoseValue(middle.trans if place is None else vector_of(place), middle.rot)
    return end._replace(pose=pose) if isinstance(end, TargetValue) else pose


def _on_circle(a: rigid.Vector, b: rigid.Vector, c: rigid.Vector) -> rigid.Vector | None:
    one, two = b.plus(a, -1.0), c.plus(a, -1.0)
    normal = one.cross(two)
    longest = max(one.length, two.length, c.plus(b, -1.0).length)
    if longest == 0.0 or normal.length / longest < STRAIGHT_MM:
        return None
    # centre of the circle through three points, from a
    weight = 1.0 / (2.0 * normal.dot(normal))
    lift = normal.cross(one).times(two.dot(two)).plus(two.cross(normal).times(one.dot(one)))
    centre = a.plus(lift.times(weight))
    axis = normal.times(1.0 / normal.length)
    first = b.plus(centre, -1.0)
    last = c.plus(centre, -1.0)
    angle = math.atan2(axis.dot(first.cross(last)), first.dot(last)) % (2.0 * math.pi)
    half = angle / 2.0
    return centre.plus(first.times(math.cos(half))).plus(axis.cross(first).times(math.sin(half)))


PURE: dict[str, Callable[..., Value]] = {"element_product": _product, "arc_middle": _arc_middle}
