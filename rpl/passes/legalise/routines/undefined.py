"""Questions whether a variable has a value yet (V+ DEFINED, KRL VARSTATE), for targets that cannot ask.

What is assigned on every way to the question has a value, and so has a parameter that each call gives one. All other
questions are refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.forward import Forward
from rpl.passes.legalise.facts.usage import base_name, each_expression, each_statement
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope

REFUSED = code(
    "value-question-lost",
    Severity.LOSS,
    "the target cannot ask whether {name} has a value yet",
    "give it a first value that means none, or keep a BOOL beside it",
    stops=True,
)
_ASKED = "is_uninitialised"
_NONE: frozenset[str] = frozenset()


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
    values = _Assigned(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Answers(values.scopes.routine(module, routine), values.at, certain, calls).body)

    return edit_each(program, work)


class _Assigned(Forward[frozenset[str]]):
    """`at`: variables (folded names) that were surely assigned in front of each statement, in the same run of its
    routine. Once assigned, a variable keeps a value."""

    def __init__(self, program: ir.Program) -> None:
        super().__init__(program, _NONE, _NONE)
        self.at: dict[int, frozenset[str]] = {}
        self.solve(self.by_name, ())

    def join(self, one: frozenset[str], other: frozenset[str]) -> frozenset[str]:
        return one if one <= other else one & other

    def transfer(self, statement: ir.Statement, before: frozenset[str]) -> frozenset[str]:
        return before | _assigned(statement)

    def note(self, statement: ir.Statement, before: frozenset[str]) -> None:
        looks = before - _assigned(statement) if isinstance(statement, ir.For) else before  # its bounds come first
        self.at[id(statement)] = self.at.get(id(statement), looks) & looks

    def entered(self, state: frozenset[str], here: Scope, there: Scope) -> frozenset[str]:
        return _NONE

    def left(
        self, before: frozenset[str], end: frozenset[str], routine: ir.Routine, there: Scope, here: Scope
    ) -> frozenset[str]:
        return before


def _assigned(statement: ir.Statement) -> frozenset[str]:
    """The variables (folded) that a statement gives a value whenever it runs."""
    place: ir.Expression | None = None
    match statement:
        case ir.Assign(target=target):
            place = target
        case ir.For(counter=counter, scoped=False):
            place = ir.Name(counter)
        case ir.Do(procedure="increment" | "decrement" | "clear" | "text_clear" | "text_copy" | "text_append"):
            place = statement.arguments[0]
        case ir.WaitUntil(timed_out=flag):
            place = flag
    name = None if place is None else base_name(place)
    return _NONE if name is None else frozenset((name,))


@dataclass(frozen=True, slots=True)
class _Answers:
    """One routine. at: what has a value in front of each statement; certain: ids of parameters that have one."""

    scope: Scope
    at: Mapping[int, frozenset[str]]
    certain: frozenset[int]
    calls: _Calls

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        known = self.at.get(id(statement), _NONE)
        if isinstance(statement, ir.CallRoutine):
            self.note(statement.name, statement.arguments, known)
        return (rewrite_parts(statement, partial(self.expression, known=known), self.body),)

    def expression(self, expression: ir.Expression, known: frozenset[str]) -> ir.Expression:
        done = rewrite_parts(expression, partial(self.expression, known=known))
        match done:
            case ir.Builtin(function=function, arguments=(ir.Name(id=name),)) if function == _ASKED:
                return ir.BoolLiteral(False, origin=done.origin) if self.has_value(name, known) else done
            case ir.Unary(op="not", operand=ir.BoolLiteral(value=value)):
                return ir.BoolLiteral(not value, origin=done.origin)
            case ir.Call(name=name, arguments=arguments):
                self.note(name, arguments, known)
        return done

    def has_value(self, name: str, known: frozenset[str]) -> bool:
        symbol = self.scope.value(name)
        if name.lower() in known or symbol is None:
            return symbol is not None
        declaration = symbol.declaration
        starts = isinstance(declaration, ir.Variable) and declaration.initial is not None
        return starts or id(declaration) in self.certain

    def note(self, name: str, arguments: tuple[ir.Argument, ...], known: frozenset[str]) -> None:
        """Which parameters a call gives a value."""
        routine = self.scope.routine(name)
        for parameter, value in () if routine is None else _given(routine, arguments, self.scope):
            certain = value is not None and not (isinstance(value, ir.Name) and not self.has_value(value.id, known))
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
    nodes = list(
        walk_for(
            {"CallRoutine", "TaskControl", "DeclareInterrupt", "Trigger", "DefineTrigger", "Spline", "OrderInterrupt"},
            *program.modules,
        )
    )
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
