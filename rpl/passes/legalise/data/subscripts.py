"""Subscripts one behind the other as one: `m[i][j]` is `m[i, j]` of an array with two dimensions, for targets that keep
arrays as consecutive numbers.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import Composite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising


@legalising(sees=("Index",))
def joined_subscripts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without arrays of their own."""
    return program if Composite.ARRAYS in context.capabilities.data.composites else _Joined(program, context).program()


class _Joined(Rewriter):
    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Index(base=ir.Index(base=array, indices=outer), indices=inner):
                type = self.type_of(array)
                if isinstance(type, ir.ArrayType) and len(outer) + len(inner) <= len(type.dimensions):
                    return self.expression(replace(expression, base=array, indices=(*outer, *inner)))
        return super().expression(expression)
