"""A robot as its controller shows it: joints in pendant units and signs, flange poses in its own base frame.

`load_robot` gives a `RobotModel`; forward, inverse, turns, limits and the Jacobian are its methods. All joint vectors
that cross this module are the robot's own (degrees, mm for a sliding joint; coupled joints as the pendant shows them),
so no caller ever converts signs. The closed-form families need NumPy only; arms of a URDF come from
`rpl.emulator.chains`.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.arms import Arm, BoolArray, Branch, OpwArm, ScaraArm, UrArm
from rpl.emulator.chains import ChainArm, UrdfChain, described, exact_opw, read_urdf, urdf_inertias
from rpl.emulator.inertias import ArmInertias, arm_inertias
from rpl.emulator.mechanismfile import NEUTRAL_PULSES, Mechanism, checked_together, pulses_of
from rpl.emulator.postures import has_sides, in_posture, same_posture, sides
from rpl.emulator.robotfile import (
    BodyFile,
    Kind,
    RobotError,
    RobotFile,
    RobotSummary,
    read_robot_file,
    robot_names,
    robot_summaries,
)
from rpl.emulator.rotations import FloatArray, IntArray
from rpl.emulator.rounding import NOISE, whole_turns

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
SNAP_DEG = 1e-11
# A printed limit and a printed joint may disagree in their last place.
LIMIT_SLACK = 1e-6
# Ways whose travel differs by this share are equally long.
EQUAL_TRAVEL = 1e-9
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
class UrdfSource:
    """The URDF that an arm was read from. `zero`: its joints (n,), radians and mm, where theta is zero."""

    path: Path
    chain: UrdfChain
    zero: FloatArray


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
    pulses_per_degree: FloatArray | None = None  # motor pulses, of arms whose controller counts positions in them
    counts_pulses: bool = True  # whether the maker's own controller does, or nobody has said that it does not
    motion: Mapping[str, float | tuple[float, ...]] = field(
        default_factory=dict
    )  # time laws measured on this arm under `motion_of`
    motion_of: str = ""
    uncertain_axes: bool = True  # speeds or accelerations of the axes are not verified
    mechanisms: tuple[Mechanism, ...] = ()  # what its file says of tracks and tables that come with it
    inertias: ArmInertias | None = None  # what the links weigh, where somebody has published it
    lag: FloatArray | None = None  # time constants (n,) s of following the command, where somebody has measured them
    foot_mm: float = 0.0  # height of the mounting face in the base frame
    payload_kg: float | None = None  # the class that the maker's name of the model says
    bodies: tuple[BodyFile, ...] = ()  # forms of links that its file gives
    urdf: UrdfSource | None = None
    revolute: BoolArray = field(init=False)  # which joints turn, (n,)
    couplings: tuple[tuple[int, int], ...] = field(init=False)  # of arm_to_pendant: entries beside the diagonal

    def __post_init__(self) -> None:
        """Derive once what every question needs."""
        revolute = np.array([kind == "revolute" for kind in self.joint_kinds])
        revolute.setflags(write=False)
        beside = self.arm_to_pendant - np.diag(np.diagonal(self.arm_to_pendant))
        object.__setattr__(self, "revolute", revolute)
        object.__setattr__(self, "couplings", tuple((int(i), int(j)) for i, j in np.argwhere(beside)))

    @property
    def axes(self) -> int:
        """Number of joints."""
        return len(self.joint_kinds)

    @property
    def pulse_scale(self) -> FloatArray | None:
        """Pulses per degree (or mm) that programs count this arm's joints in. None: its own controller counts, and how
        many there are is not known; any other number would move the real arm wrongly."""
        if self.pulses_per_degree is not None or self.counts_pulses:
            return self.pulses_per_degree
        return _fixed([NEUTRAL_PULSES] * self.axes)

    def external_pulses(self, number: int) -> float | None:
        """Pulses per degree or mm of an external axis (1 ...), as `pulse_scale` for the arm's own."""
        return pulses_of(self.mechanisms, number, not self.counts_pulses)

    @property
    def carrying_axes(self) -> tuple[int, ...]:
        """Numbers of the external axes that carry the robot."""
        return tuple(axis.number for one in self.mechanisms for axis in one.axes if one.carries_robot)

    def among(self, mechanisms: tuple[Mechanism, ...], file: str) -> "RobotModel":
        """The arm with the mechanisms of its own file and those of a cell (`file`)."""
        more = tuple(one for one in mechanisms if one not in self.mechanisms)
        return replace(self, mechanisms=checked_together((*self.mechanisms, *more), file)) if more else self

    def theta(self, joints: ArrayLike) -> FloatArray:
        """The arm's own joint variables (radians, mm) of pendant joints (..., n); `ValueError` for a bad shape."""
        q = np.asarray(joints, dtype=np.float64)
        if q.ndim < 1 or q.shape[-1] != self.axes:
            raise ValueError(f"{self.name} has {self.axes} joints, not an array of shape {q.shape}")
        return (q @ self.pendant_to_arm.T - self.offsets) * self.unit

    def pendant(self, theta: FloatArray) -> FloatArray:
        """Pendant joints of arm variables, each revolute one in (-180, 180]."""
        return self._pendant(theta.copy(order="K"))

    def canonical(self, joints: ArrayLike) -> FloatArray:
        """Joints (..., n) with whole turns taken off: revolute ones in (-180, 180], rounding noise at 90s removed.

        Half a turn is +180 also where rounding has left a little more noise than that.
        """
        return self._reduced(np.array(joints, dtype=np.float64))

    def _pendant(self, theta: FloatArray) -> FloatArray:
        """`pendant`, done in place: in a large batch, fresh memory costs as much as the arithmetic."""
        theta /= self.unit
        theta += self.offsets
        coupled = [self.arm_to_pendant[row, column] * theta[..., column] for row, column in self.couplings]
        theta *= np.diagonal(self.arm_to_pendant)
        for (row, _), share in zip(self.couplings, coupled, strict=True):
            theta[..., row] += share
        return self._reduced(theta)

    def _reduced(self, joints: FloatArray) -> FloatArray:
        """`canonical`, done in place."""
        straight = None if self.revolute.all() else joints[..., ~self.revolute]
        work = np.rint(joints * (1.0 / 90.0))
        work *= 90.0
        off = joints - work
        np.copyto(joints, work, where=np.abs(off, out=off) < SNAP_DEG)
        # Not a remainder: taking whole turns off leaves every bit of an angle that is already inside.
        np.subtract(joints, 180.0 + NOISE, out=work)
        work *= 1.0 / 360.0
        np.ceil(work, out=work)
        work *= 360.0
        joints -= work
        joints += 0.0
        if straight is not None:
            joints[..., ~self.revolute] = straight
        return joints

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
        return BatchSolutions(self._pendant(found.theta), found.valid, found.singular)

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
        return np.where(self.revolute, whole_turns(q - self.canonical(q)), 0.0).astype(np.int64)

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
        nearest = q + 360.0 * whole_turns(near - q)
        best = np.where(nearest > high, nearest - 360.0 * np.ceil((nearest - high) / 360.0), nearest)
        best = np.where(best < low, best + 360.0 * np.ceil((low - best) / 360.0), best)
        best = np.where(best > high, nearest, best)
        return np.where(self.revolute, best, q)

    def nearest(self, flange: ArrayLike, reference: ArrayLike) -> FloatArray | None:
        """The joints inside the limits that reach `flange` with the least travel from `reference`; None without any.

        Travel is the root of the summed squares of the axes' travel times at full speed.
        """
        near = np.asarray(reference, dtype=np.float64)
        found = self.inverse_batch(np.asarray(flange, dtype=np.float64)[None], near)
        joints = self.nearest_of(found.joints, near[None])[0]
        return None if np.isnan(joints[0]) else joints

    def nearest_of(self, solutions: FloatArray, reference: FloatArray) -> FloatArray:
        """Of the solutions (k, b, n) of k poses the one that `nearest` takes from joints (k, n); NaN without any."""
        near = reference[:, None]
        joints = self.nearest_turn(solutions, near)
        inside = (joints >= self.limits[:, 0] - LIMIT_SLACK) & (joints <= self.limits[:, 1] + LIMIT_SLACK)
        travel = np.where(inside.all(axis=2), np.sqrt((((joints - near) / self.speeds) ** 2).sum(axis=2)), np.inf)
        least = travel.min(axis=1)
        # Of equals (an arm bent to either side of its way) the first: rounding must not choose.
        first = np.argmax(travel <= least[:, None] * (1.0 + EQUAL_TRAVEL), axis=1)
        taken: FloatArray = joints[np.arange(len(joints)), first]
        taken[~np.isfinite(least)] = np.nan
        return taken

    def within_limits(self, joints: ArrayLike) -> list[int]:
        """Indices of the axes outside their limits (empty: all inside)."""
        q = np.asarray(joints, dtype=np.float64)
        outside = (q < self.limits[:, 0] - LIMIT_SLACK) | (q > self.limits[:, 1] + LIMIT_SLACK)
        return [int(axis) for axis in np.flatnonzero(outside | np.isnan(q))]

    def posture(self, joints: ArrayLike) -> Posture:
        """The posture of one joint vector (n,), from the geometry; on a boundary within rounding: its near side."""
        branch = self.arm.branch(self.theta(joints))
        return Posture(bool(branch.shoulder), not branch.elbow, bool(branch.elbow), bool(branch.wrist))

    def in_posture(self, flange: FloatArray, near: FloatArray, asked: Mapping[str, str]) -> FloatArray | None:
        """The joints (n,) for a flange pose (4, 4) in the posture that words ask for (rpl.emulator.postures)."""
        return in_posture(self, flange, near, asked)

    def same_posture(self, joints: FloatArray, other: "RobotModel") -> FloatArray:
        """About the joints (n,) of another arm in the posture and the turns of `joints` (rpl.emulator.postures)."""
        return same_posture(self, joints, other)

    def sides(self, joints: FloatArray) -> IntArray:
        """Shoulder, elbow and wrist (..., 3) of joints (..., n), 0 or 1 (rpl.emulator.postures)."""
        return sides(self, joints)

    @property
    def has_sides(self) -> bool:
        """Can its posture be compared with that of another arm, side by side (rpl.emulator.postures)?"""
        return has_sides(self)

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
        return _from_urdf(Path(name_or_path))
    return _from_toml(name_or_path) if name_or_path.endswith(".toml") else _packaged(name_or_path)


