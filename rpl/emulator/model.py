"""A robot as its controller shows it: joints in pendant units and signs, flange poses in its own base frame.

`load_robot` gives a `RobotModel`; forward, inverse, turns, limits and the Jacobian are its methods. All joint vectors
that cross this module are the robot's own (degrees, mm for a sliding joint; coupled joints as the pendant shows them),
so no caller ever converts signs. The closed-form families need NumPy only. This is the one module that imports
Pinocchio, and only inside the functions that read a URDF and solve an arm that no closed form fits.
"""

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.arms import Arm, BoolArray, Branch, OpwArm, ScaraArm, UrArm
from rpl.emulator.robotfile import (
    Kind,
    RobotError,
    RobotFile,
    RobotSummary,
    read_robot_file,
    robot_names,
    robot_summaries,
)
from rpl.emulator.rotations import FloatArray

__all__ = [
    "BatchSolutions",
    "Branch",
    "Posture",
    "RobotError",
    "RobotModel",
    "RobotSummary",
    "Solution",
    "load_robot",
    "robot_names",
    "robot_summaries",
]

# A joint this close to a multiple of 90 degrees is that multiple: keeps rounding noise out of signs and quadrants.
SNAP_DEG = 1e-10
# A printed limit and a printed joint may disagree in their last place.
LIMIT_SLACK = 1e-6
# Time to full axis speed where no acceleration is published; a model, not a fact (see docs/robots.md).
RAMP_S = 0.3


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """One joint vector (n,) that reaches a flange pose; `singular` when a joint was free and the reference chose it."""

    joints: FloatArray
    branch: Branch
    singular: bool


@dataclass(frozen=True, slots=True, eq=False)
class BatchSolutions:
    """All branches for k poses: joints (k, b, n), NaN where there is none; valid and singular (k, b)."""

    joints: FloatArray
    valid: BoolArray
    singular: BoolArray


@dataclass(frozen=True, slots=True)
class Posture:
    """The geometric facts that every brand's configuration flags are made of.

    behind_axis1: the wrist centre lies behind axis 1. elbow_above_stretched: joint 3 is at or beyond the stretched arm,
    bent forward (threshold -atan2(elbow offset, forearm) in theta). behind_lower_arm: the wrist centre lies beyond the
    line from axis 2 to axis 3, the strict opposite. wrist_negative: joint 5 on the far side of the straight wrist.
    """

    behind_axis1: bool
    elbow_above_stretched: bool
    behind_lower_arm: bool
    wrist_negative: bool

    @property
    def branch(self) -> Branch:
        return Branch(int(self.behind_axis1), int(self.behind_lower_arm), int(self.wrist_negative))


