"""Texts that are compared by their order (`<`), for targets whose operators only tell whether texts are the same: a
function of the program compares them sign by sign, as the source's operators do.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.library import common_library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_ORDERS = frozenset(("<", "<=", ">", ">="))
_ACTS_ON = frozenset(f"operator {one}" for one in _ORDERS)
_HELPER = "rpl_text_order"


@legalising(
    unless=lambda context: TextRule.ORDER in context.capabilities.texts.rules or context.capabilities.carries_rules,
    sees=_ACTS_ON,
)
def text_orders(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose operators do not order texts."""
    worker = _Orders(program, context)
    return worker.helpers.added_to(worker.program())


class _Orders(Rewriter):
    acts_on = _ACTS_ON

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = common_library(context)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if isinstance(done, ir.Binary) and done.op in _ORDERS:
            sides = (done.left, done.right)
            if all(isinstance(self.type_of(side), ir.StringType) for side in sides):
                return ir.Binary(done.op, self.helpers.call(_HELPER, *sides), ir.IntLiteral(0), origin=done.origin)
        return done


__all__ = ["text_orders"]
