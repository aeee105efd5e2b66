"""The choice among an arm's solutions for a target, for one pose or for a whole file of them at once.

Each brand says in its own way which posture and which revolution of each axis a target means (`rpl.emulator.
configuration`). What they share is here as array operations: all solutions of all poses, the turns of each axis inside
its limits, and the nearest of those that the brand's rule leaves over. Singular postures count as such within the
rounding of printed poses, because solutions next to them are noise: the joint that is free takes a given value.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from rpl.emulator.arms import OpwArm, ScaraArm, UrArm
from rpl.emulator.model import LIMIT_SLACK, BatchSolutions
from rpl.emulator.postures import same_posture, sides
from rpl.emulator.recognise import PlacedArm
from rpl.emulator.rotations import invert_pose
from rpl.emulator.rounding import NOISE, PLACES, first_least

if TYPE_CHECKING:
    from rpl.emulator.arms import BoolArray
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray, IntArray

# Three printed decimals of an orientation leave the wrist uncertain by about this much, degrees.
STRAIGHT_DEG = 1e-3
# And the place by about this much, mm.
ROUNDING_MM = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Candidates:
    """All solutions of k poses, b branches each: joints (k, b, n) in (-180, 180], NaN where there is none.

    `sides` (b, 3) are shoulder, elbow and wrist of the branches, `straight` (k, b) where the wrist is straight, so that
    its side means nothing, `singular` (k, b) where any joint was free.
    """

    joints: FloatArray
    valid: BoolArray
    straight: BoolArray
    singular: BoolArray
    sides: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Chosen:
    """Joints (k, n), NaN where nothing fits; `reachable` (k,): the pose has solutions at all."""

    joints: FloatArray
    reachable: BoolArray


Fits = Callable[[Candidates], "BoolArray"]
# Cost (degrees, inf: not allowed) of axis values (k, b, t), None where the rule does not look at that axis.
TurnCost = Callable[[int, "FloatArray"], "FloatArray | None"]


@dataclass(frozen=True, slots=True, eq=False)
class Rule:
    """How a brand chooses: which branches fit, what each axis's revolution costs, and what is near.

    `distance`: "axis" is the longest way of any axis in degrees, "time" the root of the squared times at full speed.
    `free` (n,) or (k, n): the values of joints that a singular posture leaves free. `half_turned`: a straight wrist may
    also be taken with both its axes half a turn on.
    """

    fits: Fits
    turn_cost: TurnCost
    free: FloatArray
    distance: Literal["axis", "time"] = "axis"
    half_turned: bool = True


def joints_before(model: RobotModel, reference: FloatArray | None, count: int) -> FloatArray:
    """The joints (count, n) that the arm comes from: one reference for all, one each, or the home position."""
    return np.broadcast_to(model.home if reference is None else reference, (count, model.axes))


def candidates(model: RobotModel, flanges: FloatArray, free: FloatArray) -> Candidates:
    """Every solution for flange poses (k, 4, 4); free joints of singular postures as in `free` (n,) or (k, n)."""
    found = _within_rounding(model, flanges, np.broadcast_to(free, (len(flanges), model.axes)))
    branches = np.array([(one.shoulder, one.elbow, one.wrist) for one in model.arm.branches], dtype=np.int64)
    joints, straight = _straightened(
        model, found.joints, branches[:, 2], np.broadcast_to(free, (len(flanges), model.axes))
    )
    return Candidates(joints, found.valid, straight & found.valid, found.singular, branches)


def _within_rounding(model: RobotModel, flanges: FloatArray, free: FloatArray) -> BatchSolutions:
    """All solutions, where rounding of a printed pose is not held against it: a wrist centre as good as over axis 1 is
    over it, and a pose as good as at the end of the reach is reached there."""
    arm, base = (model.arm.arm, model.arm.base) if isinstance(model.arm, PlacedArm) else (model.arm, np.eye(4))
    if isinstance(arm, OpwArm) and arm.b == 0.0:
        tip = model.arm.tip if isinstance(model.arm, PlacedArm) else np.eye(4)
        centre = flanges @ (invert_pose(tip) @ np.array([0.0, 0.0, -arm.c4, 1.0]))
        aside = (centre[:, :3] - base[:3, 3]) @ base[:3, :2]
        over = np.hypot(aside[:, 0], aside[:, 1]) < ROUNDING_MM
        if over.any():
            flanges = flanges.copy()
            flanges[over, :3, 3] -= aside[over] @ base[:3, :2].T
    found = model.inverse_batch(flanges, free)
    if not isinstance(arm, OpwArm | UrArm | ScaraArm) or found.valid.any(axis=1).all():
        return found
    joints, valid, singular = found.joints.copy(), found.valid.copy(), found.singular.copy()
    shoulder = arm.c1 if isinstance(arm, OpwArm) else arm.d1 if isinstance(arm, UrArm) else 0.0
    middle = (base @ np.array([0.0, 0.0, shoulder, 1.0]))[:3]
    for step in (ROUNDING_MM / 100.0, ROUNDING_MM):
        lost = np.flatnonzero(~valid.any(axis=1) & np.isfinite(flanges).all(axis=(1, 2)))
        if not len(lost):
            break
        pulled = flanges[lost].copy()
        inward = middle - pulled[:, :3, 3]
        if isinstance(arm, ScaraArm):  # whose links lie flat
            inward[:, 2] = 0.0
        pulled[:, :3, 3] += step * inward / np.maximum(np.linalg.norm(inward, axis=1, keepdims=True), 1.0)
        again = model.inverse_batch(pulled, free[lost])
        joints[lost], valid[lost], singular[lost] = again.joints, again.valid, again.singular
    return BatchSolutions(joints, valid, singular)


def _straightened(
    model: RobotModel, joints: FloatArray, wrist: IntArray, free: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Wrists within rounding of straight made straight, joint 4 as in `free`; and where that is."""
    arm = model.arm.arm if isinstance(model.arm, PlacedArm) else model.arm
    if not isinstance(arm, OpwArm):
        return joints, np.zeros(joints.shape[:2], dtype=np.bool_)
    theta = model.theta(joints)
    bent = np.abs(np.remainder(theta[..., 4] + np.pi, 2.0 * np.pi) - np.pi)
    straight = bent < np.radians(STRAIGHT_DEG)
    if not straight.any():
        return joints, straight
    fourth = model.theta(free)[:, None, 3] + np.where(wrist == 1, np.pi, 0.0)
    made = theta.copy()
    made[..., 3] = fourth
    made[..., 4] = 0.0
    made[..., 5] = theta[..., 5] + theta[..., 3] - fourth
    return np.where(straight[..., None], model.pendant(made), joints), straight


