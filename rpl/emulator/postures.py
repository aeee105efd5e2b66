"""The posture that words ask for, one by one (V+ LEFTY, ABOVE, FLIP), the same posture on another arm, and which builds
of arms have postures that flags name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.arms import ON_AXIS_MM, ON_LINE_RAD, OpwArm, ScaraArm, UrArm
from rpl.emulator.recognise import PlacedArm

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray, IntArray

ASKED_POSTURES = ("posture_shoulder", "posture_elbow", "posture_wrist")
# Which side of a branch a word asks for: 1 is behind axis 1, elbow down (seen from outside), wrist turned over.
_SIDES = {"front": 0, "back": 1, "up": 0, "down": 1, "noflip": 0, "flip": 1}

UNKNOWN_BUILD = "what configuration flags mean on an arm of this build is not known"


def has_flags(model: RobotModel) -> bool:
    """Is it an arm of a build that controllers' flags are written for? Arms of seven axes, or with a wrist whose axes
    do not meet, have flags too, but by rules of their own."""
    arm = model.arm.arm if isinstance(model.arm, PlacedArm) else model.arm
    return isinstance(arm, OpwArm | UrArm | ScaraArm)


def has_sides(model: RobotModel) -> bool:
    """Do shoulder, elbow and wrist have sides that mean the same on each arm of this build: axes 2 and 3 parallel and
    a wrist whose axes meet?"""
    return isinstance(model.arm, OpwArm)


def out_of_reach(model: RobotModel, flange: FloatArray) -> str | None:
    """Why no posture at all reaches a flange pose (4, 4), where there is more to say than that it is too far."""
    if isinstance(model.arm, ScaraArm) and not model.inverse(flange):
        tilt = float(np.degrees(np.arctan2(np.hypot(flange[0, 2], flange[1, 2]), -flange[2, 2])))
        if tilt > np.degrees(model.arm.tilt):
            return f"this arm's tool axis is always vertical, the pose tilts it by {tilt:.3g} degrees"
    return None


def sides(model: RobotModel, joints: FloatArray) -> IntArray:
    """Shoulder, elbow and wrist (..., 3) of joints (..., n), 0 or 1 as in rpl.emulator.arms.Branch. What lies on a
    boundary within rounding is on the near side of it."""
    theta = model.theta(joints)
    arm = model.arm.arm if isinstance(model.arm, PlacedArm) else model.arm
    if isinstance(arm, OpwArm):
        reach, _ = arm.in_plane(theta)
        bend, wrist = _half_turn(theta[..., 2] + arm.elbow_angle), _half_turn(theta[..., 4])
        return np.stack([reach < -ON_AXIS_MM, bend < -ON_LINE_RAD, wrist < -ON_LINE_RAD], axis=-1).astype(np.int64)
    flat = theta.reshape(-1, model.axes)
    found = [(one.shoulder, one.elbow, one.wrist) for one in map(arm.branch, flat)]
    return np.array(found, dtype=np.int64).reshape(*theta.shape[:-1], 3)


def _half_turn(angle: FloatArray) -> FloatArray:
    """Radians into [-pi, pi), those inside untouched."""
    return np.where(np.abs(angle) <= np.pi, angle, (angle + np.pi) % (2.0 * np.pi) - np.pi)


def same_posture(source: RobotModel, joints: FloatArray, other: RobotModel) -> FloatArray:
    """Joints (..., n) of another arm whose own angles are those of `joints` (..., n) on `source`; its home position
    (n,) where the two are not of one build. The half turn by which flanges may differ counts upwards: axis 6 at 0 on an
    arm whose flange is not turned is +180 on one whose is, as controllers' own joints show (180 - axis 6)."""
    if not (isinstance(source.arm, OpwArm) and isinstance(other.arm, OpwArm)):
        return np.array(other.home)
    before, after = (arm.canonical(arm.arm_to_pendant @ arm.offsets) for arm in (source, other))
    angles = (source.theta(joints) - source.theta(before)) / other.unit
    return np.asarray(after + angles @ other.arm_to_pendant.T)


def in_posture(model: RobotModel, flange: FloatArray, near: FloatArray, asked: Mapping[str, str]) -> FloatArray | None:
    """Joints (n,) for a flange pose (4, 4) in the posture asked for; what is not asked for stays as it is at `near`
    (n,), and each axis takes its shortest way from there. None: out of reach or of an axis's limits."""
    wanted = _wanted_branch(model, near, asked)
    for solution in model.inverse(flange, near):
        branch = solution.branch
        if (branch.shoulder, branch.elbow, branch.wrist) == wanted:
            joints = model.nearest_turn(solution.joints, near)
            if not model.within_limits(joints):
                return joints
    return None


def _wanted_branch(model: RobotModel, near: FloatArray, asked: Mapping[str, str]) -> tuple[int, int, int]:
    """Shoulder, joint-sided elbow and wrist: as asked for, else as the arm has them. What an arm cannot choose is
    ignored; an arm whose only choice is the elbow (SCARA) takes what is asked of the shoulder for it (V+ LEFTY)."""
    now = model.posture(near).branch
    shoulder, elbow, wrist = (_SIDES.get(asked.get(name, "")) for name in ASKED_POSTURES)
    shoulders = {branch.shoulder for branch in model.arm.branches}
    if len(shoulders) == 1:
        return now.shoulder, now.elbow if shoulder is None else shoulder, now.wrist
    if shoulder is None:
        shoulder = now.shoulder
    outside = now.elbow ^ now.shoulder if elbow is None else elbow
    return shoulder, outside ^ shoulder, now.wrist if wrist is None else wrist
