"""Parameters that a routine writes: URScript passes copies only, so each leaves its value in a variable.

The routine copies such a parameter to a global variable where it ends, and the caller takes it from there. A parameter
that is only read becomes a plain copy. What the routine also sees by another name is not updated before it ends.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import base_name, written_in
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.places import fixed_place, is_open
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_bodies, rewrite_parts
from rpl.passes.scope import ProgramScope
from rpl.passes.typing import type_of

_LVALUES = (ir.Name, ir.Index, ir.Field)
Key = tuple[str, str]


@legalising()
def references_as_copies(program: ir.Program, context: Context) -> ir.Program:
    """Parameters by reference, which URScript has not."""
    facts = _Facts(program)
    results: dict[Key, str] = {}
    for routine, parameter in facts.references:
        if (routine, parameter) in facts.written:
            results[routine, parameter] = context.fresh(f"{routine}_{parameter}")
    if not facts.references:
        return program
    done = edit_routines(program, context, lambda editor, routine: _rewritten(editor, routine, facts, results))
    modules = tuple(
        replace(
            module,
            declarations=(*module.declarations, *facts.variables(module, results)),
            routines=tuple(map(_by_value, module.routines)),
        )
        for module in done.modules
    )
    return replace(done, modules=modules)


def _by_value(routine: ir.Routine) -> ir.Routine:
    parameters = tuple(replace(one, mode="value") for one in routine.parameters)
    return routine if parameters == routine.parameters else replace(routine, parameters=parameters)


@dataclass(slots=True)
class _Facts:
    """Which reference parameters a program has, which of them are written, and the types of what is passed."""

    program: ir.Program
    references: list[Key] = field(default_factory=list)
    written: set[Key] = field(default_factory=set)
    passed: dict[Key, ir.Type] = field(default_factory=dict)
    routines: dict[str, ir.Routine] = field(default_factory=dict)
    differing: set[Key] = field(default_factory=set)  # lists of several sizes are passed: one variable cannot hold them

    def __post_init__(self) -> None:
        handed: list[tuple[Key, Key]] = []  # a parameter given on as another one
        for module in self.program.modules:
            for routine in module.routines:
                self.routines.setdefault(routine.name.lower(), routine)
                for parameter in routine.parameters:
                    if parameter.mode == "reference":
                        self.references.append((routine.name.lower(), parameter.name.lower()))
        scopes = ProgramScope(self.program)
        known = set(self.references)
        for module in self.program.modules:
            for routine in module.routines:
                scope = scopes.routine(module, routine)
                own = {name for owner, name in known if owner == routine.name.lower()}
                for name, arguments in calls_in(routine):
                    for key, value in self.given(name, arguments):
                        type = type_of(value, scope)
                        if type is not None and not is_open(type):
                            self.differing |= {key} if self.passed.setdefault(key, type) != type else set()
                        base = base_name(value)
                        if base in own:
                            handed.append(((routine.name.lower(), base), key))
                for name in own & written_in(routine):
                    self.written.add((routine.name.lower(), name))
        size = -1
        while size != len(self.written):
            size = len(self.written)
            self.written.update(outer for outer, inner in handed if inner in self.written)
        for _ in handed:  # the size of a list that is given on is known where the first one passes it
            self.passed = {inner: self.passed[outer] for outer, inner in handed if outer in self.passed} | self.passed
            self.differing |= {inner for outer, inner in handed if outer in self.differing}

    def given(self, name: str, arguments: tuple[ir.Argument, ...]) -> list[tuple[Key, ir.Expression]]:
        """The reference parameters of a routine and what a call passes for them."""
        routine = self.routines.get(name.lower())
        if routine is None:
            return []
        by_name = {one.name.lower(): one for one in routine.parameters}
        found = []
        for at, argument in enumerate(arguments):
            parameter = by_name.get(argument.name.lower()) if argument.name else None
            if parameter is None and argument.name is None and at < len(routine.parameters):
                parameter = routine.parameters[at]
            if parameter is not None and parameter.mode == "reference" and argument.value is not None:
                found.append(((routine.name.lower(), parameter.name.lower()), argument.value))
        return found

    def variables(self, module: ir.Module, results: dict[Key, str]) -> tuple[ir.Variable, ...]:
        """The variables that the module's routines leave their parameters in."""
        made = []
        for routine in module.routines:
            for parameter in routine.parameters:
                key = (routine.name.lower(), parameter.name.lower())
                if key in results and self.routines.get(key[0]) is not None:
                    type = parameter.type
                    sizes = type.dimensions if isinstance(type, ir.ArrayType) else ()
                    if None in sizes and key not in self.differing:
                        type = self.passed.get(key, type)
                    made.append(ir.Variable(results.pop(key), type, scope="global"))
        return tuple(made)


