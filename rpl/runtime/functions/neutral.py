"""The neutral built-in functions: mathematics, geometry, kinematics. Texts stand in `rpl.runtime.functions.texts`.

`PURE` functions take values and give a value; `OF_TASK` functions also get the task that asks. Together they cover
`rpl.ir.FUNCTIONS` (a test proves it). Angles are degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl.passes import rigid
from rpl.passes.numeric import NUMERIC
from rpl.runtime import tasks
from rpl.runtime.faults import ProgramError, name_of
from rpl.runtime.functions import arcs, axes, geometry, reaching, texts
from rpl.runtime.functions.geometry import as_pose
from rpl.runtime.moves.chain import convention_of, external_of, filled, frames_of, joints_of, joints_value, matrix_of
from rpl.runtime.tasks import robot_of
from rpl.runtime.values import (
    Array,
    PoseValue,
    Record,
    RotationValue,
    StopWatch,
    TargetValue,
    Value,
    VectorValue,
    copied,
    needed,
    pose_of,
    rotation_of,
    vector_of,
    whole,
)

if TYPE_CHECKING:
    from rpl.runtime.ports import Task


# The widest whole numbers of any language have 64 bits.
MOST_SHIFTED = 64


def _shift(by: int) -> Callable[[Value, Value], int]:
    def shift(value: Value, count: Value) -> int:
        number, places = whole(value), whole(count)
        if by > 0 and places > MOST_SHIFTED:
            raise ProgramError("overflow", f"a number has no bit {places}")
        return number << places if by > 0 else number >> places

    return shift


def _length(value: Value) -> int:
    if isinstance(value, Array):
        return len(value.items)
    if isinstance(value, str):
        return len(value)
    raise ProgramError("wrong_kind", "only arrays and texts have a length")


def _dimension(value: Value, number: Value) -> int:
    for _ in range(whole(number) - 1):
        if not isinstance(value, Array) or not value.items:
            raise ProgramError("out_of_range", "the array has not so many dimensions")
        value = value.items[0]
    return _length(value)


# ---- geometry


def compose(left: Value, right: Value) -> Value:
    """`left : right`: of rotations, of poses, of a pose and a point. The result is of the right operand's type."""
    if isinstance(left, RotationValue) and isinstance(right, RotationValue):
        return rotation_of(left.rigid().then(right.rigid()), right.convention)
    base = left.rigid() if isinstance(left, PoseValue) else None
    if base is None and isinstance(left, VectorValue):
        base = rigid.Pose(rigid.Vector(*needed(left)), rigid.NO_TURN)
    if base is None and isinstance(left, RotationValue):
        base = rigid.Pose(rigid.IDENTITY.position, left.rigid())
    if base is None:
        base = as_pose(left).rigid()
    if isinstance(right, VectorValue):
        return vector_of(base.place(rigid.Vector(*needed(right))))
    pose = as_pose(right)
    product = pose_of(base.then(pose.rigid()), pose.rot.convention)
    if isinstance(right, TargetValue):
        conf = right.conf._replace(flags=tuple((name, None) for name, _ in right.conf.flags))
        return TargetValue(product, conf, right.ext)
    return product


def inverse(value: Value) -> PoseValue:
    pose = as_pose(value)
    return pose_of(pose.rigid().inverse, pose.rot.convention)


def _transform(pose: Value, vector: VectorValue) -> VectorValue:
    return vector_of(as_pose(pose).rigid().place(rigid.Vector(*needed(vector))))


def _moved(value: Value, pose: PoseValue) -> Value:
    return value._replace(pose=pose) if isinstance(value, TargetValue) else pose


def _offset(value: Value, x: float, y: float, z: float) -> Value:
    pose = as_pose(value)
    return _moved(value, PoseValue(pose.trans + VectorValue(x, y, z), pose.rot))


def _tool_offset(value: Value, x: float, y: float, z: float, *turns: float) -> Value:
    pose = as_pose(value)
    done = pose.rigid().then(rigid.Pose(rigid.Vector(x, y, z), rigid.NO_TURN))
    rx, ry, rz = (*turns, 0.0, 0.0, 0.0)[:3]
    for angles in ((0.0, 0.0, rx), (0.0, ry, 0.0), (rz, 0.0, 0.0)):
        if any(angles):
            done = done.then(rigid.Pose(rigid.IDENTITY.position, rigid.rotation_of_zyx(*angles)))
    if not any(turns):
        return _moved(value, PoseValue(vector_of(done.position), pose.rot))
    return _moved(value, pose_of(done, pose.rot.convention))


