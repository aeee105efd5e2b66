"""The curves of corners between two paths.

The tool centre point follows a cubic that leaves and meets the two paths along their tangents. Orientation follows the
analogous curve of rotations. Where a controller lets the tool begin to turn towards the next target before its centre
point leaves the path (an extended zone), a corner is wider than its cubic: its ends lie on the two paths themselves.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.paths import Path
from rpl.emulator.rotations import (
    FloatArray,
    matrix_to_rotation_vector,
    pose_matrix,
    rotation_vector_to_matrix,
    turned,
)

# In how many places the way along a corner is measured.
WAYS = 32
# Entries of rotation matrices that differ by less are one.
_SAME = 1e-15


@dataclass(frozen=True, slots=True, eq=False)
class BezierPath:
    """Poses on a cubic through four control positions (4, 3), orientation on the curve of three rotations (3, 3, 3), or
    of four.

    `share`: of the way to the corner point, where the inner control positions lie. `ways` (k,): of the whole length at
    k even places of the curve, where its fraction is the way along it; None: it is the curve's own parameter.
    """

    positions: FloatArray
    rotations: FloatArray
    share: float = 2.0 / 3.0
    ways: FloatArray | None = None

    def evenly(self) -> "BezierPath":
        """The same curve, its fraction in proportion to the way of the tool centre point."""
        speeds = np.linalg.norm(self._velocity(np.linspace(0.0, 1.0, 2 * WAYS + 1)), axis=1)
        if speeds.min() <= 1e-9:
            return self
        steps = (speeds[:-2:2] + 4.0 * speeds[1::2] + speeds[2::2]) / (6.0 * WAYS)
        ways = np.insert(np.cumsum(steps), 0, 0.0)
        p = self.positions
        sizes = [float(np.linalg.norm(p[i + 1] - p[i])) / self.share for i in (0, 2)]
        handles = handle_of(float(ways[-1]), sizes[0]), handle_of(float(ways[-1]), sizes[1])
        return replace(self, ways=ways / ways[-1], rotations=steered(self.rotations, handles))

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
        return turn_of(self.rotations)

    def _points(self, u: FloatArray) -> FloatArray:
        s, w = u[..., None], 1.0 - u[..., None]
        p = self.positions
        return np.asarray(w**3 * p[0] + 3 * w * w * s * p[1] + 3 * w * s * s * p[2] + s**3 * p[3])

    def poses(self, fraction: ArrayLike) -> FloatArray:
        s = np.asarray(fraction, dtype=np.float64)
        return pose_matrix(self._points(self._parameter(s)), turned_along(self.rotations, s))

    def tangent(self, fraction: float) -> FloatArray:
        way = self._velocity(self._parameter(np.array([fraction])))[0]
        return way if self.ways is None else np.asarray(way * self._length() / np.linalg.norm(way))

    def _velocity(self, u: FloatArray) -> FloatArray:
        p, s, w = self.positions, u[..., None], 1.0 - u[..., None]
        return np.asarray(3 * (w * w * (p[1] - p[0]) + 2 * w * s * (p[2] - p[1]) + s * s * (p[3] - p[2])))


@dataclass(frozen=True, slots=True, eq=False)
class WideCorner:
    """A corner with an extended zone: along the first path, the cubic, along the second path, evenly by the way.

    `leave`, `meet`: fractions of the two paths at its ends; `out`, `into`: where the cubic leaves and meets them. The
    tool turns all along, on the curve of four `rotations` (4, 3, 3).
    """

    first: Path
    second: Path
    inner: BezierPath
    leave: float
    out: float
    into: float
    meet: float
    rotations: FloatArray

    @property
    def ways(self) -> tuple[float, float]:
        """Where the cubic begins and ends, mm from the beginning of the corner."""
        before = self.first.length_mm * (self.out - self.leave)
        return before, before + self.inner.length_mm

    @property
    def length_mm(self) -> float:
        return self.ways[1] + self.second.length_mm * (self.meet - self.into)

    @property
    def turn_rad(self) -> float:
        return turn_of(self.rotations)

    def poses(self, fraction: ArrayLike) -> FloatArray:
        s = np.asarray(fraction, dtype=np.float64)
        way, (begin, end) = s * self.length_mm, self.ways
        on_first = self.first.poses(self.leave + np.minimum(way, begin) / self.first.length_mm)[..., :3, 3]
        inside = self.inner.poses(np.clip((way - begin) / (end - begin), 0.0, 1.0))[..., :3, 3]
        on_second = self.second.poses(self.into + np.maximum(way - end, 0.0) / self.second.length_mm)[..., :3, 3]
        before, behind = (way < begin)[..., None], (way > end)[..., None]
        return pose_matrix(
            np.where(before, on_first, np.where(behind, on_second, inside)), turned_along(self.rotations, s)
        )

    def tangent(self, fraction: float) -> FloatArray:
        way, (begin, end) = fraction * self.length_mm, self.ways
        if way < begin:
            along = self.first.tangent(self.leave + way / self.first.length_mm)
        elif way > end:
            along = self.second.tangent(self.into + (way - end) / self.second.length_mm)
        else:
            along = self.inner.tangent((way - begin) / (end - begin))
        return np.asarray(along * self.length_mm / np.linalg.norm(along))


CornerPath = BezierPath | WideCorner


def is_even(path: Path) -> bool:
    """Is the fraction of a corner in proportion to the way of the tool?"""
    return isinstance(path, WideCorner) or (isinstance(path, BezierPath) and path.ways is not None)


def path_corner(first: Path, second: Path, leave: float, meet: float, share: float) -> BezierPath:
    """The cubic that leaves and meets two paths along their tangents; between straight lines a `share` of two thirds is
    the parabola."""
    start, goal = first.poses(np.array([leave, 1.0]))
    end = second.poses(np.array([meet]))[0]
    out = first.tangent(leave) * (1.0 - leave) * share
    into = second.tangent(meet) * meet * share
    positions = np.stack([start[:3, 3], start[:3, 3] + out, end[:3, 3] - into, end[:3, 3]])
    return BezierPath(positions, np.stack([start[:3, :3], goal[:3, :3], end[:3, :3]]), share)


def wide_corner(
    first: Path, second: Path, outer: tuple[float, float], inner: tuple[float, float], share: float
) -> WideCorner:
    """The corner whose cubic lies between the `inner` fractions of the two paths and whose tool turns between the
    `outer` ones."""
    curve = path_corner(first, second, *inner, share).evenly()
    start, goal = first.poses(np.array([outer[0], 1.0]))
    end = second.poses(np.array([outer[1]]))[0]
    rotations = np.stack([start[:3, :3], goal[:3, :3], end[:3, :3]])
    made = WideCorner(first, second, curve, outer[0], inner[0], inner[1], outer[1], rotations)
    sizes = first.length_mm * (1.0 - outer[0]), second.length_mm * outer[1]
    handles = handle_of(made.length_mm, sizes[0]), handle_of(made.length_mm, sizes[1])
    return replace(made, rotations=steered(rotations, handles))


# ---- curves of rotations


def handle_of(length_mm: float, size_mm: float) -> float:
    """How far towards the corner's value the inner control points of what goes with an even way lie, as a share: so
    that it leaves and meets the two moves as fast as it changes on them."""
    return length_mm / (3.0 * size_mm)


def steered(rotations: FloatArray, handles: tuple[float, float]) -> FloatArray:
    """Four control rotations (4, 3, 3) out of start, corner and end (3, 3, 3)."""
    start, corner, end = rotations
    out = start @ rotation_vector_to_matrix(handles[0] * matrix_to_rotation_vector(start.T @ corner))
    into = end @ rotation_vector_to_matrix(handles[1] * matrix_to_rotation_vector(end.T @ corner))
    return np.stack([start, out, into, end])


def turned_along(rotations: FloatArray, fraction: FloatArray) -> FloatArray:
    """De Casteljau on rotations (m, 3, 3): tangent to the first turn at fraction 0 and to the last at 1."""
    if np.abs(rotations - rotations[0]).max() < _SAME:
        return np.broadcast_to(rotations[0], (*np.shape(fraction), 3, 3))
    turns = matrix_to_rotation_vector(np.swapaxes(rotations[:-1], 1, 2) @ rotations[1:])
    row = [turned(a, turn, fraction) for a, turn in zip(rotations, turns, strict=False)]
    share = fraction[..., None]
    while len(row) > 1:
        between = [matrix_to_rotation_vector(np.swapaxes(a, -1, -2) @ b) for a, b in pairwise(row)]
        row = [a @ rotation_vector_to_matrix(share * turn) for a, turn in zip(row, between, strict=False)]
    return np.asarray(row[0])


def turn_of(rotations: FloatArray) -> float:
    """The angle that the curve of rotations turns by, rad."""
    steps = turned_along(rotations, np.linspace(0.0, 1.0, 9))
    between = np.swapaxes(steps[:-1], 1, 2) @ steps[1:]
    return float(np.linalg.norm(matrix_to_rotation_vector(between), axis=1).sum())
