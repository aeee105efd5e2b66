"""Joints along a path: inverse kinematics for every sample, kept on one continuous run of joint values.

A path is first sampled evenly, then refined wherever a joint turns by more than `STEP_DEG` between two samples, so the
spikes of joint speed next to a singularity are seen. Where no refinement makes the joints continuous, the arm would
have to jump: that is the singularity itself. The run follows the start's branch while it is continuous, and otherwise
the solution nearest to the sample before, which is what "the configuration of the start is kept" comes to (and lets an
arm pass through an exactly straight wrist with joint 4 at rest, joint 5 changing its sign).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray
from rpl.emulator.rounding import NOISE, first_least, whole_turns

STEP_DEG = 2.0
# Samples closer than this fraction of the path are not split again: what still jumps there, jumps.
FINEST = 2e-6
MOST_SAMPLES = 6000

FaultKind = Literal[
    "unreachable",
    "joint_limit",
    "configuration",
    "singularity",
    "axis_speed",
    "degenerate_circle",
    "bad_speed",
    "bad_target",
    "bad_value",
    "no_curve",
]


@dataclass(frozen=True, slots=True)
class MotionFault:
    """Why a move cannot be made: axis is an index from 0, fraction tells where on the path (0..1)."""

    kind: FaultKind
    message: str
    axis: int | None = None
    fraction: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Joints (k, n) in pendant units at fractions (k,) of a path, continuous from the start's joints."""

    fractions: FloatArray
    joints: FloatArray

    def at(self, fraction: FloatArray) -> FloatArray:
        """Joints (m, n), linear between the samples."""
        s = np.asarray(fraction, dtype=np.float64)
        i = np.clip(np.searchsorted(self.fractions, s, side="right") - 1, 0, len(self.fractions) - 2)
        share = (s - self.fractions[i]) / (self.fractions[i + 1] - self.fractions[i])
        return np.asarray(self.joints[i] + share[..., None] * (self.joints[i + 1] - self.joints[i]))


Solver = Callable[[FloatArray], "FloatArray | MotionFault"]


def track_flanges(
    model: RobotModel, flanges_at: Callable[[FloatArray], FloatArray], start: FloatArray, samples: int
) -> Track | MotionFault:
    """Follow flange poses `flanges_at(fractions (k,)) -> (k, 4, 4)` from `start` (n,), beginning with `samples`."""

    def solve(fractions: FloatArray) -> FloatArray | MotionFault:
        flanges = flanges_at(fractions)
        quick = _same_branch(model, flanges, start)
        return quick if quick is not None else _step_by_step(model, flanges, fractions, start)

    return _refined(model, solve, samples)


def track_wrist_joints(
    model: RobotModel,
    positions_at: Callable[[FloatArray], FloatArray],
    tool: FloatArray,
    start: FloatArray,
    end: FloatArray,
    samples: int,
) -> Track | MotionFault:
    """Follow positions of the tool centre point (k, 3) while the last three joints move evenly from start to end.

    This is the way round a wrist singularity that several controllers offer: the point stays on its path, the
    orientation is whatever the wrist joints make of it.
    """

    def solve(fractions: FloatArray) -> FloatArray | MotionFault:
        guess = start + fractions[:, None] * (end - start)
        return solve_arm_joints(model, guess, positions_at(fractions), tool, fractions)

    return _refined(model, solve, samples)


def solve_arm_joints(
    model: RobotModel, guess: FloatArray, positions: FloatArray, tool: FloatArray, fractions: FloatArray
) -> FloatArray | MotionFault:
    """Move the first three joints of guesses (k, n) until the tool centre points are at positions (k, 3); Newton."""
    joints = guess.copy()
    for _ in range(30):
        flange = model.forward(joints)
        offset = flange[:, :3, :3] @ tool[:3, 3]
        error = positions - flange[:, :3, 3] - offset
        worst = np.linalg.norm(error, axis=1)
        if np.all(worst < 1e-8):
            return joints
        jacobian = model.jacobian(joints)[:, :, :3]
        at_tool = jacobian[:, :3] + np.cross(jacobian[:, 3:], offset[:, :, None], axis=1)
        damped = np.swapaxes(at_tool, 1, 2) @ at_tool + 1e-9 * np.eye(3)
        step = np.linalg.solve(damped, np.swapaxes(at_tool, 1, 2) @ error[:, :, None])[..., 0]
        joints[:, :3] += np.clip(step / model.unit[:3], -15.0, 15.0)
    first = int(np.argmax(worst > 1e-6))
    if worst[first] <= 1e-6:
        return joints
    return MotionFault(
        "unreachable",
        "the path leaves the reach of the arm with evenly moving wrist joints",
        None,
        float(fractions[first]),
    )