def cross(left: VectorValue, right: VectorValue) -> VectorValue:
    return vector_of(rigid.Vector(*needed(left)).cross(rigid.Vector(*needed(right))))


def _normalise(rotation: RotationValue) -> RotationValue:
    if rotation.convention != "quaternion":
        return rotation
    found = rigid.rotation_of_quaternion(*needed(rotation.parts))
    if found is None:
        raise ProgramError("bad_rotation", "a quaternion of length 0 has no direction")
    return RotationValue("quaternion", found.quaternion)


def _euler(place: int) -> Callable[[RotationValue], float]:
    return lambda rotation: rotation.rigid().zyx[place]


def _frame_from_points(one: VectorValue, two: VectorValue, three: VectorValue, origin: float = 1) -> PoseValue:
    """x axis from the first to the second point, the third on the side of positive y. Origin: 1 the first point, 2 the
    second, 3 on the line so that the third point lies on the y axis."""
    first, second, third = (rigid.Vector(*needed(point)) for point in (one, two, three))
    along = second.plus(first, -1.0)
    across = along.cross(third.plus(first, -1.0))
    if along.length < 1e-9 or across.length < 1e-9:
        raise ProgramError("negative_argument", "three points on a line give no frame")
    x, z = along.times(1.0 / along.length), across.times(1.0 / across.length)
    y = z.cross(x)
    turn = rigid.rotation_of_rows(((x.x, y.x, z.x), (x.y, y.y, z.y), (x.z, y.z, z.z)))
    place = {2: second, 3: first.plus(x, third.plus(first, -1.0).dot(x))}.get(whole(origin), first)
    return PoseValue(vector_of(place), rotation_of(turn, "quaternion"))


PURE: dict[str, Callable[..., Value]] = {
    **NUMERIC,
    "bit_shift_left": _shift(1),
    "bit_shift_right": _shift(-1),
    "length": _length,
    "dimension": _dimension,
    "inverse": inverse,
    "compose": compose,
    "transform": _transform,
    "offset": _offset,
    "tool_offset": _tool_offset,
    "distance": lambda one, two: math.dist(needed(one), needed(two)),
    "magnitude": lambda vector: math.hypot(*needed(vector)),
    "dot": lambda one, two: sum(p * q for p, q in zip(needed(one), needed(two), strict=True)),
    "normalise": _normalise,
    "euler_x": _euler(2),
    "euler_y": _euler(1),
    "euler_z": _euler(0),
    "rotation_zyx": lambda a, b, c: rotation_of(rigid.rotation_of_zyx(a, b, c), "quaternion"),
    "frame_from_points": _frame_from_points,
    "pose_of": as_pose,
    "sign": lambda value: (value > 0) - (value < 0),
    "fraction": lambda value: value - math.trunc(value),
    "log10": math.log10,
    **geometry.PURE,
    **reaching.PURE,
    **arcs.PURE,
    **axes.PURE,
    **texts.PURE,
}


# ---- what depends on the task that asks


def _current_target(task: Task, tool: Value = None, frame: Value = None) -> Value:
    return _robot(task).target_now(tool, frame, task.frame.code.rules)


def _current_position(task: Task, tool: Value = None, frame: Value = None) -> Value:
    return _current_target(task, tool, frame).pose.trans


def _current_joints(task: Task) -> Value:
    return _robot(task).joints_as_value(task.frame.code.rules)


def _robot(task: Task) -> Value:
    task.looked = task.looked_at_time = True
    robot = robot_of(task)
    if robot is None:
        raise ProgramError("motion", f"task {task.name} has no robot")
    return robot


def _target_to_joints(task: Task, target: Value, tool: Value = None, frame: Value = None) -> Value:
    robot, rules = _robot(task), task.frame.code.rules
    if robot.model is None:
        raise ProgramError("motion", "inverse kinematics need a robot")
    external = external_of(target, robot.external_now(), False)
    frames = frames_of(tool, frame, task.modal, {}, task.machine.scene, external)
    here = robot.joints_array()
    place, moving = frames.target_in_robot(filled(target, rigid.IDENTITY))
    flange = matrix_of(place.then(moving.inverse))
    notation = task.machine.linked.notation(rules.name)
    if notation is None or not isinstance(target, TargetValue):
        joints = robot.model.nearest(flange, here)
    else:
        flags = {name: None if value is None else int(value) for name, value in target.conf.flags}
        found = notation.select(robot.model, flange, flags, here)
        if found.joints is None:
            raise ProgramError("unreachable", f"{found.reason}: {_where(place)}")
        joints = found.joints
    if joints is None:
        raise ProgramError("unreachable", f"the target is out of reach: {_where(place)}")
    external = target.ext.values if isinstance(target, TargetValue) else (None,) * 6
    return joints_value([float(joint) for joint in joints], external, rules)


