"""Waiting for the end of another task, for targets that start tasks but cannot wait for one: the task's routine takes a
flag back when it ends, and the program waits for that.

What ends the task from outside takes the flag back as well. A routine that ends by an error or a halt leaves it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside, left_with
from rpl.passes.legalise.rewriting.support import with_support
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
    controls = [node for node in walk(*program.modules) if isinstance(node, ir.TaskControl)]
    started = {one.task.lower() for one in controls if one.op == "start"}
    joined = {one.task.lower() for one in controls if one.op == "join"} & started
    if not joined:
        return program
    flags = {name: ir.Name(context.fresh(f"{name}_runs")) for name in sorted(joined)}

    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.TaskControl(op=op, task=name) if name.lower() in flags:
                flag, later = flags[name.lower()], replace(statement.origin, comments=())
                if op == "start":
                    runs = ir.Assign(flag, ir.BoolLiteral(True), origin=statement.origin)
                    return (runs, replace(statement, origin=later))
                if op == "stop":
                    return (statement, ir.Assign(flag, ir.BoolLiteral(False), origin=later))
                if op == "join":
                    return (ir.WaitUntil(ir.Unary("not", flag), origin=statement.origin),)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            done = edit_bodies(routine, lambda body: map_body(body, change))
            flag = flags.get(routine.name.lower())
            routines.append(done if flag is None else left_with(done, (ir.Assign(flag, ir.BoolLiteral(False)),)))
        modules.append(replace(module, routines=tuple(routines)))
    data = [ir.Variable(flag.id, ir.BoolType(), ir.BoolLiteral(False), scope="global") for flag in flags.values()]
    return with_support(replace(program, modules=tuple(modules)), context, data, (), modules[0].task)


__all__ = ["joins"]
