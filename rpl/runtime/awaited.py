"""Who waits for what at the end of a run: the inputs that a condition, or a loop that polls, looked at last."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.runtime.signals import is_bit_group, key_of
from rpl.runtime.values import SignalRef
from rpl.runtime.waits import Awaited

if TYPE_CHECKING:
    from rpl.runtime.ports import Machine, Task


def awaited(machine: Machine) -> tuple[Awaited, ...]:
    """Of all tasks that have not ended."""
    return tuple(
        Awaited(
            task.name,
            task.wait.kind if task.wait is not None else "",
            task.where(),
            task.wait.since if task.wait is not None else machine.now,
            tuple((input_name(machine, task, port), moment) for port, moment in task.inputs.items()),
            task.wait.subject if task.wait is not None else "",
        )
        for task in machine.tasks
        if not task.has_ended
    )


def input_name(machine: Machine, task: Task, port: SignalRef) -> str:
    """The signal as the language of the program spells it, with the name that the program has for it."""
    if is_bit_group(port):
        first, last = (port._replace(number=number, last=None) for number in (port.number, port.last))
        name = f"{input_name(machine, task, first)} TO {input_name(machine, task, last)}"
    else:
        name = machine.physical_name(key_of(port), port, task)
    called = [alias for alias in machine.linked.alias_names(port) if alias.lower() != name.lower()]
    return f"{name} ({', '.join(called)})" if called else name


def words(machine: Machine, task: Task) -> str:
    """What a task waits for, with the inputs of its condition, and where."""
    said = task.wait.describe() if task.wait is not None else "nothing"
    if task.wait is not None and task.wait.kind == "condition":
        names = [input_name(machine, task, port) for port in task.inputs]
        plain = said.lower().replace(" ", "")
        unsaid = [name for name in names if name.lower().replace(" ", "") not in plain]
        said += f": input{'s' * (len(unsaid) > 1)} {', '.join(unsaid)}" if unsaid else ""
    where = task.where()
    return f"{task.name} waits for {said}" + (f" at {where.file}:{where.line}" if where.source else "")


def polled(machine: Machine, task: Task) -> str:
    """What a loop that takes no time looks at."""
    names = [input_name(machine, task, port) for port, moment in task.inputs.items() if moment == machine.now]
    return f"{', '.join(names) or 'a signal'} that nothing changes, in a loop"


__all__ = ["awaited", "polled", "words"]
