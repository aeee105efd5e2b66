"""Arguments of tasks by reference (V+), for targets whose tasks take values or none: a parameter that nothing changes
while the task runs becomes a value. A start that gives a task a variable which either of them may change is refused.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import assigned_in, base_name
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

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
    if not any(isinstance(node, ir.TaskControl) and node.arguments for node in walk(*program.modules)):
        return program
    called = {node.name.lower() for node in walk(*program.modules) if isinstance(node, ir.CallRoutine | ir.Call)}
    starts = _starts(program)
    shared: dict[str, str] = {}  # task -> a parameter that is no value
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            name = routine.name.lower()
            given = [] if name in called else starts.get(name, [])
            values = _values(routine, given)
            parameters = tuple(replace(one, mode="value") if one in values else one for one in routine.parameters)
            left = [one.name for one in parameters if one.mode == "reference"]
            if left and name in starts:
                shared[name] = left[0]
            routines.append(replace(routine, parameters=parameters) if values else routine)
        modules.append(replace(module, routines=tuple(routines)))

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.TaskControl) and statement.op == "start" and statement.task.lower() in shared:
            told = {"name": shared[statement.task.lower()], "task": statement.task}
            return (stopped(statement, SHARED, context, **told),)
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(replace(program, modules=tuple(modules)), lambda body: map_body(body, change))


@dataclass(frozen=True, slots=True)
class _Start:
    """One start of a task: where it stands."""

    control: ir.TaskControl
    routine: ir.Routine
    scope: Scope


def _starts(program: ir.Program) -> dict[str, list[_Start]]:
    scopes = ProgramScope(program)
    found: dict[str, list[_Start]] = {}
    for module in program.modules:
        for routine in module.routines:
            for statement in (one for body in bodies(routine) for one in statements_in(body)):
                if isinstance(statement, ir.TaskControl) and statement.op == "start":
                    start = _Start(statement, routine, scopes.routine(module, routine))
                    found.setdefault(statement.task.lower(), []).append(start)
    return found


def _values(routine: ir.Routine, starts: Sequence[_Start]) -> list[ir.Parameter]:
    """The parameters by reference that are as good as values."""
    plain = all(not one.name and one.value is not None for start in starts for one in start.control.arguments)
    if not starts or not plain or any(len(one.control.arguments) != len(routine.parameters) for one in starts):
        return []
    written = assigned_in(*bodies(routine))
    return [
        one
        for at, one in enumerate(routine.parameters)
        if one.mode == "reference" and one.name.lower() not in written
        if all(_settled(start.control.arguments[at].value, start) for start in starts)
    ]


def _settled(value: ir.Expression | None, start: _Start) -> bool:
    """Does nothing change the argument behind the start? True of what is calculated for it, and of a variable of the
    routine that is set in one place."""
    if value is None or base_name(value) is None:
        return value is not None
    name = base_name(value)
    symbol = None if name is None else start.scope.value(name)
    if name is None or symbol is None or symbol.routine is None:
        return False
    set_in = Counter(
        one
        for body in bodies(start.routine)
        for statement in statements_in(body)
        for one in {*assigned_in((_alone(statement),))}
    )
    return set_in[name] <= 1


def _alone(statement: ir.Statement) -> ir.Statement:
    """The statement without the bodies inside."""
    return inside(statement, lambda body: ())


__all__ = ["task_references"]
