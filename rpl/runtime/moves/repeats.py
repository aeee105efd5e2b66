"""Moves and corners that a program makes again and again are planned once.

Production programs are loops. A plan depends on nothing but the arm, the joints at its start and the request, so that
the same question has the same answer; the plan is then also kept once for all the rounds that the trace shows. What
counts as the same is exact: joints that differ in their last bit are another question.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import cast

import numpy as np

from rpl.emulator import blending, planner
from rpl.emulator.cornerlaws import ratios
from rpl.emulator.model import RobotModel
from rpl.emulator.planner import MotionFault, MoveRequest, PlannedMove
from rpl.emulator.rotations import FloatArray

# Plans and corners kept, the latest ones; a cycle with more moves than that is planned anew each time.
KEPT = 512
# Points on a corner between which its length is counted.
SAMPLES = 129


@dataclass(frozen=True, slots=True)
class _Question:
    """A move to plan, compared by what stands in its arrays."""

    model: RobotModel = field(compare=False)
    start: FloatArray = field(compare=False)
    request: MoveRequest = field(compare=False)
    key: tuple[Hashable, ...]


def _word(request: MoveRequest, name: str) -> Hashable:
    value = getattr(request, name)
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    return cast(Hashable, value)


@lru_cache(maxsize=KEPT)
def _planned(question: _Question) -> PlannedMove | MotionFault:
    return planner.plan(question.model, question.start, question.request)


def plan(model: RobotModel, start: FloatArray, request: MoveRequest) -> PlannedMove | MotionFault:
    """What `planner.plan` answers for joints (n,) and a request."""
    words = tuple(_word(request, name) for name in MoveRequest.__slots__)
    return _planned(_Question(model, start, request, (model, start.tobytes(), *words)))


@dataclass(frozen=True, slots=True, eq=False)
class Joining:
    """The corner between two moves: the three parts, how fast the fractions of the moves before and behind run against
    the corner's own, and millimetres (k,) along it at even fractions."""

    parts: blending.Corner
    rates: tuple[float, float]
    ways: FloatArray


@lru_cache(maxsize=KEPT)
def joining(
    model: RobotModel,
    first: PlannedMove,
    second: PlannedMove,
    size: blending.Size,
    alone: tuple[bool, bool],
) -> Joining | None:
    """What `blending.blend` makes of two moves; None: they have no corner."""
    made = blending.blend(model, first, second, size, alone)
    if not isinstance(made, blending.Corner):
        return None
    points = made.corner.geometry.tcp(np.linspace(0.0, 1.0, SAMPLES))[:, :3, 3]
    return Joining(made, ratios(made.first, made.corner, made.second), corner_ways(points))


def corner_ways(points: FloatArray) -> FloatArray:
    """Millimetres (k,) along a corner, of points (k, 3) on it."""
    return np.insert(np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)), 0, 0.0)
