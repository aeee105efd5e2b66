"""The tasks of the programs that are executed beside the main one."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.kinds import walk_for

from .. import tables


def beside_main(program: ir.Program) -> list[str]:
    """Programs that are executed beside the main one, folded, apart from those that switch an output later."""
    names = [task.entry.lower() for task in program.tasks if task.kind == "background"]
    names += [node.task.lower() for node in walk_for({"TaskControl"}, program) if isinstance(node, ir.TaskControl)]
    return [name for name in dict.fromkeys(names) if not is_later(name)]


def tasks_of(program: ir.Program) -> dict[str, int]:
    """A number for each program that is executed beside the main one. From the last number on go the programs that
    switch outputs later, those of one output in one task."""
    found = {name: number for number, name in enumerate(beside_main(program), 1) if number <= tables.TASKS}
    signals = later_signals(program)
    order = list(dict.fromkeys(signals.values()))
    return found | {name: tables.TASKS - order.index(signal) for name, signal in signals.items()}


def later_signals(program: ir.Program) -> dict[str, ir.Signal]:
    """Program, folded -> the output that it switches after a time."""
    found = {}
    for module in program.modules:
        for routine in module.routines:
            match routine.body:
                case (ir.Wait(), ir.Assign(target=ir.Signal() as signal)) if is_later(routine.name):
                    found[routine.name.lower()] = signal
    return found


def is_later(name: str) -> bool:
    """Is it a program that switches an output later?"""
    return name.lower().startswith(tables.LATER)


__all__ = ["beside_main", "is_later", "later_signals", "tasks_of"]
