"""Where a mechanism carries what stands on it, and moves whose frame, robot or tool does not stand still.

`mechanism_pose` is the forward kinematics of a track, turn-table or positioner over the external axes. A `Carrier` says
how the pose of a tool *in its work* makes a pose of the flange; the work is the part or the fixture that the path
belongs to: on a turn-table, on the robot's own flange (the tool then stands in the room), or in the world when the
robot rides on a track. A path planned in the work and carried over to the flange is exact all along, in position and
orientation, however the axes below it move.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.mechanismfile import Mechanism
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix, rotation_vector_to_matrix, zyx_to_matrix

_SAME = 1e-9


def mechanism_pose(mechanism: Mechanism, external: ArrayLike) -> FloatArray:
    """Poses (..., 4, 4) of what the mechanism carries, mm, in what its root is given in; external axes (..., e) in
    their own units (mm or degrees), axes that are not there counting as zero."""
    values = np.asarray(external, dtype=np.float64)
    pose = np.broadcast_to(_six(mechanism.root), (*values.shape[:-1], 4, 4))
    for axis in mechanism.axes:
        there = axis.number <= values.shape[-1]
        way = axis.pitch * (values[..., axis.number - 1] if there else np.zeros(values.shape[:-1]))
        direction = np.array(axis.direction)
        if axis.sliding:
            moved = pose_matrix(way[..., None] * direction)
        else:
            moved = pose_matrix(np.zeros(3), rotation_vector_to_matrix(np.deg2rad(way)[..., None] * direction))
        pose = pose @ _six(axis.place) @ moved
    return np.asarray(pose @ _six(mechanism.flange))


def _six(values: tuple[float, ...]) -> FloatArray:
    return pose_matrix(np.array(values[:3]), zyx_to_matrix(np.array(values[3:])))


@dataclass(frozen=True, slots=True, eq=False)
class Carrier:
    """How the tool's pose in its work makes the flange's pose in the robot's base.

    The robot holds the tool: flange = root(e)^-1 · mount(e) · pose · tool^-1. With `stationary`, the robot holds the
    work, and the tool is fixed in the room: flange = root(e)^-1 · tool · pose^-1. root(e) is the robot's base in the
    world (`root` on what `rides` it), mount(e) what carries the work (`mount`; the world without one).
    """

    tool: FloatArray
    root: FloatArray
    stationary: bool = False
    rides: Mechanism | None = None
    mount: Mechanism | None = None

    def _work(self, external: FloatArray) -> FloatArray:
        """What carries the work, or the fixed tool, in the robot's base at external axes (k, e)."""
        root = self.root if self.rides is None else mechanism_pose(self.rides, external) @ self.root
        back = np.broadcast_to(invert_pose(root), (*external.shape[:-1], 4, 4))
        if self.stationary:
            return np.asarray(back @ self.tool)
        if self.mount is None:
            return back
        place = mechanism_pose(self.mount, external)
        return place if self.mount.on_robot else np.asarray(back @ place)

    def flanges(self, work: FloatArray, external: FloatArray) -> FloatArray:
        """Flange poses (k, 4, 4) in the robot's base of tool poses in the work (k, 4, 4)."""
        if self.stationary:
            return np.asarray(self._work(external) @ invert_pose(work))
        return np.asarray(self._work(external) @ work @ invert_pose(self.tool))

    def in_work(self, flanges: FloatArray, external: FloatArray) -> FloatArray:
        """Tool poses (k, 4, 4) in the work of flange poses in the robot's base."""
        if self.stationary:
            return np.asarray(invert_pose(flanges) @ self._work(external))
        return np.asarray(invert_pose(self._work(external)) @ flanges @ self.tool)

    def same_work(self, other: Carrier) -> bool:
        """Do both move in one and the same work?"""
        return (
            self.stationary == other.stationary
            and self.rides == other.rides
            and self.mount == other.mount
            and bool(np.abs(self.root - other.root).max() < _SAME)
            and bool(np.abs(self.tool - other.tool).max() < _SAME)
        )


@dataclass(frozen=True, slots=True, eq=False)
class ExternalWay:
    """External axes smoothly through several points: coefficients (m, e, 6) over 0..1 of the pieces between the
    fractions `marks` (m+1,) of a move."""

    coefficients: FloatArray
    marks: FloatArray

    def at(self, fraction: FloatArray) -> FloatArray:
        """External axes (..., e) at fractions (...)."""
        s = np.asarray(fraction, dtype=np.float64)
        holder = np.clip(np.searchsorted(self.marks, s, side="right") - 1, 0, len(self.marks) - 2)
        u = (s - self.marks[holder]) / (self.marks[holder + 1] - self.marks[holder])
        chosen = self.coefficients[holder]
        value = chosen[..., -1]
        for power in range(chosen.shape[-1] - 2, -1, -1):
            value = value * u[..., None] + chosen[..., power]
        return np.asarray(value)


@dataclass(frozen=True, slots=True, eq=False)
class Carried:
    """A carrier while external axes go from the first to the last of the `control` points (m, e): evenly with two, on
    the parabola with three, on the cubic with four; or as `way` says."""

    carrier: Carrier
    control: FloatArray
    way: ExternalWay | None = None

    def external(self, fraction: FloatArray) -> FloatArray:
        """External axes (k, e) at fractions (k,) of the move."""
        return along(self.control, fraction) if self.way is None else self.way.at(fraction)

    def flanges(self, work: FloatArray, fraction: FloatArray) -> FloatArray:
        """Flange poses (k, 4, 4) of tool poses in the work at fractions (k,)."""
        return self.carrier.flanges(work, self.external(fraction))

    def in_work(self, flanges: FloatArray, fraction: FloatArray) -> FloatArray:
        """Tool poses (k, 4, 4) in the work of flange poses at fractions (k,)."""
        return self.carrier.in_work(flanges, self.external(fraction))


def along(control: FloatArray, fraction: FloatArray) -> FloatArray:
    """Points (..., e) at fractions (...) on the line (two control points), parabola (three) or cubic (four)."""
    s = np.asarray(fraction, dtype=np.float64)[..., None]
    row = list(control)
    while len(row) > 1:
        row = [np.asarray(a + s * (b - a)) for a, b in pairwise(row)]
    return np.asarray(row[0])
