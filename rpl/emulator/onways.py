"""The joints of an arm that goes from place to place, each found from those before, for many places at once.

Where each answer asks for the one before it, thousands are asked at once with a guess of it, and again where the guess
was another one: what comes out is what comes of asking one after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.arms import OpwArm, ScaraArm, UrArm
from rpl.emulator.recognise import PlacedArm

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray, IntArray

# solve(rows, near): joints (k, n) of some of the places, from joints (k, n) before each; NaN where there are none.
Solve = Callable[["IntArray", "FloatArray"], "FloatArray"]

_FEWEST, _MOST = 16, 4096  # places that are guessed at once
_TRIES = 16  # not less than _FEWEST: so many places are settled surely


def followed(solve: Solve, start: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Joints (count, n) at each place, NaN where there are none, and the joints before each: the last ones that were
    found, at first `start` (n,)."""
    joints = np.full((count, len(start)), np.nan)
    before = np.empty_like(joints)
    first, near, at_once = 0, start, _MOST
    while first < count:
        rows = np.arange(first, min(first + at_once, count), dtype=np.int64)
        guess = np.broadcast_to(near, (len(rows), len(start)))
        found = solve(rows, guess)
        settled = len(rows)
        for _ in range(_TRIES):
            known = _carried(found, near)
            other = np.flatnonzero((known != guess).any(axis=1))
            settled = int(other[0]) if len(other) else len(rows)
            if not len(other):
                break
            found[other] = solve(rows[other], known[other])
            guess = known
        joints[first : first + settled], before[first : first + settled] = found[:settled], guess[:settled]
        near = _carried(found[: settled + 1], near)[-1] if settled < len(rows) else _after(found, near)
        at_once = min(2 * at_once, _MOST) if settled == len(rows) else max(at_once // 4, _FEWEST)
        first += settled
    return joints, before


def _carried(found: FloatArray, near: FloatArray) -> FloatArray:
    """The joints before each: the last ones that were found, at first `near`."""
    last = np.where(np.isnan(found[:, 0]), 0, np.arange(1, len(found) + 1))
    last = np.maximum.accumulate(np.concatenate(([0], last[:-1])))
    return np.concatenate((near[None], found))[last]


def _after(found: FloatArray, near: FloatArray) -> FloatArray:
    there = np.flatnonzero(~np.isnan(found[:, 0]))
    return found[there[-1]] if len(there) else near


class Nearest:
    """`RobotModel.nearest` at many flange poses (k, 4, 4): what does not hang on the joints before is found once."""

    def __init__(self, model: RobotModel, flanges: FloatArray) -> None:
        arm = model.arm.arm if isinstance(model.arm, PlacedArm) else model.arm
        found = model.inverse_batch(flanges, model.home)
        self.model, self.flanges, self.joints = model, flanges, found.joints
        closed = isinstance(arm, OpwArm | UrArm | ScaraArm)
        self.asked_again = np.asarray(found.singular.any(axis=1)) | np.full(len(flanges), not closed)

    def __call__(self, rows: IntArray, near: FloatArray) -> FloatArray:
        joints, again = self.joints[rows], self.asked_again[rows]
        if again.any():
            joints[again] = self.model.inverse_batch(self.flanges[rows[again]], near[again]).joints
        return self.model.nearest_of(joints, near)
