"""The tasks of the programs that are executed beside the main one."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.kinds import walk_for

from .. import tables


def tasks_of(program: ir.Program) -> dict[str, int]:
    """A number for each program that is executed beside the main one."""
    names = [task.entry.lower() for task in program.tasks if task.kind == "background"]
    names += [node.task.lower() for node in walk_for({"TaskControl"}, program) if isinstance(node, ir.TaskControl)]
    return {name: number for number, name in enumerate(dict.fromkeys(names), 1) if number <= tables.TASKS}
