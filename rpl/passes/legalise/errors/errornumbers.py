"""Numbers of errors that a program uses as numbers: controllers number the same errors differently.

Where an error is raised, waited for, caught or asked for, its name is all that counts, and a number of the source's
stands for that name. A number that is kept, shown or counted with stays the source's: the value read in a handler is
found again by a function from the target's names. In front of the pass that brings the source's own names along.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.errornames import neutral_name, spelled_among
from rpl.ir.walk import walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

_NUMBER = ir.System("error_number")
# What a program must contain for such an error to come; the others may always.
_COMES_FROM: Mapping[str, tuple[type, ...]] = {
    "timeout": (ir.WaitUntil,),
    "dialog_timeout": (ir.Dialog,),
    "search_missed": (ir.Search,),
    "search_already": (ir.Search,),
    "path_not_stored": (ir.StoreMotion,),
    "already_connected": (ir.ConnectInterrupt,),
    "unknown_interrupt": (ir.ControlInterrupt,),
}


@legalising(sees=("Raise", "System", "Handler"))
def error_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with error handlers of their own, whose numbers are not the source's."""
    if not context.capabilities.errors.handlers:
        return program
    theirs = rules_of(context.target).errors
    numbers = {name: number for name, number in rules_of(context.source).errors.items() if spelled_among(name, theirs)}
    if not numbers:
        return program
    program = _Named(program, context, numbers).program()
    known = _Errors(program, numbers)
    if known.only_names():
        return program
    name = context.fresh("rpl_error_number")
    work = _Numbers(program, context, known, name)
    done = work.program()
    return with_support(done, context, (), (_function(name, program, numbers),)) if work.asked else done


def _same(node: object) -> tuple[ir.Expression, ir.Expression] | None:
    """The sides of a question whether two values are the same."""
    match node:
        case ir.Binary(op="=" | "<>", left=left, right=right):
            return left, right
    return None


def _literal(value: ir.Expression) -> float | None:
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return float(number)
        case ir.Convert(operand=operand):
            return _literal(operand)
    return None


class _Named(Rewriter):
    """Numbers of errors by their names, where only the name counts."""

    def __init__(self, program: ir.Program, context: Context, numbers: Mapping[str, int]) -> None:
        super().__init__(program, context)
        self.names = {float(number): name for name, number in numbers.items()}

    def named(self, code: ir.Expression) -> ir.Expression:
        if isinstance(code, ir.Name) and code.id.lower() in map(str.lower, self.names.values()):
            return code
        number = constant_number(code, self.scope)
        name = None if number is None else self.names.get(number)
        return code if name is None else ir.Name(name, origin=code.origin)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Binary(op="=" | "<>", left=ir.System(name="error_number"), right=right):
                return replace(expression, right=self.named(right))
            case ir.Binary(op="=" | "<>", left=left, right=ir.System(name="error_number")):
                return replace(expression, left=self.named(left))
        return super().expression(expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Raise) and statement.code is not None:
            return [replace(statement, code=self.named(statement.code))]
        return super().statement(statement)

    def placed(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Switch) and statement.selector == _NUMBER:
            cases = tuple(replace(case, values=tuple(map(self.named, case.values))) for case in statement.cases)
            statement = replace(statement, cases=cases)
        return super().placed(statement)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.enter(self.scopes.routine(module, routine))
        handlers = tuple(replace(one, codes=tuple(map(self.named, one.codes))) for one in routine.handlers)
        return super().routine(module, replace(routine, handlers=handlers))


