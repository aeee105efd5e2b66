"""Waiting for the end of another task, for targets that start tasks but cannot wait for one: the task's routine takes a
flag back when it ends, and the program waits for that.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.taskflags import TaskFlag, controlled, flag_of, with_task_flags
from rpl.passes.legalise.stages import legalising


@legalising(
    unless=lambda context: (
        "TaskControl" not in context.capabilities.statements
        or "join" in context.capabilities.tasks.operations
        or "start" not in context.capabilities.tasks.operations
    ),
    sees=("TaskControl",),
)
def joins(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose tasks can be started and not joined."""
    joined = controlled(program, ("join",)) & controlled(program, ("start",))
    flags = {name: TaskFlag(flag_of(name, context), joined=True) for name in sorted(joined)}
    return with_task_flags(program, context, flags)


__all__ = ["joins"]
