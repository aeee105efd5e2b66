"""Questions whether a variable has a value yet (V+ DEFINED, KRL VARSTATE), for targets that cannot ask.

What is assigned on every way to the question has a value. Another variable gets a BOOL beside it that becomes TRUE
wherever the variable is assigned, as programmers of such targets write it. A parameter that each call gives a value has
one. Elements of lists, other parameters, and what routines or actions on a path give values are refused.
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
from rpl.passes.legalise.facts.usage import assigned_in, base_name, each_expression, each_statement
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
# Built-in procedures that always give their first argument a value.
_STORING = frozenset(("increment", "decrement", "clear", "text_clear", "text_copy", "text_append"))


@legalising(unless=lambda context: _ASKED in context.capabilities.functions, sees=(f"function {_ASKED}",))
def asked_values(program: ir.Program, context: Context) -> ir.Program:
    """The program without the question, as far as it can be followed."""
    calls = _Calls()
    program = _rewritten(program, _Flags(), calls)
    program = _rewritten(program, _Facts(program).flags(context, calls), _Calls())
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


@dataclass(slots=True)
class _Flags:
    """names: id of a declaration -> the name of the BOOL beside it; certain: ids of parameters that have a value."""

    names: dict[int, str] = field(default_factory=dict)
    certain: set[int] = field(default_factory=set)

    def of(self, name: str, scope: Scope) -> str | None:
        symbol = scope.value(name)
        return None if symbol is None else self.names.get(id(symbol.declaration))

    def beside(self, declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        """The declarations with the flags of the variables."""
        made: list[ir.Declaration] = []
        for one in declarations:
            made.append(one)
            name = self.names.get(id(one))
            if isinstance(one, ir.Variable) and name is not None:
                made.append(ir.Variable(name, ir.BoolType(), ir.BoolLiteral(False), one.storage, one.scope))
        return tuple(made)


def _rewritten(program: ir.Program, flags: _Flags, calls: _Calls) -> ir.Program:
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            done = _Flow(scopes.routine(module, routine), flags, calls).routine(routine)
            routines.append(replace(done, declarations=flags.beside(routine.declarations)))
        modules.append(replace(module, declarations=flags.beside(module.declarations), routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


class _Flow(Definite):
    """One routine: questions that are decided, questions that a flag answers, and where flags become TRUE."""

    def __init__(self, scope: Scope, flags: _Flags, calls: _Calls) -> None:
        super().__init__()
        self.scope, self.flags, self.calls = scope, flags, calls

    def question(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function=function, arguments=(ir.Name(id=name),)) if function == _ASKED:
                if self.has_value(name):
                    return ir.BoolLiteral(False, origin=expression.origin)
                flag = self.flags.of(name, self.scope)
                return expression if flag is None else ir.Unary("not", ir.Name(flag), origin=expression.origin)
            case ir.Unary(op="not", operand=ir.Unary(op="not", operand=operand)):
                return operand
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
        return starts or id(declaration) in self.flags.certain

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

    def now_set(self, name: str) -> ir.Body:
        """The flag of a variable that has just got its value."""
        flag = self.flags.of(name, self.scope)
        return () if flag is None else (ir.Assign(ir.Name(flag), ir.BoolLiteral(True)),)


def _given(
    routine: ir.Routine, arguments: tuple[ir.Argument, ...], scope: Scope
) -> Iterator[tuple[ir.Parameter, ir.Expression | None]]:
    """Each parameter with the argument that a call gives it; optional ones are given by name and take no place."""
    by_name = {scope.fold(one.name): one.value for one in arguments if one.name}
    in_order = iter([one.value for one in arguments if not one.name])
    for parameter in routine.parameters:
        named = scope.fold(parameter.name) in by_name or parameter.optional or parameter.switch
        yield parameter, by_name.get(scope.fold(parameter.name)) if named else next(in_order, None)


class _Facts:
    """asked: id of each variable that the questions which are left ask about -> its name; lost: ids of those that get
    values in other ways than by statements of their own."""

    def __init__(self, program: ir.Program) -> None:
        self.asked: dict[int, str] = {}
        self.lost: set[int] = set()
        self.beside: set[str] = set()  # routines (folded) that are called in other ways than by name
        self.program = program
        scopes = ProgramScope(program)
        for module, routine in scopes.routines():
            scope = scopes.routine(module, routine)
            for node in (node for body in bodies(routine) for node in walk(body)):
                self.node(node, scope)
        for module in program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Initialise):
                    self.lose(scopes.module(module), base_name(declaration.assign.target))

    def lose(self, scope: Scope, *names: str | None) -> None:
        for name in names:
            symbol = scope.value(name) if name is not None else None
            if symbol is not None:
                self.lost.add(id(symbol.declaration))

    def node(self, node: object, scope: Scope) -> None:
        match node:
            case ir.Builtin(function=function, arguments=(ir.Name(id=name),)) if function == _ASKED:
                symbol = scope.value(name)
                if symbol is not None and isinstance(symbol.declaration, ir.Variable):
                    self.asked[id(symbol.declaration)] = symbol.declaration.name
            case ir.CallRoutine(arguments=arguments, dynamic=dynamic) if dynamic is not None:
                self.lose(scope, *(base_name(one.value) for one in arguments if one.value is not None))
            case ir.CallRoutine(name=name, arguments=arguments) | ir.Call(name=name, arguments=arguments):
                self.call(name, arguments, scope)
            case ir.Do(procedure=procedure, arguments=arguments):
                changed = [one for one in arguments if isinstance(one, ir.Name | ir.Index | ir.Field)]
                self.lose(scope, *map(base_name, changed[1:] if procedure in _STORING else changed))
            case ir.DeclareInterrupt() | ir.Trigger() | ir.DefineTrigger() | ir.Spline() | ir.OrderInterrupt():
                self.lose(scope, *assigned_in((node,)), *(one for body in _actions(node) for one in assigned_in(body)))
                self.beside |= {one.name.lower() for one in walk(node) if isinstance(one, ir.CallRoutine)}
            case ir.Move(search=search, triggers=triggers):
                if search is not None:
                    places = [one for one in (search.found, search.hit) if one is not None]
                    self.lose(scope, *map(base_name, places))
                for one in triggers:
                    self.node(one, scope)
            case ir.Dialog(answer=answer, timed_out=flag):
                self.lose(scope, *(base_name(one) for one in (answer, flag) if one is not None))
            case ir.TaskControl(task=task, arguments=arguments) if arguments:
                self.call(task, arguments, scope)
                self.beside.add(task.lower())

    def call(self, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
        """What a routine may give a value through its parameters."""
        routine = scope.routine(name)
        if routine is None:
            self.lose(scope, *(base_name(one.value) for one in arguments if one.value is not None))
            return
        changed = assigned_in(*bodies(routine))
        for parameter, value in _given(routine, arguments, scope):
            if value is not None and parameter.mode == "reference" and parameter.name.lower() in changed:
                self.lose(scope, base_name(value))

    def flags(self, context: Context, calls: _Calls) -> _Flags:
        """Names are given in an order that does not hang on where things are kept."""
        wanted = sorted((key for key in self.asked if key not in self.lost), key=lambda key: self.asked[key].lower())
        dynamic = any(isinstance(node, ir.CallRoutine) and node.dynamic for node in walk(*self.program.modules))
        certain = set[int]()
        for routine in () if dynamic else (one for module in self.program.modules for one in module.routines):
            name = routine.name.lower()
            for one in routine.parameters if name not in self.beside else ():
                if (name, one.name.lower()) in calls.certain - calls.doubtful:
                    certain.add(id(one))
        return _Flags({key: context.fresh(f"{self.asked[key].lstrip('$#')}_set") for key in wanted}, certain)


def _actions(node: object) -> list[ir.Body]:
    action = getattr(node, "action", None)
    return [(action,)] if isinstance(action, ir.Assign | ir.CallRoutine | ir.Do) else []
