"""Questions whether another task runs (`task_runs`, V+ TASK(1, n)), for targets that cannot ask: the program sets a
flag where it starts the task, and the task's routine takes it back where it ends.

A task that nothing in the program starts stays, and the writer refuses the question by name.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.taskflags import (
    ASKS,
    TaskFlag,
    asked_task,
    called_too,
    controlled,
    flag_of,
    with_task_flags,
)
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: ASKS in context.capabilities.functions, sees=("TaskControl",))
def task_states(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that do not know whether a task runs."""
    asked = {
        name for node in walk_for({f"function {ASKS}"}, *program.modules) if (name := asked_task(node)) is not None
    }
    known = (asked & controlled(program, ("start",))) - called_too(program)
    flags = {name: TaskFlag(flag_of(name, context), asked=True) for name in sorted(known)}
    return with_task_flags(program, context, flags)


__all__ = ["task_states"]
