"""Corners of two controllers: each blends two moves in its own way, so there the ways are measured and not asked to be
one. What lies outside of both corners is cut out of both ways at the same distance from the programmed point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.proof.groups import SAME_GOAL_MM, Group
from rpl.proof.paths import turn_deg
from rpl.proof.record import Stretch

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

# Ways shorter than this (mm) between two corners are no way that could be compared.
_SHORTEST_MM = 1e-3
# Radii are cut to this, so that noise in the last place of a corner's beginning moves no cut.
_STEP_MM = 1e-3
_MARGIN_MM = 1e-6
_POINTS = 128


@dataclass(frozen=True, slots=True, eq=False)
class Corner:
    """The end of a group of moves that at least one of two programs passes. points: the programmed point in both (3,).
    before, behind: how far from it (mm) either of them leaves the first move and is on the next one. stops: which of
    them come to rest there."""

    points: tuple[FloatArray, FloatArray]
    before: float
    behind: float
    stops: tuple[bool, bool]


def corner_behind(groups: Sequence[Group], number: int) -> Corner | None:
    """The corner between a group and the next one; None where both stop, or do not head for the same point."""
    if not 0 <= number < len(groups) - 1:
        return None
    (a, b), (next_a, next_b) = groups[number], groups[number + 1]
    if not (a and b and next_a and next_b):
        return None
    first, second = a[-1], b[-1]
    if (first.stops and second.stops) or first.goal is None or second.goal is None:
        return None
    if float(np.linalg.norm(first.goal[:3] - second.goal[:3])) > SAME_GOAL_MM:
        return None
    points = first.goal[:3], second.goal[:3]
    before = max(_begins(side, point) for side, point in zip((first, second), points, strict=True))
    behind = max(
        float(np.linalg.norm(side.poses[0, :3, 3] - point))
        for side, point in zip((next_a[0], next_b[0]), points, strict=True)
    )
    return Corner(points, _up(before), _up(behind), (first.stops, second.stops))


def _begins(stretch: Stretch, point: FloatArray) -> float:
    if stretch.corner_at is None:
        return 0.0
    return float(np.linalg.norm(stretch.poses[stretch.corner_at, :3, 3] - point))


def _up(mm: float) -> float:
    return float(np.ceil(round(mm / _STEP_MM, 3))) * _STEP_MM


def ways(group: Group) -> tuple[FloatArray, FloatArray]:
    """Both ways of a group, (k, 4, 4) and (m, 4, 4)."""
    a, b = (np.concatenate([stretch.poses for stretch in side]) for side in group)
    return a, b


def between(group: Group, entered: Corner | None, left: Corner | None) -> tuple[FloatArray, FloatArray] | None:
    """Both ways of a group without the corner that leads into it and the one at its end; None when nothing is left."""
    cut = []
    for side, way in enumerate(ways(group)):
        corner_at = group[side][-1].corner_at
        if left is not None and corner_at is not None:
            way = way[: len(way) - len(group[side][-1].poses) + corner_at + 1]
        if left is not None:
            way = _until(way, left.points[side], left.before)
        if entered is not None and len(way):
            way = _until(way[::-1], entered.points[side], entered.behind)[::-1]
        if len(way) < 2 or np.linalg.norm(np.diff(way[:, :3, 3], axis=0), axis=1).sum() < _SHORTEST_MM:
            return None
        cut.append(way)
    return cut[0], cut[1]


def _until(way: FloatArray, point: FloatArray, radius: float) -> FloatArray:
    """The way up to where it comes within the radius of the point for good."""
    away = np.linalg.norm(way[:, :3, 3] - point, axis=1)
    outside = np.flatnonzero(away > radius + _MARGIN_MM)
    if not len(outside):
        return way[:0]
    last = int(outside[-1])
    if last == len(way) - 1 or radius <= 0.0:
        return way
    share = (away[last] - radius) / max(float(away[last] - away[last + 1]), 1e-12)
    return np.concatenate((way[: last + 1], (way[last] + share * (way[last + 1] - way[last]))[None]))


def around(groups: Sequence[Group], number: int, corner: Corner) -> tuple[FloatArray, FloatArray]:
    """Both ways through a corner, from where the first of them leaves its move to where both are on the next one."""
    found = []
    for side in (0, 1):
        point = corner.points[side]
        into, out = ways(groups[number])[side], ways(groups[number + 1])[side]
        before = _until(into[: _corner_from(groups[number][side])], point, corner.before)
        behind = _until(out[::-1], point, corner.behind)
        kept = into[max(len(before) - 1, 0) :], out[: len(out) - len(behind) + 1]
        crossings = before[-1:], behind[-1:]
        found.append(np.concatenate((crossings[0], kept[0][1:], kept[1][:-1], crossings[1])))
    return found[0], found[1]


def near(groups: Sequence[Group], number: int) -> tuple[FloatArray, FloatArray]:
    """Both ways from the move before the last one before a corner to that behind the next one."""
    some = [ways(group) for group in groups[max(number - 1, 0) : number + 3] if group[0] and group[1]]
    return np.concatenate([a for a, _ in some]), np.concatenate([b for _, b in some])


def _corner_from(side: Sequence[Stretch]) -> int:
    """How many poses of a side lie before its last corner."""
    whole, last = sum(len(one.poses) for one in side), side[-1]
    return whole if last.corner_at is None else whole - len(last.poses) + last.corner_at + 1


def aside(groups: Sequence[Group], number: int, corner: Corner) -> tuple[float, float]:
    """How far two ways lie beside each other at a corner: the greatest distance (mm) of a point of either from the
    other way, and the turn there (deg), by the nearest points. Where along the ways does not matter."""
    inside, whole = around(groups, number, corner), near(groups, number)
    mm, deg = 0.0, 0.0
    for way, other in ((inside[0], whole[1]), (inside[1], whole[0])):
        here = _evenly(way)
        apart, nearest, share = _nearest(here[:, :3, 3], other[:, :3, 3])
        turned = np.where(share > 0.5, np.minimum(nearest + 1, len(other) - 1), nearest)
        mm = max(mm, float(apart.max(initial=0.0)))
        deg = max(deg, float(turn_deg(here[:, :3, :3], other[turned, :3, :3]).max(initial=0.0)))
    return mm, deg


def _evenly(way: FloatArray) -> FloatArray:
    """At most so many of the poses, the first and the last of them included."""
    if len(way) <= _POINTS:
        return way
    return np.asarray(way[np.unique(np.rint(np.linspace(0, len(way) - 1, _POINTS)).astype(int))])


def _nearest(points: FloatArray, way: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of points (k, 3) the distance to a polyline (m, 3), the segment that is nearest, and where on it."""
    if len(way) == 1:
        apart = np.linalg.norm(points - way[0], axis=1)
        return apart, np.zeros(len(points), dtype=int), np.zeros(len(points))
    begin, step = way[:-1], np.diff(way, axis=0)
    square = np.maximum((step * step).sum(axis=1), 1e-18)
    offset = points[:, None] - begin
    share = np.clip((offset * step).sum(axis=2) / square, 0.0, 1.0)
    apart = np.linalg.norm(offset - share[:, :, None] * step, axis=2)
    nearest = apart.argmin(axis=1)
    rows = np.arange(len(points))
    return apart[rows, nearest], nearest, share[rows, nearest]


__all__ = ["Corner", "aside", "between", "corner_behind", "ways"]
