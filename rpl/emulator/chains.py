"""Serial arms given as a URDF: reading the chain, and solving the arms that no closed form fits by iteration.

A URDF leads to the same `Arm` as a robot file does. This is the one module of the kinematics that imports Pinocchio,
and only inside the functions, so that arms of the closed-form families load without it.
"""

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.arms import Branch, Branches
from rpl.emulator.inertias import ArmInertias, Body
from rpl.emulator.recognise import OpwFit, fit_opw
from rpl.emulator.robotfile import RobotError, RobotFile
from rpl.emulator.rotations import FloatArray
from rpl.emulator.urdfnumbers import check_numbers, line_of_part
from rpl.source import read_bytes

if TYPE_CHECKING:
    import pinocchio as pin  # ships no type information


@dataclass(frozen=True, slots=True)
class UrdfChain:
    """The moving joints between a URDF's root and one of its links, limits and speeds in degrees or mm (per second)."""

    text: str
    tip: str
    joints: tuple[str, ...]
    kinds: tuple[str, ...]
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]


def read_urdf(path: Path, tip: str | None) -> UrdfChain:
    """The chain to the link `tip`, else to a link with a tool's usual name, else the longest; `RobotError` if none."""
    try:
        written = read_bytes(path).decode("utf-8")
        tree = ET.fromstring(written)
    except OSError as error:
        raise RobotError(f"robot file {path} cannot be read: {error.strerror}") from error
    except (ET.ParseError, UnicodeDecodeError) as error:
        raise RobotError(f"{path.name} is no URDF: {error}") from error
    check_numbers(path, written, tree)
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
    facts = [_limits(path, written, joint) for joint in joints]
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


def _limits(path: Path, written: str, joint: ET.Element) -> tuple[float, float, float]:
    """Lower, upper and speed of a joint in degrees or mm; a missing speed is a full turn in 2 s, or 1 m/s."""
    limit = joint.find("limit")
    sliding = joint.get("type") == "prismatic"
    scale = 1000.0 if sliding else 180.0 / np.pi
    values = {} if limit is None else limit.attrib
    name = joint.get("name", "")
    place = f"{path.name}:{line_of_part(written, 'joint', name, 'limit')}: joint '{name}'"
    numbers = []
    for key in ("lower", "upper", "velocity"):
        text = values.get(key, "0")
        try:
            number = float(text)
        except ValueError:
            number = np.nan
        if not np.isfinite(number):
            raise RobotError(f"{place}: the limit's '{key}' is '{text}', which is no number")
        numbers.append(number * scale)
    low, high, speed = numbers
    if low > high:
        raise RobotError(f"{place}: the limit's 'lower', {low:g}, is above its 'upper', {high:g}")
    if speed < 0.0:
        raise RobotError(f"{place}: the limit's 'velocity' is below zero")
    return low, high, speed if speed > 0.0 else (1000.0 if sliding else 180.0)


def described(path: Path, chain: UrdfChain) -> RobotFile:
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


def exact_opw(arm: "ChainArm") -> OpwFit | None:
    """The closed form of this chain when one reproduces it exactly (1e-5 mm, 1e-8 in the rotation)."""
    zero = np.zeros(len(arm.chain.kinds))
    tip = arm.forward(zero)  # here a URDF that Pinocchio cannot read is refused, whatever its joints
    if arm.chain.kinds != ("revolute",) * 6:
        return None
    fit = fit_opw(*arm.axes(zero), tip)
    if fit is None:
        return None
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (20, 6))
    difference = np.abs(fit.arm.forward(q * fit.signs - fit.offsets) - arm.forward(q))
    return fit if difference[:, :3, 3].max() < 1e-5 and difference[:, :3, :3].max() < 1e-8 else None


def urdf_inertias(chain: UrdfChain, zero: FloatArray) -> ArmInertias | None:
    """What the URDF says of masses and efforts, its joints (radians, mm) standing at `zero`; None without masses.
    Links that hang beside the chain count to the link that carries them."""
    import pinocchio as pin

    model, data, _ = _pinocchio(chain)
    scale = np.array([1.0 if kind == "revolute" else 1e-3 for kind in chain.kinds])
    pin.forwardKinematics(model, data, zero * scale)
    bodies = []
    for number in range(1, model.njoints):
        inertia, pose = model.inertias[number], data.oMi[number].homogeneous.copy()
        pose[:3, 3] *= 1000.0
        bodies.append(Body(inertia.mass, inertia.lever * 1000.0, np.array(inertia.inertia)).seen_from(pose))
    if not any(body.mass > 0.0 for body in bodies):
        return None
    efforts = np.array(model.effortLimit, dtype=np.float64)
    known = np.isfinite(efforts) & (efforts > 0.0)
    return ArmInertias(tuple(bodies), np.where(known, efforts, 0.0) if known.any() else None, None, "URDF")


def joint_origins(chain: UrdfChain, zero: FloatArray) -> FloatArray:
    """Where the origins of the joints are (n, 3), mm in the base, its joints (radians, mm) standing at `zero`."""
    import pinocchio as pin

    model, data, _ = _pinocchio(chain)
    pin.forwardKinematics(model, data, _in_metres(chain, zero))
    return 1000.0 * np.array([data.oMi[number].translation for number in range(1, model.njoints)])


def body_frames(chain: UrdfChain, zero: FloatArray) -> dict[str, tuple[int, FloatArray]]:
    """For each link of the URDF by name: the number of the joint that moves it (0: it stands still), and its frame
    (4, 4) in mm in the base, the joints of the chain (radians, mm) standing at `zero`."""
    import pinocchio as pin

    model, data, _ = _pinocchio(chain)
    pin.framesForwardKinematics(model, data, _in_metres(chain, zero))
    found = {}
    for number, frame in enumerate(model.frames):
        if frame.type == pin.FrameType.BODY:
            pose = data.oMf[number].homogeneous.copy()
            pose[:3, 3] *= 1000.0
            found[frame.name] = (int(frame.parentJoint), pose)
    return found


def _in_metres(chain: UrdfChain, joints: FloatArray) -> FloatArray:
    return np.asarray(joints * np.array([1.0 if kind == "revolute" else 1e-3 for kind in chain.kinds]))


@lru_cache(maxsize=16)
def _pinocchio(chain: UrdfChain) -> "tuple[pin.Model, pin.Data, int]":
    """Pinocchio's model of the chain with every other joint held, its work space, and the frame of the tip."""
    import pinocchio as pin

    try:
        whole = pin.buildModelFromXML(chain.text)
    except ValueError as error:
        raise RobotError(f"the URDF of '{chain.tip}' describes no robot: {str(error).strip()}") from error
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
            twists = pin.computeJointJacobians(model, data, row).reshape(6, -1).T
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
