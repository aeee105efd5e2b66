"""Questions whether a variable has a value yet (V+ DEFINED, KRL VARSTATE), for targets that cannot ask.

A variable that is asked about gets a BOOL beside it that becomes TRUE wherever the variable is assigned; what is
assigned on every way to the question needs none. A parameter gets a parameter beside it. What cannot be followed
(single elements of lists, calls by a computed name, what happens on a path) stays, and the target refuses it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.definite import Definite
from rpl.passes.legalise.facts.usage import assigned_in, base_name
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

_ASKED = "is_uninitialised"
# Built-in procedures that always give their first argument a value.
_STORING = frozenset(("increment", "decrement", "clear", "text_clear", "text_copy", "text_append"))


@legalising(unless=lambda context: _ASKED in context.capabilities.functions, sees=("Builtin",))
def asked_values(program: ir.Program, context: Context) -> ir.Program:
    """The program without the question, as far as it can be followed."""
    if not any(isinstance(node, ir.Builtin) and node.function == _ASKED for node in walk(*program.modules)):
        return program
    program = _rewritten(program, context, _Flags())
    flags = _Facts(program).flags(context)
    return _rewritten(program, context, flags) if flags.names else program


@dataclass(slots=True)
class _Flags:
    """id of a declaration (variable or parameter) -> the name of the BOOL beside it."""

    names: dict[int, str] = field(default_factory=dict)

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

    def parameters(self, routine: ir.Routine) -> tuple[ir.Parameter, ...]:
        """The routine's parameters with their flags behind all of them."""
        more = (
            ir.Parameter(self.names[id(one)], ir.BoolType(), one.mode)
            for one in routine.parameters
            if id(one) in self.names
        )
        return (*routine.parameters, *more)