def _refined(model: RobotModel, solve: Solver, samples: int) -> Track | MotionFault:
    fractions = np.linspace(0.0, 1.0, max(samples, 2))
    while True:
        joints = solve(fractions)
        if isinstance(joints, MotionFault):
            return joints
        outside = _limit_fault(model, joints, fractions)
        if outside is not None:
            return outside
        steps = np.abs(np.diff(joints, axis=0)) * model.revolute
        coarse = np.flatnonzero(steps.max(axis=1) > STEP_DEG + NOISE)
        if len(coarse) == 0:
            return Track(fractions, joints)
        gaps = fractions[coarse + 1] - fractions[coarse]
        if np.any(gaps < FINEST) or len(fractions) > MOST_SAMPLES:
            worst = int(coarse[first_least(gaps)])
            axis = int(first_least(-steps[worst]))
            return MotionFault(
                "singularity",
                f"joint {axis + 1} would have to jump by {steps[worst, axis]:.1f} degrees",
                axis,
                float(fractions[worst]),
            )
        fractions = np.sort(np.concatenate([fractions, fractions[coarse] + 0.5 * gaps]))


def _limit_fault(model: RobotModel, joints: FloatArray, fractions: FloatArray) -> MotionFault | None:
    outside = (joints < model.limits[:, 0] - 1e-6) | (joints > model.limits[:, 1] + 1e-6)
    bad = np.flatnonzero(outside.any(axis=1))
    if len(bad) == 0:
        return None
    first = int(bad[0])
    axis = int(np.argmax(outside[first]))
    low, high = model.limits[axis]
    return MotionFault(
        "joint_limit",
        f"joint {axis + 1} would be at {joints[first, axis]:.3f}, outside {low:g}..{high:g}",
        axis,
        float(fractions[first]),
    )


def _same_branch(model: RobotModel, flanges: FloatArray, start: FloatArray) -> FloatArray | None:
    """Joints (k, n) when all samples have the start's branch, none is singular and no joint jumps; else None."""
    if model.kind == "chain":
        return None
    found = model.inverse_batch(flanges, start)
    column = model.arm.branches.index(model.posture(start).branch)
    if not found.valid[:, column].all() or found.singular[:, column].any():
        return None
    joints = found.joints[:, column].copy()
    turning = model.revolute
    joints[:, turning] = np.unwrap(np.vstack([start, joints])[:, turning], axis=0, period=360.0)[1:]
    steps = np.abs(np.diff(np.vstack([start, joints]), axis=0)) * turning
    return joints if steps[0].max() < 1e-3 and steps.max() < 30.0 else None


def _step_by_step(
    model: RobotModel, flanges: FloatArray, fractions: FloatArray, start: FloatArray
) -> FloatArray | MotionFault:
    """Joints (k, n), each the solution nearest to the one before; singular samples keep the free joint."""
    closed = model.kind != "chain"
    found = model.inverse_batch(flanges, start) if closed else None
    joints = np.empty((len(flanges), model.axes))
    previous = start
    for k, flange in enumerate(flanges):
        if found is not None and not found.singular[k].any():
            choices = found.joints[k][found.valid[k]]
        else:
            here = model.inverse_batch(flange[None], previous)
            choices = here.joints[0][here.valid[0]]
        if len(choices) == 0:
            return MotionFault("unreachable", "the path leaves the reach of the arm", None, float(fractions[k]))
        near = np.where(model.revolute, choices + 360.0 * whole_turns(previous - choices), choices)
        previous = near[first_least(np.abs((near - previous) * model.revolute).max(axis=1))]
        joints[k] = previous
    return joints
