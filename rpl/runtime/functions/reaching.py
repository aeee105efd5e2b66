"""Neutral functions that ask for the arm near given joints, and sums of poses as controllers without frames have them.
Millimetres and degrees.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions.geometry import as_pose
from rpl.runtime.moves.chain import external_of, filled, frames_of, joints_of, joints_value, matrix_of
from rpl.runtime.tasks import robot_of
from rpl.runtime.values import PoseValue, TargetValue, Value, rotation_of

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.ports import Task


def _sum(one: Value, other: Value) -> PoseValue:
    first, second = as_pose(one), as_pose(other)
    turn = first.rot.rigid().then(second.rot.rigid())
    return PoseValue(first.trans + second.trans, rotation_of(turn, first.rot.convention))


def _difference(one: Value, other: Value) -> PoseValue:
    first, second = as_pose(one), as_pose(other)
    turn = second.rot.rigid().inverse.then(first.rot.rigid())
    return PoseValue(first.trans - second.trans, rotation_of(turn, first.rot.convention))


def _near(task: Task, target: Value, joints: Value, tool: Value = None, frame: Value = None) -> FloatArray | None:
    task.looked = task.looked_at_time = True
    robot = robot_of(task)
    if robot is None or robot.model is None:
        raise ProgramError("motion", "inverse kinematics need a robot")
    external = external_of(target, robot.external_now(), False)
    frames = frames_of(tool, frame, task.modal, {}, task.machine.scene, external)
    place, moving = frames.target_in_robot(filled(target, rigid.IDENTITY))
    near = np.array(joints_of(joints, [0.0] * robot.model.axes, False))
    flange = matrix_of(place.then(moving.inverse))
    flags = {name: int(value) for name, value in _flags(target) if value is not None}
    notation = task.machine.linked.notation(task.frame.code.rules.name) if flags else None
    found: FloatArray | None = (
        robot.model.nearest(flange, near)
        if notation is None
        else notation.select(robot.model, flange, flags, near).joints
    )
    return found


def _flags(target: Value) -> Iterable[tuple[str, Value]]:
    """The arm configuration that a target has."""
    return target.conf.flags if isinstance(target, TargetValue) else ()


def _target_to_joints_near(task: Task, target: Value, joints: Value, tool: Value = None, frame: Value = None) -> Value:
    found = _near(task, target, joints, tool, frame)
    if found is None:
        raise ProgramError("unreachable", "the target is out of reach")
    return joints_value([float(joint) for joint in found], (None,) * 6, task.frame.code.rules)


def _is_reachable(task: Task, target: Value, joints: Value, tool: Value = None, frame: Value = None) -> bool:
    return _near(task, target, joints, tool, frame) is not None


PURE: dict[str, Callable[..., Value]] = {"pose_sum": _sum, "pose_difference": _difference}
OF_TASK: dict[str, Callable[..., Value]] = {
    "target_to_joints_near": _target_to_joints_near,
    "is_reachable": _is_reachable,
}