@dataclass(frozen=True, slots=True, eq=False)
class RobotModel:
    """One robot. Arrays have one entry (or row) per axis, in pendant units: degrees, mm for a prismatic joint."""

    name: str
    maker: str
    title: str
    kind: Kind
    joint_kinds: tuple[str, ...]
    limits: FloatArray
    speeds: FloatArray
    accelerations: FloatArray
    home: FloatArray
    notes: tuple[str, ...]
    arm: Arm
    # theta = unit * (pendant_to_arm @ pendant - offsets), unit = pi/180 for a revolute joint, 1 for a prismatic one
    pendant_to_arm: FloatArray
    arm_to_pendant: FloatArray
    offsets: FloatArray
    unit: FloatArray

    @property
    def axes(self) -> int:
        """Number of joints."""
        return len(self.joint_kinds)

    @property
    def revolute(self) -> BoolArray:
        """Which joints turn, (n,)."""
        return np.array([kind == "revolute" for kind in self.joint_kinds])

    def theta(self, joints: ArrayLike) -> FloatArray:
        """The arm's own joint variables (radians, mm) of pendant joints (..., n); `ValueError` for a bad shape."""
        q = np.asarray(joints, dtype=np.float64)
        if q.ndim < 1 or q.shape[-1] != self.axes:
            raise ValueError(f"{self.name} has {self.axes} joints, not an array of shape {q.shape}")
        return (q @ self.pendant_to_arm.T - self.offsets) * self.unit

    def pendant(self, theta: FloatArray) -> FloatArray:
        """Pendant joints of arm variables, each revolute one in (-180, 180]."""
        return self.canonical((theta / self.unit + self.offsets) @ self.arm_to_pendant.T)

    def canonical(self, joints: ArrayLike) -> FloatArray:
        """Joints (..., n) with whole turns taken off: revolute ones in (-180, 180], rounding noise at 90s removed."""
        q = np.asarray(joints, dtype=np.float64)
        quarter = np.round(q / 90.0) * 90.0
        q = np.where(self.revolute & (np.abs(q - quarter) < SNAP_DEG), quarter, q)
        return np.where(self.revolute, 180.0 - (180.0 - q) % 360.0, q) + 0.0

    def forward(self, joints: ArrayLike) -> FloatArray:
        """Flange poses in the robot's base frame, mm: (n,) gives (4, 4), (k, n) gives (k, 4, 4)."""
        return self.arm.forward(self.theta(joints))

    def inverse_batch(self, flanges: ArrayLike, reference: ArrayLike | None = None) -> BatchSolutions:
        """Every branch for flange poses (k, 4, 4), in the order of `arm.branches`, limits not considered.

        `reference` (n,) or (k, n), default the home position, gives the joints that a singular posture leaves free:
        joint 4 with a straight wrist, joint 1 with the wrist centre over axis 1.
        """
        poses = np.asarray(flanges, dtype=np.float64)
        if poses.ndim != 3 or poses.shape[1:] != (4, 4):
            raise ValueError(f"flange poses have the shape (k, 4, 4), not {poses.shape}")
        near = self.theta(self.home if reference is None else reference)
        found = self.arm.inverse(poses, np.broadcast_to(near, (len(poses), self.axes)))
        return BatchSolutions(self.pendant(found.theta), found.valid, found.singular)

    def inverse(self, flange: ArrayLike, reference: ArrayLike | None = None) -> tuple[Solution, ...]:
        """Every solution for one flange pose (4, 4), revolute joints in (-180, 180]; empty when out of reach."""
        found = self.inverse_batch(np.asarray(flange, dtype=np.float64)[None], reference)
        return tuple(
            Solution(found.joints[0, i], branch, bool(found.singular[0, i]))
            for i, branch in enumerate(self.arm.branches)
            if found.valid[0, i]
        )

    def turns(self, joints: ArrayLike) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
        """Whole turns (..., n) by which each joint differs from its value in (-180, 180]; 0 for prismatic ones."""
        q = np.asarray(joints, dtype=np.float64)
        return np.where(self.revolute, np.round((q - self.canonical(q)) / 360.0), 0.0).astype(np.int64)

    def expand_turns(self, solution: Solution | ArrayLike) -> FloatArray:
        """All joint vectors (m, n) inside the limits that differ from the given one by whole turns; m may be 0."""
        base = self.canonical(solution.joints if isinstance(solution, Solution) else solution)
        choices: list[list[float]] = []
        for value, (low, high), turning in zip(base, self.limits, self.revolute, strict=True):
            if not turning:
                choices.append([float(value)] if low - LIMIT_SLACK <= value <= high + LIMIT_SLACK else [])
                continue
            first = int(np.ceil((low - LIMIT_SLACK - value) / 360.0))
            last = int(np.floor((high + LIMIT_SLACK - value) / 360.0))
            choices.append([float(value) + 360.0 * turn for turn in range(first, last + 1)])
        return np.array(list(itertools.product(*choices)), dtype=np.float64).reshape(-1, self.axes)

    def nearest_turn(self, joints: ArrayLike, reference: ArrayLike) -> FloatArray:
        """Joints (..., n) moved by whole turns as near to the reference as the limits allow, axis by axis.

        An axis that no turn brings inside its limits keeps the turn nearest to the reference.
        """
        q, near = np.asarray(joints, dtype=np.float64), np.asarray(reference, dtype=np.float64)
        low, high = self.limits[:, 0] - LIMIT_SLACK, self.limits[:, 1] + LIMIT_SLACK
        best = q + 360.0 * np.round((near - q) / 360.0)
        best = np.where(best > high, best - 360.0 * np.ceil((best - high) / 360.0), best)
        best = np.where(best < low, best + 360.0 * np.ceil((low - best) / 360.0), best)
        best = np.where(best > high, q + 360.0 * np.round((near - q) / 360.0), best)
        return np.where(self.revolute, best, q)

    def nearest(self, flange: ArrayLike, reference: ArrayLike) -> FloatArray | None:
        """The joints inside the limits that reach `flange` with the least travel from `reference`; None without any.

        Travel is the root of the summed squares of the axes' travel times at full speed.
        """
        near = np.asarray(reference, dtype=np.float64)
        best, least = None, np.inf
        for solution in self.inverse(flange, near):
            joints = self.nearest_turn(solution.joints, near)
            travel = float(np.linalg.norm((joints - near) / self.speeds))
            if travel < least and not self.within_limits(joints):
                best, least = joints, travel
        return best

    def within_limits(self, joints: ArrayLike) -> list[int]:
        """Indices of the axes outside their limits (empty: all inside)."""
        q = np.asarray(joints, dtype=np.float64)
        outside = (q < self.limits[:, 0] - LIMIT_SLACK) | (q > self.limits[:, 1] + LIMIT_SLACK)
        return [int(axis) for axis in np.flatnonzero(outside | np.isnan(q))]

    def posture(self, joints: ArrayLike) -> Posture:
        """The posture of one joint vector (n,), computed from the geometry by strict signs."""
        branch = self.arm.branch(self.theta(joints))
        return Posture(bool(branch.shoulder), not branch.elbow, bool(branch.elbow), bool(branch.wrist))

    def jacobian(self, joints: ArrayLike) -> FloatArray:
        """Geometric Jacobian (..., 6, n) at the flange origin, base frame: mm/rad (mm/mm) above, rad/rad below.

        Columns are per pendant joint, so a coupled joint moves all that hangs on it. v = J q', q' in rad/s or mm/s.
        """
        theta = self.theta(joints)
        points, directions = self.arm.axes(theta)
        flange = self.arm.forward(theta)[..., :3, 3]
        turning = self.revolute[:, None]
        linear = np.where(turning, np.cross(directions, flange[..., None, :] - points), directions)
        angular = np.where(turning, directions, 0.0)
        columns = np.concatenate([linear, angular], axis=-1)
        return np.asarray(np.swapaxes(columns, -1, -2) @ self.pendant_to_arm)


