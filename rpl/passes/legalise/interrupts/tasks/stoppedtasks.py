"""Tasks that the program ends, for targets that can begin a task and not end it: the task looks at a flag wherever it
waits, and leaves by itself.

Only for tasks that leave the robot alone and wait in their own routine.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.interrupts.tasks.background import leaving_at, waits
from rpl.passes.legalise.rewriting.beside import closure
from rpl.passes.legalise.rewriting.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside, left_with
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE

_MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.WaitForMotion, ir.StopMotion, ir.StartMotion, ir.ClearMotion)
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


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
    names = _stopped(program)
    if not names:
        return program
    worker = _Stopped({name: (context.fresh(f"{name}_runs"), context.fresh(f"{name}_stop")) for name in sorted(names)})

    def routine(one: ir.Routine) -> ir.Routine:
        flags = worker.flags.get(one.name.lower())
        if flags is not None:
            runs, stop = flags
            one = leaving_at(
                left_with(one, (_set(runs, _FALSE),)), ir.Name(stop), context, (_set(runs, _FALSE), ir.Return())
            )
        return edit_bodies(one, lambda body: map_body(body, worker.statement))

    modules = tuple(replace(module, routines=tuple(map(routine, module.routines))) for module in program.modules)
    data = [
        ir.Variable(name, ir.BoolType(), _FALSE, scope="global") for flags in worker.flags.values() for name in flags
    ]
    return with_support(replace(program, modules=modules), context, data, (), modules[0].task)


def _stopped(program: ir.Program) -> set[str]:
    """Tasks (folded) that are ended from outside and can do so by themselves."""
    controls = [node for node in walk(*program.modules) if isinstance(node, ir.TaskControl)]
    asked = {one.task.lower() for one in controls if one.op == "stop"} & {
        one.task.lower() for one in controls if one.op == "start"
    }
    asked -= {one.task.lower() for one in controls if one.op in ("pause", "resume")}
    asked -= {node.name.lower() for node in walk(*program.modules) if isinstance(node, ir.CallRoutine | ir.Call)}
    asked -= closure(program, _MOTION)
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    waiting = {name for name, routine in routines.items() if waits(routine)}
    alone = set()
    for name in asked & set(routines):
        calls = {node.name.lower() for node in walk(routines[name]) if isinstance(node, ir.CallRoutine | ir.Call)}
        reached = closure(program, (ir.Wait, ir.WaitUntil, ir.Pulse)) & calls
        if name in waiting and not reached and routines[name].returns is None:
            alone.add(name)
    return alone


def _set(name: str, value: ir.Expression) -> ir.Assign:
    return ir.Assign(ir.Name(name), value)


@dataclass(slots=True)
class _Stopped:
    """`flags`: task -> the flags that say that it runs, and that it is to end."""

    flags: dict[str, tuple[str, str]] = field(default_factory=dict)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.TaskControl(op="start" | "stop" as op, task=name) if name.lower() in self.flags:
                runs, stop = self.flags[name.lower()]
                if op == "start":
                    return expansion(statement.origin, (_set(stop, _FALSE), _set(runs, _TRUE), statement))
                ended = ir.WaitUntil(ir.Unary("not", ir.Name(runs)), origin=NOWHERE)
                return (ir.If(((ir.Name(runs), (_set(stop, _TRUE), ended)),), origin=statement.origin),)
        return (inside(statement, lambda body: map_body(body, self.statement)),)


__all__ = ["stopped_tasks"]
