"""Questions whether a variable has a value yet (V+ DEFINED, KRL VARSTATE), for targets that cannot ask.

What is assigned on every way to the question has a value, and so has a parameter that each call gives one. All other
questions are refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.definite import Definite
from rpl.passes.legalise.facts.usage import base_name, each_expression, each_statement
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

REFUSED = code(
    "value-question-lost",
    Severity.LOSS,
    "the target cannot ask whether {name} has a value yet",
    "give it a first value that means none, or keep a BOOL beside it",
    stops=True,
)
_ASKED = "is_uninitialised"


@legalising(unless=lambda context: _ASKED in context.capabilities.functions, sees=(f"function {_ASKED}",))
def asked_values(program: ir.Program, context: Context) -> ir.Program:
    """The program without the question, as far as the answer is certain."""
    calls = _Calls()
    program = _rewritten(program, frozenset(), calls)
    program = _rewritten(program, _certain(program, calls), _Calls())
    for module in program.modules:
        for body in (body for routine in module.routines for body in bodies(routine)):
            each_statement(body, partial(_refused, context=context))
    return program


def _refused(statement: ir.Statement, context: Context) -> None:
    """Tell the questions of a statement that are left; no writer of such a target can say it."""

    def look(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Builtin) and expression.function == _ASKED:
            name = base_name(expression.arguments[0]) or "it"
            context.diagnostics.report(REFUSED, statement.origin, name=name)

    each_expression(statement, look)


@dataclass(slots=True)
class _Calls:
    """Parameters (routine, parameter; folded) that calls give a value for certain, and that one may not."""

    certain: set[tuple[str, str]] = field(default_factory=set)
    doubtful: set[tuple[str, str]] = field(default_factory=set)


def _rewritten(program: ir.Program, certain: frozenset[int], calls: _Calls) -> ir.Program:
    scopes = ProgramScope(program)
    modules = tuple(
        replace(
            module,
            routines=tuple(_Flow(scopes.routine(module, one), certain, calls).routine(one) for one in module.routines),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


class _Flow(Definite):
    """One routine. certain: ids of parameters that have a value."""

    def __init__(self, scope: Scope, certain: frozenset[int], calls: _Calls) -> None:
        super().__init__()
        self.scope, self.certain, self.calls = scope, certain, calls

    def question(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function=function, arguments=(ir.Name(id=name),)) if function == _ASKED:
                return ir.BoolLiteral(False, origin=expression.origin) if self.has_value(name) else expression
            case ir.Unary(op="not", operand=ir.BoolLiteral(value=value)):
                return ir.BoolLiteral(not value, origin=expression.origin)
            case ir.Call(name=name, arguments=arguments):
                self.note(name, arguments)
        return expression

    def has_value(self, name: str) -> bool:
        symbol = self.scope.value(name)
        if name.lower() in self.known or symbol is None:
            return symbol is not None
        declaration = symbol.declaration
        starts = isinstance(declaration, ir.Variable) and declaration.initial is not None
        return starts or id(declaration) in self.certain

    def calling(self, statement: ir.CallRoutine) -> ir.CallRoutine:
        self.note(statement.name, statement.arguments)
        return statement

    def note(self, name: str, arguments: tuple[ir.Argument, ...]) -> None:
        """Which parameters a call gives a value."""
        routine = self.scope.routine(name)
        for parameter, value in () if routine is None else _given(routine, arguments, self.scope):
            certain = value is not None and not (isinstance(value, ir.Name) and not self.has_value(value.id))
            certain = certain and not isinstance(value, ir.Index | ir.Field)
            (self.calls.certain if certain else self.calls.doubtful).add((name.lower(), parameter.name.lower()))


def _given(
    routine: ir.Routine, arguments: tuple[ir.Argument, ...], scope: Scope
) -> Iterator[tuple[ir.Parameter, ir.Expression | None]]:
    """Each parameter with the argument that a call gives it; optional ones are given by name and take no place."""
    by_name = {scope.fold(one.name): one.value for one in arguments if one.name}
    in_order = iter([one.value for one in arguments if not one.name])
    for parameter in routine.parameters:
        named = scope.fold(parameter.name) in by_name or parameter.optional or parameter.switch
        yield parameter, by_name.get(scope.fold(parameter.name)) if named else next(in_order, None)


def _certain(program: ir.Program, calls: _Calls) -> frozenset[int]:
    """Ids of the parameters that each call gives a value, of routines that are called by their name alone."""
    nodes = list(walk(*program.modules))
    if any(isinstance(node, ir.CallRoutine) and node.dynamic for node in nodes):
        return frozenset()
    beside = {node.task.lower() for node in nodes if isinstance(node, ir.TaskControl)}
    for node in nodes:
        if isinstance(node, ir.DeclareInterrupt | ir.Trigger | ir.DefineTrigger | ir.Spline | ir.OrderInterrupt):
            beside |= {one.name.lower() for one in walk(node) if isinstance(one, ir.CallRoutine)}
    given = calls.certain - calls.doubtful
    routines = [one for module in program.modules for one in module.routines if one.name.lower() not in beside]
    return frozenset(
        id(one)
        for routine in routines
        for one in routine.parameters
        if (routine.name.lower(), one.name.lower()) in given
    )
