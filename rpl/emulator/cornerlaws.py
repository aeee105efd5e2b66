"""Time laws inside a corner that the robot does not drive through as planned: it brakes there, or takes it up again.

A corner is driven evenly over its own fraction, and the tool's speed follows from the curve. Who brakes slows the tool
evenly along that curve instead, with the acceleration of the move that the corner ends, and goes on into the next move
where the corner is too short to come to rest in.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.timelaw import TimeLaw

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.emulator.rotations import FloatArray

SAMPLES = 129
# A corner shorter than this (mm) is measured by its fraction: it turns the tool, or moves axes that the tool hides.
SHORTEST_MM = 1e-3
STEP = 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A part of a corner: `begin`..`end` of its fraction, driven by `law`; `speed` (1/s) at its end, 0 where it rests
    there."""

    begin: float
    end: float
    law: TimeLaw
    speed: float


@dataclass(frozen=True, slots=True, eq=False)
class _Way:
    """The corner from one place on: its fractions, the way (k,) from there and the way per fraction (k,). The way is
    in mm, or in fractions of the corner."""

    fractions: FloatArray
    ways: FloatArray
    slopes: FloatArray
    acceleration: float


def ratios(first: PlannedMove, corner: PlannedMove, second: PlannedMove) -> tuple[float, float]:
    """How fast the fractions of the move before a corner and of the move behind it run against the corner's own: the
    speed is continuous where they meet."""
    before, behind = _rate(first, first.law.speeds[-1]), _rate(second, second.law.speeds[0])
    begin, end = float(corner.law.speeds[0]), float(corner.law.speeds[-1])
    into = before / begin if before > 0.0 else _measured(corner, 0.0, first, first.span[1], -STEP)
    return into, behind / end if behind > 0.0 else _measured(corner, 1.0, second, second.span[0], STEP)


def _rate(move: PlannedMove, speed: float) -> float:
    return float(speed) * (move.span[1] - move.span[0])


def _measured(corner: PlannedMove, at: float, move: PlannedMove, place: float, step: float) -> float:
    """The same by how far the axes go in a small step to both sides of where they meet."""
    inside = corner.geometry.joints(np.array([at, at - np.sign(step) * STEP]))
    outside = move.geometry.joints(np.array([place, place + step]))
    return float(np.abs(np.diff(inside, axis=0)).max() / max(np.abs(np.diff(outside, axis=0)).max(), 1e-12))


def braked(
    corner: PlannedMove, begin: float, speed: float, rate: float, first: PlannedMove, strength: float
) -> Stretch:
    """From `begin` of the corner at `speed` (1/s of it) come to rest with `strength` times the deceleration of the move
    before it; `rate`: that move's fractions per fraction of the corner."""
    way = _way(corner, begin, first, rate, first.profile.down)
    pull = way.acceleration * strength
    squared = (speed * way.slopes[0]) ** 2 - 2.0 * pull * way.ways
    last = len(squared) - 1
    if squared[-1] < 0.0:  # it comes to rest in the corner
        last = int(np.argmax(squared < 0.0))
        rest = (speed * way.slopes[0]) ** 2 / (2.0 * pull)
        end = float(np.interp(rest, way.ways, way.fractions))
    else:
        end = 1.0
    fractions = np.append(way.fractions[:last], end)
    speeds = np.sqrt(np.maximum(np.append(squared[:last], squared[last]), 0.0)) / np.append(
        way.slopes[:last], way.slopes[last]
    )
    return _stretch(fractions, speeds)


def taken_up(corner: PlannedMove, begin: float, rate: float, first: PlannedMove) -> Stretch:
    """From rest at `begin` of the corner speed up to the corner's own speed, and go on to its end."""
    way = _way(corner, begin, first, rate, first.profile.acceleration)
    fastest = float(corner.law.speeds.max())
    speeds = np.minimum(np.sqrt(2.0 * way.acceleration * way.ways) / way.slopes, fastest)
    return _stretch(way.fractions, speeds)


def _way(corner: PlannedMove, begin: float, first: PlannedMove, rate: float, acceleration: float) -> _Way:
    fractions = np.linspace(min(begin, 1.0 - 1e-9), 1.0, SAMPLES)
    points = corner.geometry.tcp(fractions)[:, :3, 3]
    ways = np.insert(np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)), 0, 0.0)
    whole = float(first.geometry.distance(np.array([1.0]))[0])
    if first.kind == "joint" or ways[-1] < SHORTEST_MM * (1.0 - begin) or whole < SHORTEST_MM:
        return _Way(fractions, fractions - fractions[0], np.ones_like(fractions), acceleration / rate)
    slopes = np.gradient(ways, fractions, edge_order=2)
    return _Way(fractions, ways, np.maximum(slopes, 1e-9), acceleration * whole)


def _stretch(fractions: FloatArray, speeds: FloatArray) -> Stretch:
    """The law through these speeds (1/s of the whole corner) at these places."""
    begin, end = float(fractions[0]), float(fractions[-1])
    steps = np.diff(fractions)
    times = np.insert(np.cumsum(2.0 * steps / np.maximum(speeds[1:] + speeds[:-1], 1e-12)), 0, 0.0)
    part = max(end - begin, 1e-12)
    law = TimeLaw(times, (fractions - begin) / part, speeds / part)
    return Stretch(begin, end, law, float(speeds[-1]))
