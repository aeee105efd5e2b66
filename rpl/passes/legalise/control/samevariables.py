"""Parameters that every call gives the same variable, for targets whose routines have none: the routine looks at the
variable itself, as people do there (`B001` is the column, in the job that counts and in the one that stacks).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.capabilities import Parameters
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.locals import renamed
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.mentioned import naming_of_routines
from rpl.passes.legalise.facts.usage import given_beside, given_by_reference, written_in
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.passes.scope import ProgramScope

__all__ = ["same_variables"]

_CALLS = frozenset(("CallRoutine",))


@legalising(unless=lambda context: context.capabilities.routines.parameters is not Parameters.NONE, sees=_CALLS)
def same_variables(program: ir.Program, context: Context) -> ir.Program:
    """Only numbers and flags of the one routine that calls, which nothing else can change meanwhile."""
    shared = _shared(program)
    if not shared:
        return program
    declared = Counter(
        one.name.lower()
        for module in program.modules
        for part in (module.declarations, *((*each.parameters, *each.declarations) for each in module.routines))
        for one in part
        if isinstance(one, ir.Variable | ir.Parameter)
    )
    worker = _Sharing(shared, {})
    for one in shared:
        stays = declared[one.variable.name.lower()] == 1
        worker.names[one.home] = one.variable.name if stays else context.fresh(one.variable.name)
    return worker.program(program)


@dataclass(frozen=True, slots=True)
class _Shared:
    """A parameter of a routine (by identity, with the place of the argument), and the caller's variable (by identity
    of the caller)."""

    routine: int
    at: int
    parameter: str
    caller: int
    variable: ir.Variable

    @property
    def home(self) -> tuple[int, str]:
        return self.caller, self.variable.name.lower()


def _shared(program: ir.Program) -> list[_Shared]:
    scopes, facts, named = ProgramScope(program), Activations.of(program), naming_of_routines(program)
    once = Counter(one.name.lower() for module in program.modules for one in module.routines)
    entries = {program.entry.lower(), *(task.entry.lower() for task in program.tasks)} | named_by_texts(program)
    alone = facts.routines.keys() - facts.recursive - facts.beside
    calls: dict[str, list[tuple[ir.Routine, ir.CallRoutine]]] = {}
    for _, caller in scopes.routines():
        for body in bodies(caller):
            for statement in statements_in(body):
                if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
                    calls.setdefault(statement.name.lower(), []).append((caller, statement))
    found: list[_Shared] = []
    for module, routine in scopes.routines():
        key = routine.name.lower()
        own = calls.get(key, [])
        callers = {id(caller): caller for caller, _ in own}
        if once[key] != 1 or key in entries or len(own) != named[key] or len(callers) != 1:
            continue
        ((identity, caller),) = callers.items()
        if not {id(routine), identity} <= alone:
            continue
        lent = given_by_reference(program, caller) | given_beside(caller)
        written, scope = written_in(routine), scopes.routine(module, routine)
        for at, parameter in enumerate(routine.parameters):
            variable = _variable_given(caller, [call for _, call in own], routine, at)
            plain = parameter.mode == "value" and not parameter.optional and parameter.name.lower() not in written
            if variable is None or not plain or variable.name.lower() in lent:
                continue
            type = scope.resolve(parameter.type)
            if type == variable.type and isinstance(type, ir.IntType | ir.RealType | ir.BoolType):
                found.append(_Shared(id(routine), at, parameter.name.lower(), identity, variable))
    return found


def _variable_given(
    caller: ir.Routine, calls: list[ir.CallRoutine], routine: ir.Routine, at: int
) -> ir.Variable | None:
    """The caller's own variable that all calls give at this place."""
    names: set[str] = set()
    for call in calls:
        plain = len(call.arguments) == len(routine.parameters) and not any(
            one.name or one.if_present is not None for one in call.arguments
        )
        value = call.arguments[at].value if plain else None
        if not isinstance(value, ir.Name):
            return None
        names.add(value.id.lower())
    if len(names) != 1:
        return None
    (name,) = names
    own = (one for one in caller.declarations if isinstance(one, ir.Variable) and one.name.lower() == name)
    found = next(own, None)
    given = {one.name.lower() for one in caller.parameters}
    if found is None or name in given or found.storage != "variable" or found.initial is not None:
        return None
    return found


@dataclass(frozen=True, slots=True)
class _Sharing:
    """`names`: what the variable of a caller is called in its module."""

    shared: list[_Shared]
    names: dict[tuple[int, str], str]

    def program(self, program: ir.Program) -> ir.Program:
        dropped: dict[str, set[int]] = {}
        modules = []
        for module in program.modules:
            made = [
                replace(one.variable, name=self.names[one.home], scope="global")
                for one in {one.home: one for one in self.shared}.values()
                if any(id(routine) == one.caller for routine in module.routines)
            ]
            for routine in module.routines:
                at = {one.at for one in self.shared if one.routine == id(routine)}
                if at:
                    dropped[routine.name.lower()] = at
            routines = tuple(self.routine(one) for one in module.routines)
            modules.append(changed(module, declarations=(*module.declarations, *made), routines=routines))
        return edit_all(replace(program, modules=tuple(modules)), lambda body: _without(body, dropped), _CALLS)

    def routine(self, routine: ir.Routine) -> ir.Routine:
        """The routine with the module's variables for its parameters and its own."""
        given = {one.parameter: self.names[one.home] for one in self.shared if one.routine == id(routine)}
        own = {one.home[1]: self.names[one.home] for one in self.shared if one.caller == id(routine)}
        if not given and not own:
            return routine
        at = {one.at for one in self.shared if one.routine == id(routine)}
        gone = given.keys() | own.keys()
        done = replace(
            routine,
            parameters=tuple(one for number, one in enumerate(routine.parameters) if number not in at),
            declarations=tuple(
                one for one in routine.declarations if not (isinstance(one, ir.Variable) and one.name.lower() in gone)
            ),
        )
        return edit_bodies(done, lambda body: renamed(body, given | own))


def _without(body: ir.Body, dropped: Mapping[str, set[int]]) -> ir.Body:
    """Calls without the arguments at these places."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.CallRoutine) and (at := dropped.get(statement.name.lower())):
            kept = tuple(one for number, one in enumerate(statement.arguments) if number not in at)
            return (replace(statement, arguments=kept),)
        return (inside(statement, lambda inner: _without(inner, dropped)),)

    return map_body(body, change, _CALLS)
