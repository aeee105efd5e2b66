"""The names of a program in one name space, and which of its programs somebody may start with."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.legalise.kinds import walk_for


def starts(program: ir.Program) -> set[str]:
    """Programs that somebody may start with, folded."""
    tasks = {task.entry.lower() for task in program.tasks if task.kind == "background"}
    executed = {node.task.lower() for node in walk_for({"TaskControl"}, program) if isinstance(node, ir.TaskControl)}
    named = {program.entry.lower(), *(task.entry.lower() for task in program.tasks if task.kind == "motion")} - {""}
    return (never_called(program) | named) - tasks - executed


def names_of(program: ir.Program) -> set[str]:
    """Every name that stands in the program, folded and without its sign."""
    names: set[str] = set()
    for node in walk(program):
        name = node.id if isinstance(node, ir.Name) else getattr(node, "name", None)
        if isinstance(name, str):
            names.add(name.lower().lstrip("$#%"))
    return names
