"""Comparing the ways of two tools: by the length they have travelled, not by time, so that speed does not matter here.

A way is a polyline of poses. Its measure is the path length in mm plus the turning weighted as if it happened at a
lever of TURN_LEVER_MM, so that a turn on the spot has a length too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

TURN_LEVER_MM = 100.0
_POINTS = 65
_STEPS, _NEAR = 5, 0.1  # how far from a rotation (as the worst element of R^T R - 1) and how often steps are taken


@dataclass(frozen=True, slots=True)
class Gap:
    """The greatest distance of two ways: mm and degrees, and where: the position on both ways there (xyz mm)."""

    mm: float
    deg: float
    a: tuple[float, float, float]
    b: tuple[float, float, float]


def turn_deg(first: FloatArray, second: FloatArray) -> FloatArray:
    """Angle between rotations (..., 3, 3), degrees; exact for small angles too."""
    apart = np.swapaxes(first, -1, -2) @ second
    axis = np.stack(
        [
            apart[..., 2, 1] - apart[..., 1, 2],
            apart[..., 0, 2] - apart[..., 2, 0],
            apart[..., 1, 0] - apart[..., 0, 1],
        ],
        axis=-1,
    )
    sine = np.linalg.norm(axis, axis=-1) / 2.0
    cosine = (np.trace(apart, axis1=-2, axis2=-1) - 1.0) / 2.0
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))


def measure(poses: FloatArray) -> FloatArray:
    """Measure (k,) along a way (k, 4, 4), starting with 0."""
    way = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
    turn = np.radians(turn_deg(poses[:-1, :3, :3], poses[1:, :3, :3])) * TURN_LEVER_MM
    return np.concatenate([[0.0], np.cumsum(np.hypot(way, turn))])


def length_mm(poses: FloatArray) -> float:
    """Length of the way of the tool centre point."""
    return float(np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).sum())


def _sampled(poses: FloatArray, shares: FloatArray) -> FloatArray:
    """The way at shares (m,) of its measure. Rotations are averaged linearly, which small steps allow."""
    along = measure(poses)
    if along[-1] <= 0.0 or len(poses) < 2:
        return np.repeat(poses[-1:], len(shares), axis=0)
    where = shares * along[-1]
    right = np.clip(np.searchsorted(along, where), 1, len(along) - 1)
    step = along[right] - along[right - 1]
    share = np.where(step > 0.0, (where - along[right - 1]) / np.where(step > 0.0, step, 1.0), 1.0)
    return np.asarray(poses[right - 1] + share[:, None, None] * (poses[right] - poses[right - 1]))


def _upright(rotations: FloatArray) -> FloatArray:
    """The nearest rotations to averaged ones: by Newton's steps where they are near, else by singular values."""
    identity = np.eye(3)
    found = rotations
    for _ in range(_STEPS):
        excess = found.swapaxes(-1, -2) @ found - identity
        worst = float(np.abs(excess).max(initial=0.0))
        if worst > _NEAR:
            break
        if worst < 1e-13:
            return np.asarray(found)
        found = found @ (identity - 0.5 * excess)
    left, _, right = np.linalg.svd(rotations)
    return np.asarray(left @ right)


def gap(first: FloatArray, second: FloatArray) -> Gap:
    """The greatest distance of two ways (k, 4, 4) and (m, 4, 4), compared at equal shares of their measure."""
    count = max(_POINTS, len(first), len(second))
    shares = np.linspace(0.0, 1.0, count)
    a, b = _sampled(first, shares), _sampled(second, shares)
    apart = np.linalg.norm(a[:, :3, 3] - b[:, :3, 3], axis=1)
    turned = turn_deg(_upright(a[:, :3, :3]), _upright(b[:, :3, :3]))
    worst = int(np.argmax(apart + turned))
    point_a, point_b = a[worst, :3, 3], b[worst, :3, 3]
    return Gap(
        float(apart.max()),
        float(turned.max()),
        (float(point_a[0]), float(point_a[1]), float(point_a[2])),
        (float(point_b[0]), float(point_b[1]), float(point_b[2])),
    )
