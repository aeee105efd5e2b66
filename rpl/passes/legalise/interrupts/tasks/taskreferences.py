"""Arguments of tasks by reference (V+), for targets whose tasks take values or none: a parameter that the task leaves
as it is and that each start gives a number, a text or something calculated becomes a value. A start that gives a task a
variable, which either of them may change, is refused.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import assigned_in, base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising

SHARED = code(
    "task-argument-shared",
    Severity.LOSS,
    "the target's tasks take values: {name} is shared between task {task} and what starts it",
    "let both use one variable of the program",
    stops=True,
)


@legalising(sees=("TaskControl",))
def task_references(program: ir.Program, context: Context) -> ir.Program:
    """For every target that tells a task's arguments apart from its data."""
    nodes = [*walk_for({"TaskControl", "Call", "CallRoutine"}, *program.modules)]
    starts = [one for one in nodes if isinstance(one, ir.TaskControl) and one.op == "start" and one.arguments]
    called = {one.name.lower() for one in nodes if isinstance(one, ir.CallRoutine | ir.Call)}
    shared: dict[str, str] = {}  # task -> a parameter that is no value

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        name = routine.name.lower()
        given = [one.arguments for one in starts if one.task.lower() == name]
        if not given:
            return routine
        fits = name not in called and all(len(one) == len(routine.parameters) for one in given)
        written = assigned_in(*bodies(routine))
        parameters = []
        for at, one in enumerate(routine.parameters):
            apart = fits and one.name.lower() not in written and all(_calculated(row[at]) for row in given)
            if one.mode == "reference" and not apart:
                shared.setdefault(name, one.name)
            parameters.append(replace(one, mode="value") if one.mode == "reference" and apart else one)
        return replace(routine, parameters=tuple(parameters))

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.TaskControl) and statement.op == "start" and statement.task.lower() in shared:
            told = {"name": shared[statement.task.lower()], "task": statement.task}
            return (stopped(statement, SHARED, context, **told),)
        return (inside(statement, lambda body: map_body(body, change)),)

    changed = edit_each(program, work) if starts else program
    return edit_all(changed, lambda body: map_body(body, change)) if shared else changed


def _calculated(argument: ir.Argument) -> bool:
    """Is it given by its place, and no variable?"""
    return not argument.name and argument.value is not None and base_name(argument.value) is None


__all__ = ["task_references"]
