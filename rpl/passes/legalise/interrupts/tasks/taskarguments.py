"""Arguments of tasks that a program starts, for targets whose tasks take none: they go by data of the module.

Only where the routine is nothing but a task and leaves its parameters as they are.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite
from rpl.passes.capabilities import Parameters, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising(
    unless=lambda context: (
        context.capabilities.interrupts.watched is not Watched.ALL
        and context.capabilities.routines.parameters is Parameters.NAMES
    ),
    sees=("TaskControl",),
)
def task_arguments(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose tasks take none."""
    starts = [
        node
        for node in walk_for({"TaskControl"}, *program.modules)
        if isinstance(node, ir.TaskControl) and node.arguments
    ]
    if not starts:
        return program
    called = {
        node.name.lower()
        for node in walk_for({"CallRoutine", "Call"}, *program.modules)
        if isinstance(node, ir.CallRoutine | ir.Call)
    }
    names = {one.task.lower() for one in starts} - called
    given: dict[str, list[ir.Variable]] = {}
    modules = []
    for module in program.modules:
        routines, data = [], list(module.declarations)
        for routine in module.routines:
            if routine.name.lower() in names and _possible(routine, starts):
                variables = [
                    ir.Variable(context.fresh(f"{routine.name}_{one.name}"), one.type, scope="global")
                    for one in routine.parameters
                ]
                given[routine.name.lower()] = variables
                data.extend(variables)
                routine = _without(routine, variables)
            routines.append(routine)
        modules.append(replace(module, declarations=tuple(data), routines=tuple(routines)))

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.TaskControl) and statement.op == "start" and statement.task.lower() in given:
            values = [one.value for one in statement.arguments if one.value is not None]
            variables = given[statement.task.lower()]
            before = [ir.Assign(ir.Name(v.name), value) for v, value in zip(variables, values, strict=True)]
            return expansion(statement.origin, (*before, replace(statement, arguments=())))
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(replace(program, modules=tuple(modules)), lambda body: map_body(body, change))


def _possible(routine: ir.Routine, starts: list[ir.TaskControl]) -> bool:
    """Does each start give each parameter a value, and does the routine leave them alone?"""
    own = {one.name.lower() for one in routine.parameters}
    for start in starts:
        if start.task.lower() == routine.name.lower():
            plain = all(one.value is not None and not one.name for one in start.arguments)
            if not plain or len(start.arguments) != len(own):
                return False
    return not assigned_in(*bodies(routine)) & own


def _without(routine: ir.Routine, variables: list[ir.Variable]) -> ir.Routine:
    """The routine with data in place of its parameters."""
    names = {one.name.lower(): data.name for one, data in zip(routine.parameters, variables, strict=True)}

    def change(node: object) -> object:
        if isinstance(node, ir.Name) and node.id.lower() in names:
            return replace(node, id=names[node.id.lower()])
        return node

    kept = tuple(
        one for one in routine.declarations if not (isinstance(one, ir.Variable) and one.name.lower() in names)
    )
    done = edit_bodies(routine, lambda body: tuple(rewrite(one, change) for one in body))
    return replace(done, parameters=(), declarations=kept)


__all__ = ["task_arguments"]
