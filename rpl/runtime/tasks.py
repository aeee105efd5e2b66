"""Tasks that tasks start, end, pause and wait for, sections in which no other task runs, and who has the robot."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl.runtime.code import Code, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.task import ENDED, READY
from rpl.runtime.task import Task as NewTask
from rpl.runtime.waits import Wait

if TYPE_CHECKING:
    from rpl.runtime.ports import Machine, Robot, Task

# A task that a program starts has this kind: the run does not wait for its end.
STARTED = "background"
MOTION = "motion"


def named(machine: Machine, name: str) -> Task | None:
    """The task of that name, whatever its state; of several of one routine the one that was started last."""
    wanted = machine.latest.get(name.lower(), name.lower())
    return next((task for task in machine.tasks if task.name.lower() == wanted), None)


def start(machine: Machine, asking: Task, name: str, code: Code | None, fill: Callable[[Values], None]) -> None:
    """Begin a task, unless it runs already; where each start begins another one, a task beside it. A routine that is no
    task yet becomes one; it shares the modal settings of the task that started it."""
    found = named(machine, name)
    again = found is not None and found.state != ENDED
    if found is None or (again and code is not None and asking.frame.code.rules.task_instances):
        if code is None:
            raise ProgramError("unknown_routine", f"there is no task or routine {name}")
        machine.provide(code)
        found = _another(machine, asking, name, code)
    elif again:
        return
    else:
        found.restart()
    fill(found.frame.values)
    found.state = READY
    machine.ready(found)


def _another(machine: Machine, asking: Task, name: str, code: Code) -> Task:
    """A task of the routine that no task beside it is: one that has ended, or a new one."""
    mine = [task for task in machine.tasks if task.name.lower().partition(":")[0] == name.lower()]
    ended = next((task for task in mine if task.state == ENDED and task.kind == STARTED), None)
    if ended is not None:
        ended.restart()
        found: Task = ended
    else:
        own = f"{name}:{len(mine) + 1}" if mine else name
        found = NewTask(machine, own, len(machine.tasks), STARTED, code)
        found.modal = asking.modal
        machine.tasks.append(found)
    machine.latest[name.lower()] = found.name.lower()
    return found


def control(machine: Machine, asking: Task, op: str, name: str) -> None:
    """stop, pause or resume a task. One that was never started is not there to be stopped."""
    found = named(machine, name)
    if found is None:
        return
    match op:
        case "stop" if found is asking:
            raise ProgramError("bad_call", f"task {name} cannot stop itself")
        case "stop":
            found.state, found.wait = ENDED, None
            machine.changed()
        case "pause" if found.state != ENDED:
            found.held = True
        case "resume" if found.held:
            found.held = False
            release(machine)


def join(asking: Task, name: str, here: int, next: int) -> int:
    """Wait until a task has ended."""
    found = named(asking.machine, name)
    if found is None or found.state == ENDED:
        return next
    if found is asking:
        raise ProgramError("bad_call", f"task {name} cannot wait for its own end")
    return asking.block(Wait("task", here, next, asking.machine.token(), asking.machine.now, move=found.index))


def runs(asking: Task, name: str) -> bool:
    """Has a task been started, and has it not ended?"""
    asking.looked = True
    found = named(asking.machine, name)
    return found is not None and found.state != ENDED


def critical(task: Task, enter: bool) -> None:
    """Begin or end a section in which no other task runs."""
    task.machine.critical = task.index if enter else None
    if not enter:
        release(task.machine)


def may_run(machine: Machine, task: Task) -> bool:
    """May the task go on, or is it held or another one in a critical section?"""
    if task.held or machine.critical not in (None, task.index):
        machine.held.append(task.index)
        return False
    return True


def release(machine: Machine) -> None:
    """Let those run that were held."""
    waiting, machine.held = machine.held, []
    for index in waiting:
        task = machine.tasks[index]
        if task.state == READY:
            machine.ready(task)


def robot_of(task: Task) -> Robot | None:
    """The robot that the task sees: its own, else the one that another task has now."""
    if task.robot is not None:
        return task.robot
    return next((other.robot for other in task.machine.tasks if other.robot is not None), None)


def take_robot(task: Task, moving: bool = False) -> bool:
    """Give the task the robot of another one that does not use it now, or that has ended; with `moving` in any case."""
    for other in task.machine.tasks:
        robot = other.robot
        if robot is None or other is task:
            continue
        if not moving and task.kind == other.kind == MOTION:
            what = f"task {task.name} moves a robot of its own beside that of task {other.name}"
            raise ProgramError("second_robot", f"{what}; name it by a second --robot")
        if other.busy and not moving and not other.has_ended:
            raise ProgramError("motion", f"the robot is moved by task {other.name}")
        other.robot, task.robot = None, robot
        task.busy, other.busy = other.busy, False
        robot.task_index = task.index
        return True
    return False
