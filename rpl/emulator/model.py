"""A robot as its controller shows it: joints in pendant units and signs, flange poses in its own base frame.

`load_robot` gives a `RobotModel`; forward, inverse, turns, limits and the Jacobian are its methods. All joint vectors
that cross this module are the robot's own (degrees, mm for a sliding joint; coupled joints as the pendant shows them),
so no caller ever converts signs. The closed-form families need NumPy only. This is the one module that imports
Pinocchio, and only inside the functions that read a URDF and solve an arm that no closed form fits.
"""

import itertools
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.arms import Arm, BoolArray, Branch, Branches, OpwArm, ScaraArm, UrArm
from rpl.emulator.closedforms import ClosedForm, closed_form
from rpl.emulator.postures import Fact, in_posture, posture_facts
from rpl.emulator.recognise import OpwFit, fit_opw
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

if TYPE_CHECKING:
    import pinocchio as pin  # ships no type information

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
# Pulses per degree (or mm) of arms whose own controller counts none, for programs of controllers that do. Neutral: one
# count is 0.0001 degrees, as in other angles of such programs.
NEUTRAL_PULSES = 10000.0


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
    pulses_per_degree: FloatArray | None = None  # motor pulses, of arms whose controller counts positions in them
    counts_pulses: bool = True  # whether the maker's own controller does, or nobody has said that it does not

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

    def in_posture(self, flange: FloatArray, near: FloatArray, asked: Mapping[str, str]) -> FloatArray | None:
        """The joints (n,) for a flange pose (4, 4) in the posture that words ask for (rpl.emulator.postures)."""
        return in_posture(self, flange, near, asked)

    def posture_facts(self) -> dict[str, Fact]:
        """The posture as inequalities over the joints; empty where the arm's build has none."""
        return posture_facts(self)

    def closed_form(self) -> ClosedForm | None:
        """The inverse as plain numbers (rpl.emulator.closedforms); None where the arm's build has none."""
        return closed_form(self)

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
    chain = _read_urdf(path, file.tip if file is not None else None)
    described = file if file is not None else _described(path, chain)
    count = len(chain.joints)
    if len(described.home) != count:
        found = f"{count} moving joints lead to '{chain.tip}'"
        raise RobotError(f"{path.name}: {found}, but the robot file describes {len(described.home)}")
    try:
        arm = ChainArm(chain)
        fit = _exact_opw(arm)
    except ImportError as error:
        raise RobotError(f"reading {path.name} needs Pinocchio (pip install 'robot-rpl[kinematics]')") from error
    signs, offsets = np.array(described.signs), np.array(described.offsets)
    if fit is None:
        return _assembled(described, "chain", chain.kinds, arm, np.diag(signs), offsets)
    offsets = fit.signs * offsets + np.rad2deg(fit.offsets)
    return _assembled(described, "opw", chain.kinds, fit.arm, np.diag(fit.signs * signs), offsets)


@dataclass(frozen=True, slots=True)
class UrdfChain:
    """The moving joints between a URDF's root and one of its links, limits and speeds in degrees or mm (per second)."""

    text: str
    tip: str
    joints: tuple[str, ...]
    kinds: tuple[str, ...]
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]


