"""What the cell file answers: dialogs with the operator, and statements and functions that only one controller has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.errors import RunError
from rpl.runtime.code import Values, Write
from rpl.runtime.faults import ProgramError
from rpl.runtime.task import Task
from rpl.runtime.values import Value
from rpl.runtime.waits import Wait
from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.cell import Answer, RoutineMeaning
    from rpl.runtime.ports import Machine


def ask(
    machine: Machine,
    task: Task,
    values: Values,
    text: str,
    keys: list[str | None],
    kind: str,
    write: Write,
    timeout: float | None,
    late: Write | None,
    here: int,
    next: int,
) -> int:
    """A dialog: the cell file answers, at once or later; without an answer the task waits."""
    origin = task.frame.code.origin(here)
    answer = _answer(machine, text)
    if answer is None:
        machine.message(task, "dialog", text, origin, keys=keys)
        deadline = None if timeout is None else machine.now + timeout
        wait = Wait("answer", here, next, machine.token(), machine.now, deadline, values=values)
        wait.timed_out, wait.error, wait.subject = late, "dialog_timeout", text
        return task.block(wait)
    given = answer.answer
    if kind == "keys" and isinstance(given, str):
        names = [key.lower() if key is not None else None for key in keys]
        if given.lower() not in names:
            raise RunError(f"{machine.cell.path}: the dialog {text!r} has no key {given!r}")
        given = names.index(given.lower()) + 1
    elif kind == "number" and isinstance(given, str):
        given = _number(machine, text, given)
    machine.message(task, "dialog", text, origin, keys=keys, answer=given)
    write(values, given)
    if late is not None:
        late(values, False)
    if answer.after_s > 0.0:
        return task.block(Wait("time", here, next, machine.token(), machine.now, machine.now + answer.after_s))
    return next


def _number(machine: Machine, text: str, given: str) -> float:
    """A number that the cell file gives as a text."""
    try:
        number = float(given)
    except ValueError:
        raise RunError(f"{machine.cell.path}: the dialog {text!r} takes a number, not {given!r}") from None
    return int(number) if number.is_integer() else number


def _answer(machine: Machine, text: str) -> Answer | None:
    """The first answer for this text; else the next of those for any dialog."""
    for answer in machine.cell.answers:
        if answer.text is not None and answer.text.search(text):
            return answer
    plain = [answer for answer in machine.cell.answers if answer.text is None]
    if machine.answered < len(plain):
        machine.answered += 1
        return plain[machine.answered - 1]
    return None


def vendor(machine: Machine, task: Task, text: str, effect: str, origin: Origin) -> float:
    """A statement that only one controller has; gives the seconds that it takes."""
    for meaning in machine.cell.vendor:
        if meaning.match.search(text):
            if meaning.effect == "message":
                machine.message(task, "vendor", meaning.message or text, origin)
            for signal, value in meaning.set:
                machine.set_input(signal, value)
            return meaning.seconds
    if effect == "unknown":
        raise ProgramError("vendor", f"nothing says what this stands for: {text[:80]} (see [[vendor]] of a cell file)")
    if effect == "message":
        machine.message(task, "vendor", text, origin)
    return 0.0


def unknown_routine(machine: Machine, task: Task, name: str, origin: Origin) -> RoutineMeaning | None:
    """What the cell file says of a routine that is not in what was read; its message and its signals are given."""
    meaning = machine.cell.routines.get(name.lower())
    if meaning is not None:
        if meaning.message:
            machine.message(task, "routine", meaning.message, origin)
        for signal, value in meaning.set:
            machine.set_input(signal, value)
    return meaning


def vendor_value(machine: Machine, text: str) -> Value:
    """The value of a function that only one controller has."""
    for meaning in machine.cell.vendor:
        if meaning.match.search(text) and meaning.value is not None:
            return meaning.value
    raise ProgramError("vendor", f"nothing says what {text[:80]} gives (see [[vendor]] of a cell file)")
