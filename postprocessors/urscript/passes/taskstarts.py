"""Corners in front of a move that a task of its own drives, for targets where searches are such tasks
(URScript): two tasks cannot drive the robot through one corner, the second would end with an error. The robot stops
there first.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.cornerways import Ways
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

STOPS_BEFORE = code(
    "corner-stops-before-task",
    Severity.WARNING,
    "the robot stops at this corner: a task of its own drives the next move (line {line})",
)


@legalising(sees=("TaskControl",))
def stand_before_tasks(program: ir.Program, context: Context) -> ir.Program:
    """Tasks drive single moves."""
    starts = [
        node
        for node in walk_for({"TaskControl"}, *program.modules)
        if isinstance(node, ir.TaskControl) and node.op == "start"
    ]
    if not starts:
        return program
    moving = doing(program, lambda node: isinstance(node, ir.Move | ir.MoveExternal | ir.Spline))
    entries = {task.name.lower(): (task.entry or task.name).lower() for task in program.tasks}

    def begins(statement: ir.Statement, scope: Scope) -> bool:
        if not isinstance(statement, ir.TaskControl) or statement.op != "start":
            return False
        name = statement.task.lower()
        return entries.get(name, name) in moving

    ways = Ways(program, context, begins)
    if ways.followed() is None or not ways.stopped:
        return program
    for origin, line in ways.stopped.items():
        context.diagnostics.report(STOPS_BEFORE, origin, line=line)

    def change(node: object) -> object:
        if isinstance(node, ir.Move) and node.origin in ways.stopped and node.blend is not None:
            return replace(node, blend=ir.BlendStop())
        return node

    return rewrite(program, change)


__all__ = ["stand_before_tasks"]
