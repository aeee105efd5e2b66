"""Questions whether another task runs (`task_runs`, V+ TASK(1, n)), for targets that cannot ask: the program sets a
flag where it starts the task, and the task's routine takes it back where it ends.

What ends the task from outside takes the flag back as well. A routine that ends by an error or a halt leaves it. A
task that nothing in the program starts stays, and the writer refuses the question by name.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside, left_with
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising

ASKS = "task_runs"


@legalising(unless=lambda context: ASKS in context.capabilities.functions, sees=("TaskControl",))
def task_states(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that do not know whether a task runs."""
    asked = {name for node in walk(*program.modules) if (name := _asked(node)) is not None}
    started = {
        node.task.lower() for node in walk(*program.modules) if isinstance(node, ir.TaskControl) and node.op == "start"
    }
    called = {node.name.lower() for node in walk(*program.modules) if isinstance(node, ir.CallRoutine | ir.Call)}
    known = (asked & started) - called
    if not known:
        return program
    flags = {name: ir.Name(context.fresh(f"{name.replace('.', '_')}_runs")) for name in sorted(known)}

    def answer(node: object) -> object:
        name = _asked(node)
        return node if name is None else flags.get(name, node)

    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.TaskControl(op="start", task=name) if name.lower() in flags:
                return expansion(statement.origin, (_set(flags[name.lower()], True), statement))
            case ir.TaskControl(op="stop", task=name) if name.lower() in flags:
                return expansion(statement.origin, (statement, _set(flags[name.lower()], False)))
        return (inside(statement, lambda inner: map_body(inner, change)),)

    def routine(one: ir.Routine) -> ir.Routine:
        done = edit_bodies(one, lambda body: map_body(body, change))
        flag = flags.get(one.name.lower())
        return done if flag is None else left_with(done, (_set(flag, False),))

    modules = [
        rewrite(replace(module, routines=tuple(map(routine, module.routines))), answer) for module in program.modules
    ]
    data = [ir.Variable(flag.id, ir.BoolType(), ir.BoolLiteral(False), scope="global") for flag in flags.values()]
    return with_support(replace(program, modules=tuple(modules)), context, data, (), modules[0].task)


def _asked(node: object) -> str | None:
    """The task (folded) that a question is about."""
    match node:
        case ir.Builtin(function="task_runs", arguments=(ir.TextLiteral(value=name),)):
            return name.lower()
    return None


def _set(flag: ir.Name, value: bool) -> ir.Assign:
    return ir.Assign(flag, ir.BoolLiteral(value))


__all__ = ["task_states"]
