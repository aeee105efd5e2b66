"""Numbers of errors that a program writes as numbers: controllers number the same errors differently.

Where an error is raised, caught or asked for, its name is all that counts, and a number of the source's stands for that
name. A number that is kept, shown or counted with is refused. In front of the pass that brings the source's own names
along.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rpl import ir
from rpl.ir.errornames import spelled_among
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_NUMBER = ir.System("error_number")


@legalising(sees=("Raise", "System", "Handler"))
def error_numbers(program: ir.Program, context: Context) -> ir.Program:
    """RAPID numbers errors otherwise than the source does."""
    theirs = rules_of(context.target).errors
    numbers = {name: number for name, number in rules_of(context.source).errors.items() if spelled_among(name, theirs)}
    return _Named(program, context, numbers).program() if numbers else program


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


__all__ = ["error_numbers"]
