"""The neutral system variables: what reading and writing each one does. `READ` and `WRITE` together cover
`rpl.ir.SYSTEM_VARIABLES` (a test proves it); what is merely modal is kept in the task's table under its own name.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl import ir
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions.neutral import identity
from rpl.runtime.moves import presentmove
from rpl.runtime.moves.chain import DEFAULTS
from rpl.runtime.tasks import robot_of
from rpl.runtime.values import Member, Record, StopWatch, Value, copied, whole
from rpl.runtime.waits import CYCLE_S

if TYPE_CHECKING:
    from rpl.runtime.ports import Robot, Task

Read = Callable[["Task", int], Value]
Write = Callable[["Task", int, Value], None]


def _robot(task: Task) -> Robot:
    task.looked = task.looked_at_time = True
    robot = robot_of(task)
    if robot is None:
        raise ProgramError("motion", f"task {task.name} has no robot")
    return robot


def _rules(task: Task) -> Value:
    return task.frame.code.rules


def _actual_joint(task: Task, index: int) -> Value:
    joints = _robot(task).joints_as_value(_rules(task))
    return joints.get(f"j{index}")


def _end_pose(task: Task, index: int) -> Value:
    robot = _robot(task)
    found = presentmove.ends(robot)
    return robot.target_now(None, None, _rules(task), *(found[1] if found is not None else ()))


def _start_pose(task: Task, index: int) -> Value:
    robot = _robot(task)
    found = presentmove.ends(robot)
    return robot.target_now(None, None, _rules(task), *(found[0] if found is not None else ()))


def _return_pose(task: Task, index: int) -> Value:
    robot = _robot(task)
    return robot.target_now(None, None, _rules(task), *(presentmove.left_at(robot) or ()))


def _return_joints(task: Task, index: int) -> Value:
    robot = _robot(task)
    return robot.joints_as_value(_rules(task), *(presentmove.left_at(robot) or ()))


def _interrupt_pose(task: Task, index: int) -> Value:
    robot = _robot(task)
    marked = robot.interrupted
    if marked is None:
        return robot.target_now(None, None, _rules(task))
    return robot.target_now(None, None, _rules(task), marked[0], marked[2])


def _interrupt_joints(task: Task, index: int) -> Value:
    robot = _robot(task)
    return robot.joints_as_value(_rules(task), robot.interrupted[0] if robot.interrupted is not None else None)


def _remaining(task: Task, index: int) -> Value:
    piece = _robot(task).piece
    if piece is None:
        return 0.0
    here = piece.plan.tcp_at(task.machine.now - piece.start_s)[:3, 3]
    goal = piece.drive.plan.end_pose[:3, 3] if piece.drive.plan is not None else here
    return float(sum((p - q) ** 2 for p, q in zip(here, goal, strict=True)) ** 0.5)


def _speed(task: Task, index: int) -> Value:
    piece = _robot(task).piece
    if piece is None:
        return 0.0
    return piece.plan.length_mm * float(piece.plan.law.speed_at(task.machine.now - piece.start_s))


def _timer(task: Task, index: int) -> StopWatch:
    found = task.machine.timers.get(index)
    if found is None:
        found = task.machine.timers[index] = StopWatch()
    return found


def _read_timer(task: Task, index: int) -> Value:
    task.looked = task.looked_at_time = True
    return _timer(task, index).seconds(task.machine.now)


def _write_timer(task: Task, index: int, value: Value) -> None:
    timer = _timer(task, index)
    timer.counted, timer.since = float(value), task.machine.now
    task.machine.changed()


def _write_timer_stopped(task: Task, index: int, value: Value) -> None:
    timer, now = _timer(task, index), task.machine.now
    timer.counted, timer.since, timer.running = timer.seconds(now), now, not value
    task.machine.changed()


def _read_flag(kind: str) -> Read:
    def read(task: Task, index: int) -> Value:
        task.looked = True
        return bool(task.signals.get((kind, index)))

    return read


def _write_flag(kind: str) -> Write:
    def write(task: Task, index: int, value: Value) -> None:
        if bool(task.signals.get((kind, index))) != bool(value):
            task.signals[kind, index] = bool(value)
            task.machine.changed()

    return write


def _read_cyclic(task: Task, index: int) -> Value:
    """The expression that the flag was given, as it is now; FALSE before it was given one."""
    task.looked = True
    machine = task.machine
    if index not in machine.cyclic:
        return False
    if index in machine.evaluating:
        raise ProgramError("wrong_kind", f"cyclic flag {index} is defined by its own value")
    values, read = machine.cyclic[index]
    machine.evaluating.append(index)
    try:
        value = bool(read(values))
    finally:
        machine.evaluating.remove(index)
    task.looked_at_time = task.looked_at_time or values[0].looked_at_time
    return value


def _write_cyclic(task: Task, index: int, value: Value) -> None:
    """A value that is no expression any more (from the action of a trigger or an interrupt)."""
    task.machine.cyclic[index] = ([task], lambda values: value)
    task.machine.changed()


def _write_base(task: Task, index: int, value: Value) -> None:
    """A new modal frame stands in the world until the program puts it on a mechanism."""
    task.modal["base"] = copied(value)
    task.modal["base_unit"] = task.modal["base_root"] = None


def _time(task: Task, index: int) -> Value:
    task.looked = task.looked_at_time = True
    return task.machine.now


def _moving(task: Task, index: int) -> Value:
    return _robot(task).piece is not None


def _home_joints(task: Task, index: int) -> Value:
    robot = _robot(task)
    home = robot.model.home if robot.model is not None else None
    return robot.joints_as_value(_rules(task), home)


def _of_moves(task: Task, modal: str, used: str) -> Value:
    """What the task that moves the robot has, as a pose."""
    given = _robot(task).task.modal
    value = given.get(modal)
    if value is None and _rules(task).last_tool:
        value = given.get(used)
    return identity(task) if value is None else copied(value)


_SPECIAL: dict[str, Read] = {
    "tool_of_moves": lambda task, index: _of_moves(task, "tool", "tool_in_use"),
    "frame_of_moves": lambda task, index: _of_moves(task, "base", "frame_in_use"),
    "home_joints": _home_joints,
    "world": lambda task, index: identity(task),
    "null_frame": lambda task, index: identity(task),
    "actual_pose": lambda task, index: _robot(task).target_now(None, None, _rules(task)),
    "actual_joints": lambda task, index: _robot(task).joints_as_value(_rules(task)),
    "actual_joint": _actual_joint,
    "start_pose": _start_pose,
    "end_pose": _end_pose,
    "interrupt_pose": _interrupt_pose,
    "interrupt_joints": _interrupt_joints,
    "return_pose": _return_pose,
    "return_joints": _return_joints,
    "remaining_distance": _remaining,
    "path_speed_actual": _speed,
    "timer": _read_timer,
    "timer_stopped": lambda task, index: not _timer(task, index).running,
    "timer_positive": lambda task, index: _read_timer(task, index) > 0.0,
    "flag": _read_flag("flag"),
    "cyclic_flag": _read_cyclic,
    "error_number": lambda task, index: task.error_number,
    "interrupt_number": lambda task, index: task.interrupt_number,
    "mode": lambda task, index: Member("automatic"),
    "simulated": lambda task, index: True,
    "time": _time,
    "step_time": lambda task, index: _rules(task).wait_poll_s or CYCLE_S,
    "date": lambda task, index: task.machine.now,
    "moving": _moving,
}
SPECIAL_WRITE: dict[str, Write] = {
    "base": _write_base,
    "timer": _write_timer,
    "timer_stopped": _write_timer_stopped,
    "flag": _write_flag("flag"),
    "cyclic_flag": _write_cyclic,
}
# A condition that reads one of these is looked at again and again.
TIME_DEPENDENT = frozenset(
    (
        *("actual_pose", "actual_joints", "actual_joint", "remaining_distance", "path_speed_actual", "moving"),
        *("timer", "timer_positive", "time", "date", "start_pose", "end_pose", "return_pose", "return_joints"),
    )
)


def _modal_read(name: str, kind: str, indexed: bool) -> Read:
    def read(task: Task, index: int) -> Value:
        value = task.modal.get(f"{name}[{index}]") if indexed else None
        if value is None:
            value = task.modal.get(name)
        if value is None:
            value = DEFAULTS.get(name)
        if value is None and kind == "L":
            return Record("load", {"mass": 0.0})
        if value is None:
            return identity(task) if kind == "P" else False if kind == "b" else 0.0
        return Member(value) if kind == "x" and isinstance(value, str) else value

    return read


def _modal_write(name: str, indexed: bool) -> Write:
    if indexed:
        return lambda task, index, value: task.modal.__setitem__(f"{name}[{index}]", copied(value))
    return lambda task, index, value: task.modal.__setitem__(name, copied(value))


READ: dict[str, Read] = {
    row.name: _SPECIAL.get(row.name) or _modal_read(row.name, row.type, row.indexed)
    for row in ir.SYSTEM_VARIABLES.values()
}
WRITE: dict[str, Write] = {
    row.name: SPECIAL_WRITE.get(row.name) or _modal_write(row.name, row.indexed)
    for row in ir.SYSTEM_VARIABLES.values()
    if row.access == "rw"
}


def write_all(name: str) -> Callable[[Task, Value], None]:
    """Write an indexed modal variable for all its indices at once (V+ SPEED: all joints)."""

    def write(task: Task, value: Value) -> None:
        for key in [key for key in task.modal if key.startswith(f"{name}[")]:
            del task.modal[key]
        task.modal[name] = copied(value)

    return write


def modal_key(name: str, index: Value) -> str:
    """The name under which a move's own setting of a system variable is found."""
    return name if index is None else f"{name}[{whole(index)}]"


__all__ = ["READ", "TIME_DEPENDENT", "WRITE", "modal_key", "write_all"]