def _where(place: rigid.Pose) -> str:
    """Where the tool should be, in the robot's base."""
    x, y, z = place.position.x, place.position.y, place.position.z
    return f"{x:.3f}, {y:.3f}, {z:.3f} mm"


def _joints_to_target(task: Task, joints: Value, tool: Value = None, frame: Value = None) -> Value:
    import numpy as np

    robot = _robot(task)
    if robot.model is None:
        raise ProgramError("motion", "forward kinematics need a robot")
    here = np.array(joints_of(joints, [0.0] * robot.model.axes, False))
    external = external_of(joints, robot.external_now(), False)
    return robot.target_now(tool, frame, task.frame.code.rules, here, external)


def _modal(task: Task, set: str, used: str) -> Value:
    """The tool or frame that the program has set, else that of its last move where the language counts it."""
    value = task.modal.get(set)
    return task.modal.get(used) if value is None and task.frame.code.rules.last_tool else value


def tool_pose(task: Task) -> rigid.Pose:
    """The tool that the task has now, in the flange."""
    value = _modal(task, "tool", "tool_in_use")
    frame = value.parts.get("frame") if isinstance(value, Record) else value
    return as_pose(frame if frame is not None else identity(task)).rigid()


def _current_tool(task: Task) -> Value:
    value = _modal(task, "tool", "tool_in_use")
    if isinstance(value, Record):
        return copied(value)
    pose = value if value is not None else identity(task)
    return Record("tool", {"held": True, "frame": as_pose(pose), "load": task.modal.get("load")})


def _current_frame(task: Task) -> Value:
    value = _modal(task, "base", "frame_in_use")
    if isinstance(value, Record):
        return copied(value)
    pose = as_pose(value) if value is not None else identity(task)
    none = identity(task)
    parts = {"held": False, "fixed": True, "unit": "", "user_frame": pose, "object_frame": none}
    return Record("workobject", parts)


def identity(task: Task) -> PoseValue:
    """The identity pose as the task's language writes it."""
    return pose_of(rigid.IDENTITY, convention_of(task.frame.code.rules))


def _clock_seconds(task: Task, clock: StopWatch) -> float:
    task.looked = task.looked_at_time = True
    return clock.seconds(task.machine.now)


def _time_text(task: Task) -> str:
    task.looked = task.looked_at_time = True
    seconds = int(task.machine.now)
    return f"{seconds // 3600 % 24:02d}:{seconds // 60 % 60:02d}:{seconds % 60:02d}"


def _date_text(task: Task) -> str:
    """Runs are repeatable, so all of them happen on one day."""
    return "2000-01-01"


OF_TASK: dict[str, Callable[..., Value]] = {
    "current_target": _current_target,
    "current_joints": _current_joints,
    "current_position": _current_position,
    "target_to_joints": _target_to_joints,
    "joints_to_target": _joints_to_target,
    **axes.OF_TASK,
    **reaching.OF_TASK,
    "current_tool": _current_tool,
    "current_frame": _current_frame,
    "clock_seconds": _clock_seconds,
    "time_text": _time_text,
    "date_text": _date_text,
    "random": lambda task: task.machine.random.random(),
    "text_value": lambda task, text: texts.text_value(
        text, task.frame.code.rules.number_marks, task.frame.code.rules.leading_numbers
    ),
    "value_text": lambda task, value: texts.shown_value(value, task.frame.code.rules.text_decimals),
    "task_runs": lambda task, name: tasks.runs(task, str(name)),
    "error_text": lambda task, number: name_of(number, task.frame.code.rules.errors),
}
# Compiled by linking itself, because they need the place or the type of their argument, not its value.
BY_PLACE = frozenset(("is_uninitialised", "text_capacity"))
# These see the clock or the robot: a condition that asks them is looked at again and again.
TIME_DEPENDENT = frozenset(
    ("clock_seconds", "current_target", "current_joints", "current_position", "time_text", "random")
)