def choose(model: RobotModel, flanges: FloatArray, near: FloatArray, rule: Rule) -> Chosen:
    """The joints (k, n) that a brand's rule takes for flange poses (k, 4, 4), `near` (n,) or (k, n) being where the
    arm is: least cost first, then least distance."""
    found = candidates(model, flanges, rule.free)
    allowed = found.valid & rule.fits(found)
    if not rule.half_turned:
        allowed = allowed & ~(found.straight & (found.sides[:, 2] == 1))
    here = np.broadcast_to(near, (len(flanges), model.axes))[:, None]
    with np.errstate(invalid="ignore"):
        joints, cost = _turned(model, found.joints, here, rule.turn_cost)
        away = np.abs(joints - here)
        if rule.distance == "axis":
            distance = away.max(axis=-1)
        else:
            distance = np.linalg.norm(away / model.speeds, axis=-1)
    allowed = allowed & np.isfinite(cost)
    # Rounding must not decide between equal ways: the first branch of the fixed order wins.
    equal = np.where(allowed, np.round(distance, PLACES), np.inf)
    rank = np.lexsort((equal, np.where(allowed, np.round(cost, PLACES), np.inf)), axis=1)[:, 0]
    rows = np.arange(len(flanges))
    taken = np.where(allowed[rows, rank, None], joints[rows, rank], np.nan)
    return Chosen(taken, np.asarray(found.valid.any(axis=1)))


def _turned(
    model: RobotModel, joints: FloatArray, here: FloatArray, turn_cost: TurnCost
) -> tuple[FloatArray, FloatArray]:
    """Each axis of joints (k, b, n) on the revolution that costs least, then lies nearest to `here` (k, 1, n); and the
    greatest cost (k, b), inf where an axis has none inside its limits."""
    low, high = model.limits[:, 0] - LIMIT_SLACK, model.limits[:, 1] + LIMIT_SLACK
    taken, worst = joints.copy(), np.zeros(joints.shape[:2])
    for axis, turning in enumerate(model.revolute):
        # Whole turns that could bring an angle in (-180, 180] inside the limits.
        first = int(np.ceil((low[axis] - 180.0) / 360.0)) if turning else 0
        last = int(np.floor((high[axis] + 180.0) / 360.0)) if turning else 0
        if last <= first == 0:
            cost = turn_cost(axis, joints[..., axis, None])
            worst = worst if cost is None else np.maximum(worst, cost[..., 0])
            continue
        values = joints[..., axis, None] + 360.0 * np.arange(first, max(last, first) + 1)
        asked = turn_cost(axis, values)
        inside = (values >= low[axis]) & (values <= high[axis])
        cost = np.where(inside, 0.0 if asked is None else asked, np.inf)
        least = cost.min(axis=-1, keepdims=True)
        away = np.where(cost <= least + NOISE, np.abs(values - here[..., axis, None]), np.inf)
        best = first_least(away)[..., None]
        taken[..., axis] = np.take_along_axis(values, best, axis=-1)[..., 0]
        worst = np.maximum(worst, least[..., 0])
    inside = ((taken >= low) & (taken <= high)).all(axis=-1)
    return taken, np.where(inside, worst, np.inf)


def on_other_arm(source: RobotModel, joints: FloatArray, other: RobotModel, flanges: FloatArray) -> Chosen:
    """Joints (k, m) of another arm for flange poses (k, 4, 4) that `source` reaches with `joints` (k, n): the same
    posture and turns, and no other one, where the arms are of one build; else what is nearest to its home position."""
    near = same_posture(source, joints, other)
    alike = isinstance(source.arm, OpwArm) and isinstance(other.arm, OpwArm)
    asked = sides(source, joints)[:, None]

    def fits(found: Candidates) -> BoolArray:
        if not alike:
            return found.valid
        met = found.sides[None] == asked
        met[..., 2] |= found.straight
        return np.asarray(met.all(axis=-1))

    return choose(other, flanges, near, Rule(fits, lambda axis, values: None, near))


__all__ = ["STRAIGHT_DEG", "Candidates", "Chosen", "Fits", "Rule", "TurnCost", "candidates", "choose", "on_other_arm"]
