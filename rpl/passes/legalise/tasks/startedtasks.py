"""Background tasks that run from the start and that the program also starts, ends or waits for (RPL `TASK t ENTRY r
BACKGROUND` with `JOIN TASK t`): the first statement of the program starts them instead.

What follows then has one kind of task to think of. Starting a task that runs already does nothing, so a statement that
starts it again means the same as before. Tasks that begin again by themselves stay declared, and so does everything
where the program can begin anew.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE


@legalising()
def started_tasks(program: ir.Program, context: Context) -> ir.Program:
    """Only where a statement or an expression names such a task; other tasks must not be there."""
    nodes = [*walk_for({"TaskControl", "Halt"}, *program.modules)]
    controlled = {node.task.lower() for node in nodes if isinstance(node, ir.TaskControl)}
    motion = [task for task in program.tasks if task.kind == "motion"]
    beside = [task for task in program.tasks if task.kind != "motion"]
    fits = all(task.name.lower() in controlled and not task.cyclic and not task.modules for task in beside)
    if not beside or not fits or motion or any(isinstance(node, ir.Halt) and node.kind == "cycle" for node in nodes):
        return program
    entry = _entry(program, {task.entry.lower() for task in beside})
    known = {routine.name.lower() for module in program.modules for routine in module.routines}
    if not entry or not all(task.name.lower() == task.entry.lower() in known for task in beside):
        return program
    starts = tuple(ir.TaskControl("start", task.entry, origin=NOWHERE) for task in beside)
    modules = tuple(
        replace(
            module,
            routines=tuple(
                replace(one, body=(*starts, *one.body)) if one.name.lower() == entry else one for one in module.routines
            ),
        )
        for module in program.modules
    )
    return replace(program, modules=modules, tasks=())


def _entry(program: ir.Program, beside: set[str]) -> str:
    """The routine that the program begins with, when nothing else runs it; empty text where that is open."""
    called = {
        node.name.lower()
        for node in walk_for({"Call", "CallRoutine"}, *program.modules)
        if isinstance(node, ir.Call | ir.CallRoutine)
    }
    begins = {program.entry.lower()} if program.entry else set(never_called(program)) - beside
    return next(iter(begins)) if len(begins) == 1 and not begins & called else ""


__all__ = ["started_tasks"]