@dataclass(slots=True)
class _Errors:
    """Where the numbers of errors go. `carriers`: variables that hold nothing but such numbers, which the program only
    compares with names of errors and with numbers of its own errors."""

    program: ir.Program
    numbers: Mapping[str, int]
    carriers: frozenset[str] = field(default=frozenset(), init=False)

    def __post_init__(self) -> None:
        scopes = ProgramScope(self.program)
        mentions: Counter[str] = Counter()
        allowed: Counter[str] = Counter()
        fed: set[str] = set()
        for module in self.program.modules:
            for routine in module.routines:
                scope = scopes.routine(module, routine)
                for node in walk(routine):
                    self.look(node, scope, mentions, allowed, fed)
        self.carriers = frozenset(name for name in fed if mentions[name] == allowed[name])

    def look(self, node: object, scope: Scope, mentions: Counter[str], allowed: Counter[str], fed: set[str]) -> None:
        match node:
            case ir.Name(id=name):
                mentions[name.lower()] += 1
            case ir.Assign(target=ir.Name(id=name), value=value) if self.plain(value, scope):
                allowed[name.lower()] += 1
                if value == _NUMBER:
                    fed.add(name.lower())
        sides = _same(node)
        if sides is not None:
            for one, other in (sides, sides[::-1]):
                if isinstance(one, ir.Name) and self.plain(other, scope):
                    allowed[one.id.lower()] += 1

    def plain(self, value: ir.Expression, scope: Scope) -> bool:
        """Is it the number of an error, by its name or as it comes, or one that no error of the system has?"""
        number = _literal(value)
        own = number is not None and number not in self.numbers.values()
        return value == _NUMBER or own or self.is_error(value, scope)

    def is_error(self, value: ir.Expression, scope: Scope) -> bool:
        if not isinstance(value, ir.Name) or value.id.lower() not in {name.lower() for name in self.numbers}:
            return False
        symbol = scope.value(value.id)
        return symbol is None or symbol.module is None

    def value(self, name: str) -> int:
        return next(number for one, number in self.numbers.items() if one.lower() == name.lower())

    def only_names(self) -> bool:
        """Does no number of an error go where it counts?"""
        asked: list[object] = []
        for node in walk(*self.program.modules):
            sides = _same(node)
            if sides is not None and _NUMBER in sides:
                asked.extend(side for side in sides if side == _NUMBER)
                continue
            match node:
                case ir.Raise(code=value) | ir.Switch(selector=value) if value == _NUMBER:
                    asked.append(node)
                case ir.Assign(target=ir.Name(id=name), value=value) if value == _NUMBER:
                    asked.extend([node] if name.lower() in self.carriers else [])
        return len(asked) == sum(1 for node in walk(*self.program.modules) if node == _NUMBER)


class _Numbers(Rewriter):
    """The source's numbers, where they count."""

    def __init__(self, program: ir.Program, context: Context, errors: _Errors, function: str) -> None:
        super().__init__(program, context)
        self.errors, self.function, self.asked = errors, function, False
        self.caught: str | None = None  # the one error that the handler here is for

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        handlers = routine.handlers
        done = super().routine(module, replace(routine, handlers=()))
        self.enter(self.scopes.routine(module, routine))
        kept = []
        for one in handlers:
            code = one.codes[0] if len(one.codes) == 1 else None
            self.caught = code.id if isinstance(code, ir.Name) and self.errors.is_error(code, self.scope) else None
            kept.append(replace(one, body=self.body(one.body)))
        self.caught = None
        return self.editor.closed(replace(done, handlers=tuple(kept)))

    def expression(self, expression: ir.Expression) -> ir.Expression:
        sides = _same(expression)
        if sides is not None and _NUMBER in sides:
            return expression
        if isinstance(expression, ir.Name) and self.errors.is_error(expression, self.scope):
            return ir.IntLiteral(self.errors.value(expression.id), origin=expression.origin)
        if expression == _NUMBER:
            if self.caught is not None:
                return ir.IntLiteral(self.errors.value(self.caught), origin=expression.origin)
            self.asked = True
            return ir.Call(self.function, (), origin=expression.origin)
        return super().expression(expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Raise():
                return [statement]
            case ir.Assign(target=ir.Name(id=name)) if name.lower() in self.errors.carriers:
                return [statement]
        return super().statement(statement)

    def placed(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Switch) and statement.selector == _NUMBER:
            cases = tuple(replace(case, body=self.body(case.body)) for case in statement.cases)
            default = None if statement.default is None else self.body(statement.default)
            return (replace(statement, cases=cases, default=default),)
        return super().placed(statement)


def _function(name: str, program: ir.Program, numbers: Mapping[str, int]) -> ir.Routine:
    """The source's number of the error that is being handled; an error of the program's own has its own."""
    kinds = {type(node) for node in walk(*program.modules)}
    cases = []
    for one, number in numbers.items():
        from_these = _COMES_FROM.get(neutral_name(one))
        if from_these is None or kinds.intersection(from_these):
            cases.append(ir.Case((ir.Name(one),), (ir.Return(ir.IntLiteral(number)),)))
    body = (ir.Switch(_NUMBER, tuple(cases), None), ir.Return(_NUMBER))
    return ir.Routine(name, "function", returns=ir.IntType(), body=body, scope="global")


__all__ = ["error_numbers"]
