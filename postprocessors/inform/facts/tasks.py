"""Which jobs are started, and by whom: at the beginning, as sub tasks, beside the program."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.entries import never_called, started_tasks
from rpl.passes.legalise.kinds import walk_for

from .. import tables


def sub_tasks(program: ir.Program) -> dict[str, str]:
    """Routine, folded -> the sub task that it is started as, as far as there are any."""
    names: dict[str, str] = {}
    for node in walk_for({"TaskControl"}, *program.modules):
        if isinstance(node, ir.TaskControl) and node.op == "start" and len(names) < tables.MOST_SUBTASKS:
            names.setdefault(node.task.lower(), f"SUB{len(names) + 1}")
    return names


def jobs_beside(program: ir.Program) -> dict[str, str]:
    """Routine, folded -> the jobs that run beside the program and come to it; empty for the program itself."""
    calls: dict[str, set[str]] = {}
    roots = {task.entry.lower() for task in program.tasks if task.kind == "background"}
    for module in program.modules:
        for routine in module.routines:
            found = calls.setdefault(routine.name.lower(), set())
            for node in walk(routine.body):
                match node:
                    case ir.CallRoutine(name=name):
                        found.add(name.lower())
                    case ir.TaskControl(op="start", task=name):
                        roots.add(name.lower())
    reached: dict[str, set[str]] = {}
    for root in roots:
        waiting = [root]
        while waiting:
            name = waiting.pop()
            if root not in reached.setdefault(name, set()):
                reached[name].add(root)
                waiting.extend(calls.get(name, ()))
    return {name: " ".join(sorted(found)) for name, found in reached.items()}


def started_first(program: ir.Program) -> set[str]:
    """Jobs that may be started, folded: the named entry, the tasks', else those that nobody calls."""
    if program.entry:
        return {program.entry.lower()}
    motion = {task.entry.lower() for task in program.tasks if task.kind == "motion"}
    if motion:
        return motion
    beside = {task.entry.lower() for task in program.tasks if task.kind == "background"}
    return never_called(program) - started_tasks(program) - beside
