"""Arguments of tasks by reference (V+), for targets whose tasks take values or none: a parameter that only ever stands
for one variable of the program becomes that variable, one that nothing changes while the task runs becomes a value.

Only in routines that are nothing but tasks. What does not fit stays, and the passes that follow name it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import assigned_in, base_name
from rpl.passes.legalise.rewriting.beside import local_names
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope


@legalising(sees=("TaskControl",))
def task_references(program: ir.Program, context: Context) -> ir.Program:
    """For every target that tells a task's arguments apart from its data."""
    if not any(isinstance(node, ir.TaskControl) and node.arguments for node in walk(*program.modules)):
        return program
    called = {node.name.lower() for node in walk(*program.modules) if isinstance(node, ir.CallRoutine | ir.Call)}
    starts = _starts(program)
    worker = _References({}, {})
    for module in program.modules:
        for routine in module.routines:
            name = routine.name.lower()
            if name in starts and name not in called:
                worker.decide(routine, starts[name])
    if not worker.kept and not worker.values:
        return program
    modules = tuple(replace(module, routines=tuple(map(worker.routine, module.routines))) for module in program.modules)
    return replace(program, modules=modules)


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


@dataclass(slots=True)
class _References:
    """`kept`: task -> the variable for each parameter that is replaced (by its place); `values`: task -> the places of
    parameters that become values."""

    kept: dict[str, dict[int, str]]
    values: dict[str, set[int]]

    def decide(self, routine: ir.Routine, starts: Sequence[_Start]) -> None:
        plain = all(not one.name and one.value is not None for start in starts for one in start.control.arguments)
        if not plain or any(len(start.control.arguments) != len(routine.parameters) for start in starts):
            return
        written = assigned_in(*bodies(routine))
        for at, parameter in enumerate(routine.parameters):
            if parameter.mode != "reference":
                continue
            given = [(start.control.arguments[at].value, start) for start in starts]
            shared = {_shared(value, start.scope) for value, start in given if value is not None}
            (alone,) = shared if len(shared) == 1 else (None,)
            hides = alone is not None and alone.lower() in local_names(routine) - {parameter.name.lower()}
            if alone is not None and not hides:
                self.kept.setdefault(routine.name.lower(), {})[at] = alone
            elif parameter.name.lower() not in written and all(_settled(value, start) for value, start in given):
                self.values.setdefault(routine.name.lower(), set()).add(at)

    def routine(self, routine: ir.Routine) -> ir.Routine:
        name = routine.name.lower()
        kept, values = self.kept.get(name, {}), self.values.get(name, set())
        if kept or values:
            names = {routine.parameters[at].name.lower(): variable for at, variable in kept.items()}

            def renamed(node: object) -> object:
                if isinstance(node, ir.Name) and node.id.lower() in names:
                    return replace(node, id=names[node.id.lower()])
                return node

            parameters = tuple(
                replace(one, mode="value") if at in values else one
                for at, one in enumerate(routine.parameters)
                if at not in kept
            )
            declarations = tuple(
                one for one in routine.declarations if not (isinstance(one, ir.Variable) and one.name.lower() in names)
            )
            done = edit_bodies(routine, lambda body: tuple(rewrite(one, renamed) for one in body))
            routine = replace(done, parameters=parameters, declarations=declarations)
        return edit_bodies(routine, lambda body: map_body(body, self.statement))

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.TaskControl) and statement.op == "start":
            gone = self.kept.get(statement.task.lower(), {})
            left = tuple(one for at, one in enumerate(statement.arguments) if at not in gone)
            return (replace(statement, arguments=left) if gone else statement,)
        return (inside(statement, lambda body: map_body(body, self.statement)),)


def _shared(value: ir.Expression, scope: Scope) -> str | None:
    """The variable of the program that is given as a whole; None for all else."""
    if not isinstance(value, ir.Name):
        return None
    symbol = scope.value(value.id)
    if symbol is None or symbol.routine is not None or not isinstance(symbol.declaration, ir.Variable):
        return None
    return symbol.declaration.name if symbol.declaration.scope == "global" else None


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
