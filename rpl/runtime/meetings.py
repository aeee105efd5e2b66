"""Points at which tasks wait for each other. A task that arrives waits until all tasks of its list are at the same
point; the last one lets all of them go on at the same moment. What a point is called is all that it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl.runtime.faults import ProgramError
from rpl.runtime.values import Array, Record, Value
from rpl.runtime.waits import Arrival, Wait

if TYPE_CHECKING:
    from rpl.runtime.ports import Machine, Task


@dataclass(frozen=True, slots=True)
class Appointment:
    """What a task asks for when it arrives. `names`: the list as it has it, None: those it goes together with."""

    identity: str
    mode: str
    names: tuple[str, ...] | None
    timeout_s: float | None
    error: str | None


def meet(task: Task, asked: Appointment, here: int, next: int) -> int:
    """Arrive at a point: go on when everybody is there, else wait."""
    machine = task.machine
    group = _group(task, asked)
    there = [one for one in present(machine) if one.task in group and _same(one, asked)]
    for one in there:
        if one.group != group:
            other = machine.tasks[one.task].name
            raise ProgramError("task_lists", f"{task.name} and {other} meet at {asked.identity} with different tasks")
    if {one.task for one in there} | {task.index} == group:
        machine.arrivals = [one for one in machine.arrivals if one not in there]
        for number in group:
            _go_on(machine.tasks[number], asked.mode, group)
        for one in there:
            machine.look_at(machine.tasks[one.task])
        return next
    now = machine.now
    deadline = None if asked.timeout_s is None else now + max(asked.timeout_s, 0.0)
    wait = Wait("meeting", here, next, machine.token(), now, deadline, error=asked.error)
    missing = ", ".join(machine.tasks[n].name for n in sorted(group - {task.index} - {one.task for one in there}))
    wait.subject = f"{missing} at {asked.identity}"
    machine.arrivals.append(Arrival(task.index, asked.identity, asked.mode, group, wait.token))
    machine.event("wait", {"condition": wait.subject}, task, task.frame.code.origin(here))
    return task.block(wait)


def _same(one: Arrival, asked: Appointment) -> bool:
    return one.identity == asked.identity and one.mode == asked.mode


def _go_on(task: Task, mode: str, group: frozenset[int]) -> None:
    if mode != "wait":
        task.together = group if mode == "together" else frozenset()


def _group(task: Task, asked: Appointment) -> frozenset[int]:
    """The numbers of the tasks that have to be there, the asking one among them."""
    if asked.mode == "together" and task.together:
        raise ProgramError("synchronisation", f"{task.name} goes together with other tasks already")
    if asked.mode == "apart" and not task.together:
        raise ProgramError("synchronisation", f"{task.name} does not go together with other tasks here")
    if asked.names is None:
        return task.together
    group = frozenset(numbered(task.machine, name) for name in asked.names)
    if task.index not in group:
        raise ProgramError("task_lists", f"{task.name} is not in its own list of tasks ({', '.join(asked.names)})")
    return group


def numbered(machine: Machine, name: str) -> int:
    """The number of the task of that name; a motion task has the usual name of its language too (Rules.task_name)."""
    wanted = name.lower()
    motion = 0
    for task in machine.tasks:
        motion += task.kind == "motion"
        usual = task.entry.rules.task_name.format(number=motion) if task.kind == "motion" else ""
        if wanted in (task.name.lower(), usual.lower()):
            return task.index
    known = ", ".join(task.name for task in machine.tasks)
    raise ProgramError("unknown_task", f"there is no task {name} (tasks: {known})")


def names_in(value: Value) -> tuple[str, ...]:
    """The names in a list of tasks: texts, or records that begin with one; empty ones do not count."""
    if not isinstance(value, Array):
        raise ProgramError("wrong_kind", "a list of tasks is needed")
    names = []
    for item in value.items:
        name = next(iter(item.parts.values()), None) if isinstance(item, Record) else item
        if not isinstance(name, str):
            raise ProgramError("wrong_kind", "a list of tasks holds their names")
        if name:
            names.append(name)
    return tuple(names)


def present(machine: Machine) -> list[Arrival]:
    """Who waits now, also who is in an interrupt meanwhile; a wait that has been given up is forgotten."""
    machine.arrivals = [one for one in machine.arrivals if _waits(machine.tasks[one.task], one.token)]
    return machine.arrivals


def _waits(task: Task, token: int) -> bool:
    waits = (task.wait, *(frame.wait for frame in task.frames))
    return any(isinstance(wait, Wait) and wait.token == token for wait in waits)


def in_vain(machine: Machine, ended: Task) -> Task | None:
    """A task that waits without a time-out for one that has ended and that nothing starts again."""
    if ended.kind != "motion":
        return None
    for one in present(machine):
        task = machine.tasks[one.task]
        if ended.index in one.group and task.wait is not None and task.wait.deadline is None:
            return task
    return None
