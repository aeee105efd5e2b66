"""Functions, conversions and operators of numbers that a weak target lacks, by functions in terms of what it has.

Runs behind everything that makes formulas (geometry, products of poses) and before functions become procedures. Targets
with variables by names have had their functions from the pass of numbers, which rests on an angle of two numbers.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import Limit
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.formulas import function, number
from rpl.passes.legalise.rewriting.library import Library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising


@legalising(
    unless=lambda context: (
        not context.capabilities.storage.banks
        and Limit.STEPS not in context.capabilities.control.limits
        and (Limit.FUNCTIONS_ALONE not in context.capabilities.control.limits)
        and "atan2" in context.capabilities.functions
    )
)
def arithmetic(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with numbered data or simple expressions, or without the angle of two numbers."""
    worker = _Arithmetic(program, context)
    done = worker.program()
    return worker.library.added_to(done, done.modules[0].task if done.modules else "")


class _Arithmetic(Rewriter):
    acts_on = frozenset(("Builtin", "Convert", "operator xor"))

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        own = {"rpl_atan2": "atan2"} if self.has("atan2") else {}
        self.library = Library(context, ("simplenumbers",), own)

    def has(self, function_name: str) -> bool:
        return function_name in self.context.capabilities.functions

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function=name, arguments=arguments) if not self.has(name):
                whole = all(isinstance(self.type_of(one), ir.IntType) for one in arguments)
                key = f"{name}_whole" if whole and self.library.takes(f"rpl_{name}_whole") else name
                if self.library.takes(f"rpl_{key}") == len(arguments):
                    return self.made(key, *map(self.expression, arguments))
            case ir.Convert(how="real", operand=operand) if "IntType" not in self.context.capabilities.types:
                return self.expression(operand)
            case ir.Convert(how=how, operand=operand) if how not in self.context.capabilities.conversions:
                done = self.converted(expression, how, operand)
                if done is not None:
                    return done
            case ir.Binary(op="xor", left=left, right=right) if "xor" not in self.context.capabilities.operators:
                left, right = self.expression(left), self.expression(right)
                return ir.Binary("<>", left, right, origin=expression.origin)
        return super().expression(expression)

    def converted(self, expression: ir.Convert, how: str, operand: ir.Expression) -> ir.Expression | None:
        new = self.expression(operand)
        whole = isinstance(self.type_of(operand), ir.IntType)
        match how:
            case "round_half_away" | "floor" | "trunc" if whole:
                return new
            case "round_half_away" if self.has("round"):
                return function("round", new)
            case "round_half_away":
                return self.made("round", new)
            case "floor":
                return function("floor", new) if self.has("floor") else self.made("floor", new)
            case "truth":
                zero = ir.IntLiteral(0) if whole else number(0)
                return ir.Binary("<>", new, zero, origin=expression.origin)
            case "bit" | "minus_bit":
                return self.made(how, new)
        return None

    def made(self, key: str, *arguments: ir.Expression) -> ir.Expression:
        return self.library.call(f"rpl_{key}", *arguments)
