"""Whole numbers as the bytes of a text and back (telegrams in binary), for targets without such functions: what is
written out becomes its characters; for the rest a function of the program goes over the bytes, most significant first.
"""

from __future__ import annotations

from typing import TypeGuard

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.library import common_library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

NO_BYTES = code(
    "text-bytes-lost",
    Severity.LOSS,
    "a number is written into a text as bytes, or read from one; the target's texts hold printable signs only",
    "send the number as digits",
)
_WRITES, _READS = "number_bytes", "bytes_number"


@legalising(
    unless=lambda context: {_WRITES, _READS} <= context.capabilities.functions,
    sees=(f"function {_WRITES}", f"function {_READS}"),
)
def text_bytes(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without functions for bytes."""
    first = next((node for node in walk_for({"Builtin"}, *program.modules) if _is_bytes(node)), None)
    if first is None:
        return program
    if TextRule.PRINTABLE in context.capabilities.texts.rules:  # the writer guards the steps
        context.diagnostics.report(NO_BYTES, first.origin)
        return program
    worker = _Bytes(program, context)
    return worker.helpers.added_to(worker.program())


def _is_bytes(node: object) -> TypeGuard[ir.Builtin]:
    return isinstance(node, ir.Builtin) and node.function in (_WRITES, _READS)


class _Bytes(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = common_library(context)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if not _is_bytes(done):
            return done
        numbers = done.arguments if done.function == _WRITES else done.arguments[1:]
        known = [_constant(one) for one in numbers]
        if done.function == _WRITES and known[0] is not None and known[1] is not None:
            return _characters(known[0], known[1], done)
        assert isinstance(expression, ir.Builtin)  # as `done` is one
        old = expression.arguments if done.function == _WRITES else expression.arguments[1:]
        whole = [
            ir.IntLiteral(n) if n is not None and n >= 0 else self.whole(value, before)
            for n, value, before in zip(known, numbers, old, strict=True)
        ]
        given = whole if done.function == _WRITES else [done.arguments[0], *whole]
        return self.helpers.call(f"rpl_{done.function}", *given)

    def whole(self, value: ir.Expression, old: ir.Expression) -> ir.Expression:
        """A real number is rounded."""
        return ir.Convert("round_half_away", value) if isinstance(self.type_of(old), ir.RealType) else value


def _characters(number: int, count: int, call: ir.Builtin) -> ir.Expression:
    size = max(count, 1)
    codes = (number % (1 << 8 * size)).to_bytes(size, "big")
    parts = [ir.Builtin("from_code", (ir.IntLiteral(code),), origin=call.origin) for code in codes]
    joined: ir.Expression = parts[0]
    for part in parts[1:]:
        joined = ir.Binary("&", joined, part, origin=call.origin)
    return joined


def _constant(value: ir.Expression) -> int | None:
    match value:
        case ir.IntLiteral(value=number):
            return number
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            return -number
    return None


__all__ = ["text_bytes"]
