"""Tasks that have a name besides their routine (RPL `TASK pulse ENTRY beat`): in the other languages a program that is
started is known by its own name, so the task takes the routine's.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising


@legalising()
def task_names(program: ir.Program, context: Context) -> ir.Program:
    """Only where a statement names such a task; two tasks of one routine stay as they are."""
    routines = {routine.name.lower() for module in program.modules for routine in module.routines}
    entries = [task.entry.lower() for task in program.tasks]
    named = {
        task.name.lower(): task.entry
        for task in program.tasks
        if task.name.lower() not in routines and entries.count(task.entry.lower()) == 1
    }
    found = False

    def change(node: object) -> object:
        nonlocal found
        if isinstance(node, ir.TaskControl) and node.task.lower() in named:
            found = True
            return replace(node, task=named[node.task.lower()])
        return node

    modules = tuple(rewrite(module, change) for module in program.modules) if named else program.modules
    if not found:
        return program
    tasks = tuple(replace(task, name=named.get(task.name.lower(), task.name)) for task in program.tasks)
    return replace(program, modules=modules, tasks=tasks)


__all__ = ["task_names"]
