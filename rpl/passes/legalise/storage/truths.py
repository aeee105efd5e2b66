"""Truth values as numbers, for targets without a type (or a bank) of truth values: 1 and 0, or -1 and 0.

Stored truth values are numbers; where one decides something it is asked whether it differs from zero, and what a
comparison or a signal gives is made a number where it is stored. Runs behind everything that makes truth values.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_LOGIC = ("and", "or", "cand", "cor", "xor")
_COMPARED = ("=", "<>", "<", ">", "<=", ">=")
_STORED = (ir.Name, ir.Index, ir.Field, ir.Call)


@legalising()
def truths_to_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that cannot declare truth values."""
    can = context.capabilities
    kept = "BoolType" in can.storage.banks if can.storage.banks else "BoolType" in can.types
    return program if kept else _Truths(program, context).program()


class _Truths(Rewriter):
    """`expression` gives a truth value in the form that decides, `stored` the number for it."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        can = context.capabilities
        have = can.storage.banks or can.types
        self.number: ir.Type = ir.IntType() if "IntType" in have else ir.RealType()
        self.yes = -1 if DataRule.TRUE_IS_MINUS_ONE in can.data.rules else 1

    def type(self, type: ir.Type) -> ir.Type:
        return self.number if isinstance(type, ir.BoolType) else super().type(type)

    def is_truth(self, expression: ir.Expression) -> bool:
        return isinstance(self.type_of(expression), ir.BoolType)

    def is_kept(self, expression: ir.Expression) -> bool:
        """Is it a truth value in a variable (not in a component of a type that the controller has)?"""
        if isinstance(expression, ir.Field):
            return isinstance(self.type_of(expression.base), ir.NamedType) and self.is_truth(expression)
        return isinstance(expression, _STORED) and self.is_truth(expression)

    # ---- the two forms

    def literal(self, value: int) -> ir.Expression:
        return ir.IntLiteral(value) if isinstance(self.number, ir.IntType) else ir.RealLiteral(float(value))

    def stored(self, expression: ir.Expression) -> ir.Expression:
        """As it is stored: a truth value as a number, everything else as ever."""
        match expression:
            case ir.BoolLiteral(value=value):
                return replace(self.literal(self.yes if value else 0), origin=expression.origin)
            case ir.Convert(how="bit" | "minus_bit"):
                return self.expression(expression)
        if self.is_kept(expression):
            return self.parts(expression)
        if not self.is_truth(expression):
            return self.expression(expression)
        return ir.Convert(self.how(), self.expression(expression), origin=expression.origin)

    def how(self) -> str:
        return "minus_bit" if self.yes < 0 else "bit"

    def parts(self, expression: ir.Expression) -> ir.Expression:
        """A place or a call with its subscripts and arguments in the new form."""
        if isinstance(expression, ir.Call):
            return replace(expression, arguments=self.arguments(expression.arguments))
        return super().expression(expression)

    def arguments(self, given: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        return tuple(one if one.value is None else replace(one, value=self.stored(one.value)) for one in given)

    # ---- expressions

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if self.is_kept(expression):
            return ir.Binary("<>", self.parts(expression), self.literal(0), origin=expression.origin)
        match expression:
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARED and self.is_truth(left):
                return self.compared(expression, left, right)
            case ir.Convert(how="bit" | "minus_bit" as how, operand=operand) if self.is_kept(operand):
                kept = self.parts(operand)
                return kept if how == self.how() else ir.Unary("-", kept, origin=expression.origin)
            case ir.Call():
                return self.parts(expression)
            case ir.Aggregate(entries=entries):
                if isinstance(self.type_of(expression), ir.ArrayType | ir.NamedType | None):
                    return replace(expression, entries=tuple((name, self.stored(value)) for name, value in entries))
        return super().expression(expression)

    def compared(self, expression: ir.Binary, left: ir.Expression, right: ir.Expression) -> ir.Expression:
        """Two truth values: as numbers where one is a number in a variable, else as they are."""
        if self.is_kept(left) or self.is_kept(right):
            return replace(expression, left=self.stored(left), right=self.stored(right))
        return replace(expression, left=self.expression(left), right=self.expression(right))

    # ---- statements and declarations

    def initial(self, value: ir.Expression, declaration: ir.Variable) -> ir.Expression | None:
        return self.stored(value)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=target, value=value):
                kept = self.is_kept(target) or not self.is_truth(target)
                new = self.stored(value) if kept else self.expression(value)
                return [replace(statement, target=self.place(target), value=new)]
            case ir.Return(value=value) if value is not None:
                return [replace(statement, value=self.stored(value))]
            case ir.CallRoutine(arguments=arguments, dynamic=None):
                return [replace(statement, arguments=self.arguments(arguments))]
        return super().statement(statement)

    def place(self, target: ir.Expression) -> ir.Expression:
        return self.parts(target) if isinstance(target, _STORED) else super().expression(target)

    def placed(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Switch) and self.is_truth(statement.selector):
            cases = tuple(replace(one, values=tuple(map(_number_case, one.values))) for one in statement.cases)
            selector = ir.Convert("bit", statement.selector)
            return super().placed(replace(statement, selector=selector, cases=cases))
        return super().placed(statement)


def _number_case(value: ir.Expression) -> ir.Expression:
    return ir.IntLiteral(int(value.value)) if isinstance(value, ir.BoolLiteral) else ir.Convert("bit", value)