def _rewritten(program: ir.Program, context: Context, flags: _Flags) -> ir.Program:
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            flow = _Flow(scopes.routine(module, routine), context, flags)
            done = flow.routine(routine)
            declarations = (*flags.beside(routine.declarations), *flow.added)
            routines.append(replace(done, parameters=flags.parameters(routine), declarations=declarations))
        modules.append(replace(module, declarations=flags.beside(module.declarations), routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


class _Flow(Definite):
    """One routine: questions that are decided, questions that a flag answers, and where flags become TRUE."""

    def __init__(self, scope: Scope, context: Context, flags: _Flags) -> None:
        super().__init__()
        self.scope = scope
        self.context = context
        self.flags = flags
        self.added: list[ir.Variable] = []

    def question(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function=function, arguments=(ir.Name(id=name),)) if function == _ASKED:
                if name.lower() in self.known or _starts_with_value(name, self.scope):
                    return ir.BoolLiteral(False, origin=expression.origin)
                flag = self.flags.of(name, self.scope)
                return expression if flag is None else ir.Unary("not", ir.Name(flag), origin=expression.origin)
            case ir.Unary(op="not", operand=ir.Unary(op="not", operand=operand)):
                return operand
            case ir.Unary(op="not", operand=ir.BoolLiteral(value=value)):
                return ir.BoolLiteral(not value, origin=expression.origin)
            case ir.Call(name=routine, arguments=arguments):
                return replace(expression, arguments=self.arguments(routine, arguments))
        return expression

    def calling(self, statement: ir.CallRoutine) -> ir.CallRoutine:
        if statement.dynamic is not None:
            return statement
        return replace(statement, arguments=self.arguments(statement.name, statement.arguments))

    def now_set(self, name: str) -> ir.Body:
        """The flag of a variable that has just got its value."""
        flag = self.flags.of(name, self.scope)
        return () if flag is None else (ir.Assign(ir.Name(flag), ir.BoolLiteral(True)),)

    def arguments(self, name: str, arguments: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        """The arguments of a call, and the flags for the parameters that have one."""
        routine = self.scope.routine(name)
        if routine is None:
            return arguments
        more = []
        for parameter, value in _given(routine, arguments, self.scope):
            if id(parameter) in self.flags.names:
                flag = self.flags.of(value.id, self.scope) if isinstance(value, ir.Name) else None
                more.append(ir.Argument(self.certain(parameter) if flag is None else ir.Name(flag)))
        return (*arguments, *more)

    def certain(self, parameter: ir.Parameter) -> ir.Expression:
        """TRUE; a variable where the routine may write it."""
        if parameter.mode != "reference":
            return ir.BoolLiteral(True)
        if not self.added:
            name = self.context.fresh("has_value")
            self.added.append(ir.Variable(name, ir.BoolType(), ir.BoolLiteral(True), scope="routine"))
        return ir.Name(self.added[0].name)


def _starts_with_value(name: str, scope: Scope) -> bool:
    symbol = scope.value(name)
    return symbol is not None and isinstance(symbol.declaration, ir.Variable) and symbol.declaration.initial is not None


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
    """What the questions that are left ask about, and what is connected with it by calls."""

    def __init__(self, program: ir.Program) -> None:
        self.names: dict[int, str] = {}
        self.asked: set[int] = set()
        self.lost: set[int] = set()
        self.passed: list[tuple[int, ir.Parameter, bool]] = []  # variable, parameter, may the routine assign it?
        scopes = ProgramScope(program)
        for module, routine in scopes.routines():
            scope = scopes.routine(module, routine)
            for node in (node for body in bodies(routine) for node in walk(body)):
                self.node(node, scope)
        if any(isinstance(node, ir.CallRoutine) and node.dynamic is not None for node in walk(*program.modules)):
            self.lost.update(id(one) for _, routine in scopes.routines() for one in routine.parameters)
        for module in program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Initialise):
                    self.lose(scopes.module(module), base_name(declaration.assign.target))

    def known(self, scope: Scope, name: str) -> int | None:
        """The declaration of a variable or parameter."""
        symbol = scope.value(name)
        if symbol is None or not isinstance(symbol.declaration, ir.Variable | ir.Parameter):
            return None
        self.names[id(symbol.declaration)] = symbol.declaration.name
        return id(symbol.declaration)

    def lose(self, scope: Scope, *names: str | None) -> None:
        for name in names:
            found = self.known(scope, name) if name is not None else None
            if found is not None:
                self.lost.add(found)

    def node(self, node: object, scope: Scope) -> None:
        match node:
            case ir.Builtin(function=function, arguments=(ir.Name(id=name),)) if function == _ASKED:
                found = self.known(scope, name)
                if found is not None:
                    self.asked.add(found)
            case ir.CallRoutine(name=name, arguments=arguments) | ir.Call(name=name, arguments=arguments):
                self.call(name, arguments, scope)
            case ir.Do(procedure=procedure, arguments=arguments):
                changed = [one for one in arguments if isinstance(one, ir.Name | ir.Index | ir.Field)]
                self.lose(scope, *map(base_name, changed[1:] if procedure in _STORING else changed))
            case ir.DeclareInterrupt() | ir.Trigger() | ir.DefineTrigger() | ir.Spline() | ir.OrderInterrupt():
                self.lose(scope, *assigned_in((node,)), *(one for body in _actions(node) for one in assigned_in(body)))
                self.unfollowed(node, scope)
            case ir.Move(search=search, triggers=triggers):
                if search is not None:
                    places = [one for one in (search.found, search.hit) if one is not None]
                    self.lose(scope, *map(base_name, places))
                for one in triggers:
                    self.node(one, scope)
            case ir.Dialog(answer=answer, timed_out=flag):
                self.lose(scope, *(base_name(one) for one in (answer, flag) if one is not None))
            case ir.TaskControl(task=task, arguments=arguments) if arguments:
                started = scope.routine(task)
                self.lost.update(() if started is None else map(id, started.parameters))

    def unfollowed(self, node: object, scope: Scope) -> None:
        """Parameters of routines that are called beside the program."""
        for one in walk(node):
            if isinstance(one, ir.CallRoutine):
                routine = scope.routine(one.name)
                self.lost.update(() if routine is None else map(id, routine.parameters))

    def call(self, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
        routine = scope.routine(name)
        if routine is None:
            self.lose(scope, *(base_name(one.value) for one in arguments if one.value is not None))
            return
        changed = {one for body in bodies(routine) for one in assigned_in(body)}
        for parameter, value in _given(routine, arguments, scope):
            self.names[id(parameter)] = parameter.name
            if parameter.optional or parameter.switch:
                self.lost.add(id(parameter))
            writes = parameter.mode == "reference" and parameter.name.lower() in changed
            match value:
                case ir.Name(id=given):
                    found = self.known(scope, given)
                    if found is not None:
                        self.passed.append((found, parameter, writes))
                case ir.Index() | ir.Field() if writes:
                    self.lose(scope, base_name(value))

    def flags(self, context: Context) -> _Flags:
        wanted = set(self.asked)
        size = -1
        while size != len(wanted):
            size = len(wanted)
            for variable, parameter, writes in self.passed:
                if id(parameter) in wanted:
                    wanted.add(variable)
                if variable in wanted and writes:
                    wanted.add(id(parameter))
        lost = wanted & self.lost
        size = -1
        while size != len(lost):
            size = len(lost)
            for variable, parameter, writes in self.passed:
                pair = {variable, id(parameter)}
                if pair & lost and (writes or id(parameter) in wanted):
                    lost |= pair & wanted
        wanted -= lost
        return _Flags({one: context.fresh(self.flag_name(one)) for one in sorted(wanted, key=self.place)})

    def flag_name(self, one: int) -> str:
        return f"{self.names[one].lstrip('$#')}_set"

    def place(self, one: int) -> tuple[str, int]:
        """Names are given in an order that does not hang on where things are kept."""
        return self.names[one].lower(), list(self.names).index(one)


def _actions(node: object) -> list[ir.Body]:
    action = getattr(node, "action", None)
    return [(action,)] if isinstance(action, ir.Assign | ir.CallRoutine | ir.Do) else []