@lru_cache(maxsize=256)
def _packaged(name: str) -> RobotModel:
    """An arm of the package's own, which nothing changes."""
    return _from_toml(name)


def _from_toml(name_or_path: str) -> RobotModel:
    file = read_robot_file(name_or_path)
    return _from_urdf(file.urdf, file) if file.urdf is not None else _from_file(file)


def _from_file(file: RobotFile) -> RobotModel:
    lengths = file.lengths
    kinds = ("revolute",) * len(file.home)
    arm: Arm
    if file.kind == "opw":
        arm = OpwArm(**{**lengths, "c1": 0.0 if file.origin_at_axis_2 else lengths["c1"]})
    elif file.kind == "ur":
        arm = UrArm(**lengths)
    else:
        arm = ScaraArm(**lengths)
        kinds = ("revolute", "revolute", "prismatic", "revolute")
    pendant_to_arm = np.diag(file.signs)
    if file.joint_3_follows_joint_2:
        pendant_to_arm[2, 1] = file.signs[2]
    return _assembled(file, file.kind, kinds, arm, pendant_to_arm, np.array(file.offsets))


def _assembled(
    file: RobotFile, kind: Kind, kinds: tuple[str, ...], arm: Arm, pendant_to_arm: FloatArray, offsets: FloatArray
) -> RobotModel:
    return RobotModel(
        name=file.name,
        maker=file.maker,
        title=file.title,
        kind=kind,
        joint_kinds=kinds,
        limits=_fixed(file.limits),
        speeds=_fixed(file.speeds),
        accelerations=_fixed(file.accelerations or [speed / RAMP_S for speed in file.speeds]),
        home=_fixed(file.home),
        notes=_notes(file),
        arm=arm,
        pendant_to_arm=_fixed(pendant_to_arm),
        arm_to_pendant=_fixed(np.linalg.inv(pendant_to_arm)),
        offsets=_fixed(offsets),
        unit=_fixed([np.pi / 180.0 if joint == "revolute" else 1.0 for joint in kinds]),
        pulses_per_degree=None if file.pulses_per_degree is None else _fixed(file.pulses_per_degree),
        counts_pulses=file.counts_pulses,
        motion=file.motion,
        motion_of=file.motion_of,
        uncertain_axes=bool({"speeds", "accelerations"} & set(file.assumed)) or file.accelerations is None,
        mechanisms=file.mechanisms,
        inertias=None if file.weights is None else arm_inertias(file.weights),
        lag=None if file.lag is None else _fixed(file.lag),
        foot_mm=-file.lengths["c1"] if file.origin_at_axis_2 else 0.0,
        payload_kg=file.payload_kg,
        bodies=file.bodies,
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


def _from_urdf(path: Path, file: RobotFile | None = None) -> RobotModel:
    """The arm of a URDF, in closed form when it is ortho-parallel, else solved by iteration.

    A robot file that points to the URDF supplies names, limits, speeds, home and pendant signs instead of the URDF.
    """
    chain = read_urdf(path, file.tip if file is not None else None)
    facts = file if file is not None else described(path, chain)
    count = len(chain.joints)
    if len(facts.home) != count:
        found = f"{count} moving joints lead to '{chain.tip}'"
        raise RobotError(f"{path.name}: {found}, but the robot file describes {len(facts.home)}")
    try:
        arm = ChainArm(chain)
        fit = exact_opw(arm)
    except ImportError as error:
        raise RobotError(f"reading {path.name} needs Pinocchio (pip install 'robot-rpl[kinematics]')") from error
    signs, offsets = np.array(facts.signs), np.array(facts.offsets)
    zero = np.zeros(count) if fit is None else fit.signs * fit.offsets  # where the family's own variables are zero
    inertias = urdf_inertias(chain, zero) if facts.weights is None else arm_inertias(facts.weights)
    if fit is None:
        model = _assembled(facts, "chain", chain.kinds, arm, np.diag(signs), offsets)
    else:
        offsets = fit.signs * offsets + np.rad2deg(fit.offsets)
        model = _assembled(facts, "opw", chain.kinds, fit.arm, np.diag(fit.signs * signs), offsets)
    return replace(model, inertias=inertias, urdf=UrdfSource(path, chain, _fixed(zero)))
