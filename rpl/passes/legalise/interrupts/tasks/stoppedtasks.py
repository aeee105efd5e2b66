"""Tasks that the program ends, for targets that can begin a task and not end it: the task looks at a flag wherever it
waits, and leaves by itself.

Only for tasks that leave the robot alone and wait in their own routine.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.interrupts.tasks.background import leaving_at, waits
from rpl.passes.legalise.rewriting.beside import closure
from rpl.passes.legalise.rewriting.editing import edit_each
from rpl.passes.legalise.rewriting.taskflags import TaskFlag, called_too, controlled, flag_of, with_task_flags
from rpl.passes.legalise.stages import legalising

_MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.WaitForMotion, ir.StopMotion, ir.StartMotion, ir.ClearMotion)


@legalising(
    unless=lambda context: (
        "TaskControl" not in context.capabilities.statements
        or "stop" in context.capabilities.tasks.operations
        or "start" not in context.capabilities.tasks.operations
    ),
    sees=("TaskControl",),
)
def stopped_tasks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose tasks can be started and not stopped."""
    flags = {
        name: TaskFlag(flag_of(name, context), ends=ir.Name(context.fresh(f"{name}_stop")))
        for name in sorted(_stopped(program))
    }

    def routine(_: ir.Module, one: ir.Routine) -> ir.Routine:
        flag = flags.get(one.name.lower())
        return one if flag is None or flag.ends is None else leaving_at(one, flag.ends, context, (ir.Return(),))

    return with_task_flags(edit_each(program, routine) if flags else program, context, flags)


def _stopped(program: ir.Program) -> set[str]:
    """Tasks (folded) that are ended from outside and can do so by themselves."""
    asked = controlled(program, ("stop",)) & controlled(program, ("start",))
    asked -= controlled(program, ("pause", "resume"))
    asked -= called_too(program) | closure(program, _MOTION)
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    waiting = {name for name, routine in routines.items() if waits(routine)}
    alone = set()
    for name in asked & set(routines):
        calls = {node.name.lower() for node in walk(routines[name]) if isinstance(node, ir.CallRoutine | ir.Call)}
        reached = closure(program, (ir.Wait, ir.WaitUntil, ir.Pulse)) & calls
        if name in waiting and not reached and routines[name].returns is None:
            alone.add(name)
    return alone


__all__ = ["stopped_tasks"]
