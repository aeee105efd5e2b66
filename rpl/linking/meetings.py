"""Points at which tasks meet, as instructions: what a point is called, and who has to come."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl import ir
from rpl.linking.expressions import Place
from rpl.runtime import meetings
from rpl.runtime.code import Instruction, Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.moves import together
from rpl.runtime.values import whole

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.linker import Linker


def meet(statement: ir.Meet, linker: Linker) -> Make:
    """The instruction that arrives at the point."""
    identity = identity_of(statement.identity, linker)
    tasks = linker.compiler.value(statement.tasks) if statement.tasks is not None else None
    timeout = linker.compiler.value(statement.timeout) if statement.timeout is not None else None
    mode, error = statement.mode, statement.error
    stands = statement.in_position or mode != "wait"  # robots go together and apart from rest

    def make(here: int, next: int) -> Instruction:
        def arrive(f: Values) -> int:
            task = f[0]
            if stands and task.busy:
                standing: int = task.wait_for("idle", here, here)
                return standing
            if mode == "apart":
                together.check_apart(task)
            names = meetings.names_in(tasks(f)) if tasks is not None else None
            limit = float(timeout(f)) if timeout is not None else None
            return meetings.meet(task, meetings.Appointment(identity(f), mode, names, limit, error), here, next)

        return arrive

    return make


def identity_of(expression: ir.Expression, linker: Linker) -> Callable[[Values], str]:
    """What a point or a move is called: a number or text, or the name of a variable that has no value of its own."""
    compiler = linker.compiler
    raw = compiler.raw(expression)
    base, indices = expression, list[Read]()
    while isinstance(base, ir.Index):
        indices[:0] = [compiler.value(index) for index in base.indices]
        base = base.base
    name = base.id if isinstance(base, ir.Name) else ""
    place = compiler.place_of(name) if name else None
    stands_for_itself = isinstance(place, Place) and not place.is_reference

    def identity(f: Values) -> str:
        value = raw(f)
        if isinstance(value, str):
            return value.lower()
        if isinstance(value, int | float):
            return f"{value:g}"
        if not stands_for_itself:
            raise ProgramError("wrong_kind", f"what {name or 'this'} is called here cannot be told: give the variable")
        numbers = ",".join(str(whole(index(f))) for index in indices)
        return f"{name.lower()}{{{numbers}}}" if numbers else name.lower()

    return identity