def calls_in(routine: ir.Routine) -> list[tuple[str, tuple[ir.Argument, ...]]]:
    """All calls of user routines in a routine, as statements and in expressions."""
    found: list[tuple[str, tuple[ir.Argument, ...]]] = []

    def expression(one: ir.Expression) -> ir.Expression:
        if isinstance(one, ir.Call):
            found.append((one.name, one.arguments))
        return rewrite_parts(one, expression)

    def body(statements: ir.Body) -> ir.Body:
        for one in statements:
            if isinstance(one, ir.CallRoutine):
                found.append((one.name, one.arguments))
            rewrite_parts(one, expression, body)
        return statements

    for one in bodies(routine):
        body(one)
    return found


def _rewritten(editor: Editor, routine: ir.Routine, facts: _Facts, results: dict[Key, str]) -> ir.Routine:
    done = edit_bodies(routine, _Callers(editor, facts, results).body)
    own = {
        parameter.name: results[routine.name.lower(), parameter.name.lower()]
        for parameter in routine.parameters
        if (routine.name.lower(), parameter.name.lower()) in results
    }
    if not own:
        return done
    leave = tuple(ir.Assign(ir.Name(result), ir.Name(name)) for name, result in own.items())

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return):
            return expansion(statement.origin, (*leave, statement))
        if blocks(statement):
            return (rewrite_bodies(statement, lambda inner: map_body(inner, change)),)
        return (statement,)

    body = map_body(done.body, change)
    ends = body and isinstance(body[-1], ir.Return)
    return replace(done, body=body if ends else (*body, *leave))


class _Callers(Hoister):
    """Calls, and what the caller takes over behind them."""

    def __init__(self, editor: Editor, facts: _Facts, results: dict[Key, str]) -> None:
        super().__init__(editor, self.called)
        self.facts, self.results = facts, results

    def passed(self, name: str, arguments: tuple[ir.Argument, ...]) -> tuple[ir.Body, tuple[ir.Argument, ...], ir.Body]:
        """What runs before a call, its arguments, and what takes over what the routine has left behind it. Places are
        chosen once: the routine may change what their subscripts are calculated from."""
        before: list[ir.Statement] = []
        behind: list[ir.Statement] = []
        fixed = {id(value): value for _, value in self.facts.given(name, arguments)}
        for key, value in self.facts.given(name, arguments):
            if key in self.results and isinstance(value, _LVALUES):
                fixed[id(value)] = place = fixed_place(value, before, self.editor)
                behind.append(ir.Assign(place, ir.Name(self.results[key])))
        given = tuple(
            one if one.value is None else changed(one, value=fixed.get(id(one.value), one.value)) for one in arguments
        )
        return tuple(before), given, tuple(behind)

    def called(self, expression: ir.Expression) -> Lowered | None:
        if not isinstance(expression, ir.Call):
            return None
        before, arguments, behind = self.passed(expression.name, expression.arguments)
        type = self.editor.type_of(expression)
        if not behind or type is None:
            return None
        result = self.editor.temporary("result", type)
        return (*before, ir.Assign(result, replace(expression, arguments=arguments)), *behind), result

    def placed(self, statement: ir.Statement) -> ir.Body:
        done = super().placed(statement)
        last = done[-1]
        if not isinstance(last, ir.CallRoutine):
            return done
        before, arguments, behind = self.passed(last.name, last.arguments)
        if not behind:
            return done
        return expansion(statement.origin, (*done[:-1], *before, replace(last, arguments=arguments), *behind))
