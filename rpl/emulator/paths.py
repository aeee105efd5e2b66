"""The shape that the tool centre point draws: straight lines and circular arcs, with their orientation.

A path gives poses of the tool centre point in the robot's base frame (mm) at fractions 0..1 of its way, evenly in
distance. It knows nothing of joints or of time. Orientation turns about one fixed axis (slerp) from start to end; along
an arc either in space or relative to the arc's tangent.
"""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.rotations import (
    FloatArray,
    matrix_to_rotation_vector,
    pose_matrix,
    rotation_angle,
    rotation_vector_to_matrix,
    turned,
)

# Three points whose triangle is flatter than this sine define no circle.
FLAT = 1e-6
_HALF_TURN = 1e-4  # rad: turns that near to half a turn have two ways
# What sums of numbers of four bytes leave of half a turn (rad). 179.9999 degrees are still a direction that is meant.
_SAME_HALF_TURN, _NO_PART = 1.5e-6, 1e-4


class Path(Protocol):
    """A curve of poses, evenly parametrised by the fraction of its length."""

    @property
    def length_mm(self) -> float:
        """Distance that the tool centre point travels."""

    @property
    def turn_rad(self) -> float:
        """Angle that the orientation turns by, as far as the orientation speed has to pay for it."""

    def poses(self, fraction: ArrayLike) -> FloatArray:
        """Poses (k, 4, 4) at fractions (k,)."""

    def tangent(self, fraction: float) -> FloatArray:
        """Change of position (3,) per fraction, mm."""


def _shortest_turn(first: FloatArray, last: FloatArray) -> FloatArray:
    """Rotation vector (3,) in radians of the shortest turn between two rotations (3, 3), in the frame of the first. Of
    the two ways of half a turn the one whose axis leads with a positive component, whatever rounding leaves of it."""
    turn = matrix_to_rotation_vector(first.T @ last)
    angle = float(np.linalg.norm(turn))
    if angle > np.pi - _SAME_HALF_TURN and turn[np.abs(turn) > _NO_PART][0] < 0.0:
        turn = turn * (1.0 - 2.0 * np.pi / angle)
    return np.asarray(turn)


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """Straight from one pose (4, 4) to another."""

    start: FloatArray
    end: FloatArray
    turn: FloatArray = field(init=False)  # rotation vector from start to end, in the start's frame, radians

    def __post_init__(self) -> None:
        object.__setattr__(self, "turn", _shortest_turn(self.start[:3, :3], self.end[:3, :3]))

    @property
    def length_mm(self) -> float:
        return float(np.linalg.norm(self.end[:3, 3] - self.start[:3, 3]))

    @property
    def turn_rad(self) -> float:
        return float(np.linalg.norm(self.turn))

    def poses(self, fraction: ArrayLike) -> FloatArray:
        s = np.asarray(fraction, dtype=np.float64)
        position = self.start[:3, 3] + s[..., None] * (self.end[:3, 3] - self.start[:3, 3])
        return pose_matrix(position, turned(self.start[:3, :3], self.turn, s))

    def tangent(self, fraction: float) -> FloatArray:
        del fraction
        return np.asarray(self.end[:3, 3] - self.start[:3, 3])