def load_robot(name_or_path: str) -> RobotModel:
    """The robot of that name, or described by a `.toml` or `.urdf` file; `RobotError` when there is none."""
    if name_or_path.endswith(".urdf"):
        raise RobotError(f"{Path(name_or_path).name}: URDF is not read yet")
    return _from_file(read_robot_file(name_or_path))


def _from_file(file: RobotFile) -> RobotModel:
    lengths = file.lengths
    kinds = ("revolute",) * len(file.home)
    arm: Arm
    match file.kind:
        case "opw":
            arm = OpwArm(**{**lengths, "c1": 0.0 if file.origin_at_axis_2 else lengths["c1"]})
        case "ur":
            arm = UrArm(**lengths)
        case "scara":
            arm = ScaraArm(**lengths)
            kinds = ("revolute", "revolute", "prismatic", "revolute")
        case "chain":
            raise RobotError(f"{file.name}: URDF is not read yet")
    pendant_to_arm = np.diag(file.signs)
    if file.joint_3_follows_joint_2:
        pendant_to_arm[2, 1] = file.signs[2]
    return RobotModel(
        name=file.name,
        maker=file.maker,
        title=file.title,
        kind=file.kind,
        joint_kinds=kinds,
        limits=_fixed(file.limits),
        speeds=_fixed(file.speeds),
        accelerations=_fixed(file.accelerations or [speed / RAMP_S for speed in file.speeds]),
        home=_fixed(file.home),
        notes=_notes(file),
        arm=arm,
        pendant_to_arm=_fixed(pendant_to_arm),
        arm_to_pendant=_fixed(np.linalg.inv(pendant_to_arm)),
        offsets=_fixed(file.offsets),
        unit=_fixed([np.pi / 180.0 if kind == "revolute" else 1.0 for kind in kinds]),
    )


def _notes(file: RobotFile) -> tuple[str, ...]:
    extra = []
    if file.assumed:
        extra.append(f"Not verified: {', '.join(file.assumed)}.")
    if file.accelerations is None:
        extra.append(f"Axis accelerations are a model: full speed in {RAMP_S} s.")
    return (*file.notes, *extra)


def _fixed(values: ArrayLike) -> FloatArray:
    """A read-only copy."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
