"""Neutral functions on the joints of the arm that runs: positions in motor pulses, and external axes put to a position.

Controllers that count positions in pulses need the arm's pulses per degree, which its file gives (`pulses_per_degree`);
an arm whose own controller does not count in pulses has a neutral scale (`RobotModel.pulse_scale`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl.emulator.mechanismfile import pulses_of
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import (
    AxesValue,
    ExternalValue,
    JointsValue,
    TargetValue,
    Value,
    needed,
    used_axes,
    whole,
)

if TYPE_CHECKING:
    from rpl.runtime.ports import Task

_NO_EXTERNAL = ExternalValue((None,) * 6)


def _pulses_per_degree(task: Task) -> list[float]:
    """One number for each axis of the arm."""
    model = task.robot.model if task.robot is not None else task.machine.model
    if model is None:
        raise ProgramError("motion", "positions in pulses need a robot (--robot)")
    if model.pulse_scale is None:
        raise ProgramError("motion", f"the file of robot {model.name} gives no pulses_per_degree")
    return [float(number) for number in model.pulse_scale]


def _joints_from_pulses(task: Task, *pulses: Value) -> JointsValue:
    """Joints in degrees. The zero position needs no pulses per degree."""
    counts = needed(pulses)
    if not any(counts):
        return JointsValue(AxesValue((0.0,) * 6), _NO_EXTERNAL)
    each = _pulses_per_degree(task)
    degrees = [count / per for count, per in zip(counts, each, strict=False)]
    return JointsValue(AxesValue((*degrees, *(0.0,) * 6)[:6]), _NO_EXTERNAL)


def _joint_pulses(task: Task, joints: Value, number: Value) -> int:
    """Pulses of one axis (1-based), to the nearest whole."""
    axes = joints.axes if isinstance(joints, JointsValue) else joints
    if not isinstance(axes, AxesValue):
        raise ProgramError("wrong_kind", "joints are needed here")
    place = whole(number) - 1
    if not 0 <= place < 6:
        raise ProgramError("out_of_range", f"there is no axis {place + 1}")
    degrees = needed(axes.values[place : place + 1])[0]
    if degrees == 0.0:
        return 0
    each = _pulses_per_degree(task)
    return math.floor(degrees * each[place] + 0.5) if place < len(each) else 0


def _external_from_pulses(task: Task, axes: Value) -> ExternalValue:
    """External axes in their own units, of counts of motor pulses; an axis whose pulses nobody has given keeps its
    number, which a run says beforehand."""
    given = axes.ext if isinstance(axes, TargetValue | JointsValue) else axes
    if not isinstance(given, ExternalValue):
        raise ProgramError("wrong_kind", "external axes are needed here")
    model = task.robot.model if task.robot is not None else task.machine.model
    scene = task.machine.scene
    neutral = model is not None and not model.counts_pulses
    done: list[float | None] = []
    for number, count in enumerate(used_axes(given.values), 1):
        each = pulses_of(scene.mechanisms, number, neutral)
        done.append(count if count is None or each is None else count / each)
    return ExternalValue(tuple(done))


def _with_external(position: Value, axes: Value) -> Value:
    """A target or joints with external axes; those that `axes` leaves out stay."""
    if not isinstance(position, TargetValue | JointsValue):
        raise ProgramError("wrong_kind", "a target or joints are needed here")
    given = axes.ext if isinstance(axes, TargetValue | JointsValue) else axes
    if not isinstance(given, ExternalValue):
        raise ProgramError("wrong_kind", "external axes are needed here")
    pairs = zip(used_axes(given.values), position.ext.values, strict=True)
    return position._replace(ext=ExternalValue(tuple(old if new is None else new for new, old in pairs)))


PURE: dict[str, Callable[..., Value]] = {"with_external": _with_external}
OF_TASK: dict[str, Callable[..., Value]] = {
    "joints_from_pulses": _joints_from_pulses,
    "joint_pulses": _joint_pulses,
    "external_from_pulses": _external_from_pulses,
}