def _read_urdf(path: Path, tip: str | None) -> UrdfChain:
    try:
        tree = ET.fromstring(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RobotError(f"robot file {path} cannot be read: {error.strerror}") from error
    except ET.ParseError as error:
        raise RobotError(f"{path.name} is no URDF: {error}") from error
    leading: dict[str, ET.Element] = {}
    for joint in tree.findall("joint"):
        child = joint.find("child")
        leading["" if child is None else child.get("link", "")] = joint
    chains = {link: _moving_joints(link, leading) for link in leading}
    if tip is None:
        named = [link for link in ("tool0", "flange", "tool_flange", "ee_link") if link in chains]
        tip = named[0] if named else max(chains, key=lambda link: len(chains[link]), default="")
    joints = chains.get(tip, [])
    if not joints:
        raise RobotError(f"{path.name}: no moving joint leads to the link '{tip}'")
    mimics = [joint.get("name", "") for joint in joints if joint.find("mimic") is not None]
    if mimics:
        raise RobotError(f"{path.name}: joint '{mimics[0]}' follows another one, which is not supported inside the arm")
    for joint in joints:
        _bound(joint)
    facts = [_limits(joint) for joint in joints]
    return UrdfChain(
        text=ET.tostring(tree, encoding="unicode"),
        tip=tip,
        joints=tuple(joint.get("name", "") for joint in joints),
        kinds=tuple(joint.get("type", "") for joint in joints),
        limits=tuple((low, high) for low, high, _ in facts),
        speeds=tuple(speed for _, _, speed in facts),
    )


def _moving_joints(link: str, leading: dict[str, ET.Element]) -> list[ET.Element]:
    """Joints from the root to a link, fixed ones left out."""
    joints: list[ET.Element] = []
    while link in leading and len(joints) <= len(leading):
        joint = leading[link]
        if joint.get("type") in ("revolute", "continuous", "prismatic"):
            joints.append(joint)
        parent = joint.find("parent")
        link = "" if parent is None else parent.get("link", "")
    return joints[::-1]


def _bound(joint: ET.Element) -> None:
    """Make an endless joint a revolute one of two turns: Pinocchio would give it two configuration values."""
    limit = joint.find("limit")
    if limit is None:
        limit = ET.SubElement(joint, "limit", {"effort": "0", "velocity": "0", "lower": "0", "upper": "0"})
    if joint.get("type") == "continuous":
        joint.set("type", "revolute")
        limit.set("lower", str(-2.0 * np.pi))
        limit.set("upper", str(2.0 * np.pi))


def _limits(joint: ET.Element) -> tuple[float, float, float]:
    """Lower, upper and speed of a joint in degrees or mm; a missing speed is a full turn in 2 s, or 1 m/s."""
    limit = joint.find("limit")
    sliding = joint.get("type") == "prismatic"
    scale = 1000.0 if sliding else 180.0 / np.pi
    values = {} if limit is None else limit.attrib
    low, high, speed = (float(values.get(key, "0")) * scale for key in ("lower", "upper", "velocity"))
    return low, high, speed if speed > 0.0 else (1000.0 if sliding else 180.0)


def _described(path: Path, chain: UrdfChain) -> RobotFile:
    """The robot file that a bare URDF stands for: zero is home where the limits allow it."""
    count = len(chain.joints)
    return RobotFile(
        name=path.stem,
        maker="",
        title=path.stem,
        kind="chain",
        source=path.name,
        assumed=(),
        notes=(f"Read from {path.name}; joints are the URDF's own, in degrees or mm.",),
        lengths={},
        offsets=(0.0,) * count,
        signs=(1.0,) * count,
        joint_3_follows_joint_2=False,
        origin_at_axis_2=False,
        limits=chain.limits,
        speeds=chain.speeds,
        accelerations=None,
        home=tuple(float(np.clip(0.0, low, high)) for low, high in chain.limits),
        urdf=path,
        tip=chain.tip,
    )


def _exact_opw(arm: "ChainArm") -> OpwFit | None:
    """The closed form of this chain when one reproduces it exactly (1e-5 mm, 1e-8 in the rotation)."""
    if arm.chain.kinds != ("revolute",) * 6:
        return None
    zero = np.zeros(6)
    fit = fit_opw(*arm.axes(zero), arm.forward(zero))
    if fit is None:
        return None
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (20, 6))
    difference = np.abs(fit.arm.forward(q * fit.signs - fit.offsets) - arm.forward(q))
    return fit if difference[:, :3, 3].max() < 1e-5 and difference[:, :3, :3].max() < 1e-8 else None


@lru_cache(maxsize=16)
def _pinocchio(chain: UrdfChain) -> "tuple[pin.Model, pin.Data, int]":
    """Pinocchio's model of the chain with every other joint held, its work space, and the frame of the tip."""
    import pinocchio as pin

    whole = pin.buildModelFromXML(chain.text)
    others = [i for i in range(1, whole.njoints) if whole.names[i] not in chain.joints]
    model = pin.buildReducedModel(whole, others, pin.neutral(whole))
    return model, model.createData(), model.getFrameId(chain.tip)


