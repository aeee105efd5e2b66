"""Numbers read from a text that may go on behind them (V+ VAL), for targets where such a text is an error: a function
of the program reads it sign by sign. It gives 0 where no number begins, as the source does; what is written out becomes
its number.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.library import common_library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.numeric import written_number
from rpl.passes.scope import rules_of

_HELPER = "rpl_leading_number"


@legalising(
    unless=lambda context: (
        TextRule.LEADING_NUMBERS in context.capabilities.texts.rules
        or context.capabilities.carries_rules
        or not rules_of(context.source).leading_numbers
    ),
    sees=("function text_value",),
)
def leading_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that read texts which hold nothing but a number."""
    worker = _Leading(program, context)
    return worker.helpers.added_to(worker.program())


class _Leading(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = common_library(context)
        self.marks = rules_of(context.source).number_marks

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        match done:
            case ir.Builtin(function="text_value", arguments=(ir.TextLiteral(value=text),)):
                number = written_number(text, self.marks, leading=True) or 0
                size = ir.RealLiteral(abs(float(number)))
                return ir.Unary("-", size, origin=done.origin) if number < 0 else size
            case ir.Builtin(function="text_value", arguments=(text,)):
                return self.helpers.call(_HELPER, text)
        return done


__all__ = ["leading_numbers"]
