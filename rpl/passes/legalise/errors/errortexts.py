"""The text of an error's number (V+ $ERROR), for targets without such a function: the source's names of its errors.

A number of no known error is its own text, as in a run of the source.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: "error_text" in context.capabilities.functions, sees=("function error_text",))
def error_texts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the function."""
    name = context.fresh("rpl_error_text")
    texts = _Texts(program, context, name)
    done = texts.program()
    return with_support(done, context, (), (_function(name, context),)) if texts.asked else program


class _Texts(Rewriter):
    def __init__(self, program: ir.Program, context: Context, function: str) -> None:
        super().__init__(program, context)
        self.function, self.asked = function, False

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if isinstance(done, ir.Builtin) and done.function == "error_text":
            self.asked = True
            arguments = tuple(ir.Argument(one) for one in done.arguments)
            return ir.Call(self.function, arguments, origin=done.origin)
        return done


def _function(name: str, context: Context) -> ir.Routine:
    number = ir.Name("error")
    branches: list[tuple[ir.Expression, ir.Body]] = []
    for text, value in rules_of(context.source).errors.items():
        same = ir.Binary("=", number, ir.RealLiteral(float(value)))
        branches.append((same, (ir.Return(ir.TextLiteral(text)),)))
    itself = ir.Return(ir.Builtin("number_text", (number, ir.IntLiteral(0))))
    body: ir.Body = (ir.If(tuple(branches)), itself) if branches else (itself,)
    parameter = ir.Parameter("error", ir.RealType())
    return ir.Routine(name, "function", (parameter,), ir.StringType(), body=body, scope="global")


__all__ = ["error_texts"]