# Restarts of the iterative solver and steps of each; the seeds are always the same, so runs are repeatable.
RESTARTS = 30
STEPS = 80


@dataclass(frozen=True, slots=True)
class ChainArm:
    """Any serial arm of a URDF, solved by damped least squares: one solution, the one reached from the reference.

    Only when the way from the reference does not converge inside the joint limits are the fixed seeds tried. theta in
    radians and mm.
    """

    chain: UrdfChain

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (Branch(0, 0, 0),)

    def _metres(self) -> FloatArray:
        return np.array([1.0 if kind == "revolute" else 1e-3 for kind in self.chain.kinds])

    def forward(self, theta: FloatArray) -> FloatArray:
        import pinocchio as pin

        model, data, frame = _pinocchio(self.chain)
        rows = np.atleast_2d(theta * self._metres())
        poses = np.empty((len(rows), 4, 4))
        for row, pose in zip(rows.reshape(-1, model.nq), poses, strict=True):
            pin.framesForwardKinematics(model, data, row)
            pose[:] = data.oMf[frame].homogeneous
        poses[:, :3, 3] *= 1000.0
        return poses.reshape(*theta.shape[:-1], 4, 4)

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        import pinocchio as pin

        model, data, _ = _pinocchio(self.chain)
        rows = np.atleast_2d(theta * self._metres())
        turning = np.array([kind == "revolute" for kind in self.chain.kinds])[:, None]
        points, directions = np.empty((len(rows), model.nq, 3)), np.empty((len(rows), model.nq, 3))
        for i, row in enumerate(rows):
            twists = pin.computeJointJacobians(model, data, row).T
            linear, angular = twists[:, :3], twists[:, 3:]
            # The point of a screw nearest to the origin is w x v.
            points[i] = np.where(turning, 1000.0 * np.cross(angular, linear), 0.0)
            directions[i] = np.where(turning, angular, linear)
        shape = (*theta.shape, 3)
        return points.reshape(shape), directions.reshape(shape)

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        theta = np.full((len(flange), 1, len(self.chain.joints)), np.nan)
        for i, (pose, near) in enumerate(zip(flange, reference, strict=True)):
            found = self._solve(pose, near * self._metres())
            if found is not None:
                theta[i, 0] = found / self._metres()
        valid = ~np.isnan(theta[:, :, 0])
        return Branches(theta, valid, np.zeros_like(valid))

    def _solve(self, pose: FloatArray, near: FloatArray) -> FloatArray | None:
        import pinocchio as pin

        model, _, _ = _pinocchio(self.chain)
        target = pin.SE3(pose[:3, :3], pose[:3, 3] / 1000.0)
        low, high = model.lowerPositionLimit, model.upperPositionLimit
        found = self._descend(target, np.clip(near, low, high))
        seeds = np.random.default_rng(0).uniform(low, high, (RESTARTS, model.nq))
        for seed in seeds:
            if found is not None:
                break
            found = self._descend(target, seed)
        return found

    def _descend(self, target: "pin.SE3", q: FloatArray) -> FloatArray | None:
        """Damped least squares inside the limits, the damping growing with the error (after Sugihara 2011)."""
        import pinocchio as pin

        model, data, frame = _pinocchio(self.chain)
        low, high = model.lowerPositionLimit, model.upperPositionLimit
        for _ in range(STEPS):
            pin.framesForwardKinematics(model, data, q)
            error = pin.log6(data.oMf[frame].actInv(target)).vector
            size = float(np.linalg.norm(error))
            if size < 1e-11:
                return q
            jacobian = pin.computeFrameJacobian(model, data, q, frame)
            # Near the goal the damping vanishes with the error, so the last steps converge quadratically.
            damping = min(0.01, size * size) + 1e-14
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping * np.eye(6), error)
            longest = float(np.abs(step).max())
            q = np.clip(q + step * min(1.0, 0.5 / max(longest, 1e-12)), low, high)
        return q if size < 1e-9 else None

    def branch(self, theta: FloatArray) -> Branch:
        del theta
        return self.branches[0]