@dataclass(frozen=True, slots=True, eq=False)
class Arc:
    """Part of a circle, from `start` (4, 4) about `axis` (unit, 3) through `centre` (mm, 3) by `sweep_rad` > 0.

    `end_rotation` (3, 3) is reached at the end of the sweep. With `follow_path` the orientation is interpolated
    relative to the arc's moving tangent frame, so that it turns with the circle.
    """

    start: FloatArray
    end_rotation: FloatArray
    centre: FloatArray
    axis: FloatArray
    sweep_rad: float
    follow_path: bool

    @property
    def radius_mm(self) -> float:
        return float(np.linalg.norm(self.start[:3, 3] - self.centre))

    @property
    def length_mm(self) -> float:
        return self.radius_mm * self.sweep_rad

    @property
    def turn_rad(self) -> float:
        """How far the tool turns: with the circle and against it at once where it follows the path, so not at all
        where it stays as it is. The two speeds keep their angle to each other, so that their sum is even."""
        if not self.follow_path:
            return float(rotation_angle(self.start[:3, :3].T @ self._goal()))
        return float(np.linalg.norm(self.sweep_rad * self.axis + self.start[:3, :3] @ self._own_turn()))

    def _goal(self) -> FloatArray:
        if not self.follow_path:
            return self.end_rotation
        return np.asarray(rotation_vector_to_matrix(self.axis * self.sweep_rad).T @ self.end_rotation)

    def poses(self, fraction: ArrayLike) -> FloatArray:
        s = np.asarray(fraction, dtype=np.float64)
        around = turned(np.eye(3), self.sweep_rad * self.axis, s)
        position = self.centre + around @ (self.start[:3, 3] - self.centre)
        if not self.follow_path:
            first = self.start[:3, :3]
            return pose_matrix(position, turned(first, _shortest_turn(first, self._goal()), s))
        return pose_matrix(position, around @ self._against_arc(s))

    def _own_turn(self) -> FloatArray:
        """Rotation vector relative to the tangent frame. Half a turn against it (a half circle with equal orientations
        at both ends) has two equal ways: the one that turns the tool back, not round once more, is taken."""
        first = self.start[:3, :3]
        turn = matrix_to_rotation_vector(first.T @ self._goal())
        angle = float(np.linalg.norm(turn))
        with_arc = float((first @ turn) @ self.axis) > 0.0
        if with_arc and angle > np.pi - _HALF_TURN:
            turn = turn * (1.0 - 2.0 * np.pi / angle)
        return np.asarray(turn)

    def _against_arc(self, s: FloatArray) -> FloatArray:
        """Rotations relative to the tangent frame."""
        return turned(self.start[:3, :3], self._own_turn(), s)

    def tangent(self, fraction: float) -> FloatArray:
        around = rotation_vector_to_matrix(fraction * self.sweep_rad * self.axis)
        return np.asarray(self.sweep_rad * np.cross(self.axis, around @ (self.start[:3, 3] - self.centre)))


def arc_through(
    start: FloatArray,
    via: FloatArray,
    end: FloatArray,
    *,
    swept_deg: float | None = None,
    constant_orientation: bool = False,
    follow_path: bool = False,
) -> Arc | None:
    """The arc from `start` over `via` to `end` (poses, 4x4); None when the three points define no circle.

    `swept_deg` replaces the sweep that ends at `end`: then `end` only fixes the circle and the orientation that is
    reached at the end of the sweep. Its sign reverses the direction and it may exceed 360.
    """
    a, b = via[:3, 3] - start[:3, 3], end[:3, 3] - start[:3, 3]
    normal = np.cross(a, b)
    area = float(np.linalg.norm(normal))
    if area <= FLAT * float(np.linalg.norm(a)) * float(np.linalg.norm(b)) or area < 1e-9:
        return None
    # Circumcentre of a triangle with one corner at the origin.
    square = float(normal @ normal)
    to_centre = np.cross(a @ a * b - b @ b * a, np.cross(a, b)) / (2.0 * square)
    axis = normal / area
    radial = -to_centre
    toward_end = b - to_centre
    sweep = float(np.arctan2(axis @ np.cross(radial, toward_end), radial @ toward_end)) % (2.0 * np.pi)
    if swept_deg is not None:
        if swept_deg == 0.0:
            return None
        sweep = abs(float(np.deg2rad(swept_deg)))
        axis = axis if swept_deg > 0.0 else -axis
    turned = rotation_vector_to_matrix(axis * sweep) if follow_path else np.eye(3)
    rotation = turned @ start[:3, :3] if constant_orientation else end[:3, :3]
    return Arc(start, rotation, start[:3, 3] + to_centre, axis, sweep, follow_path)
