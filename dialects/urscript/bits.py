"""Whole numbers as lists of 32 truth values and back: the lowest bit first, the last one the sign."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.ir.walk import walk

from .arguments import Bound, given, written
from .expressions import Expressions
from .kinds import BOOL, INT

_BITS = 32
_AT_ONCE = 8  # more of them make lines too long for a controller


def _bits(reader: Expressions, bound: Bound) -> ir.Expression:
    """integer_to_binary_list. floor(x / 2^n) is odd where bit n is set, for negative numbers too."""
    number = given(reader, bound, "x", INT)
    if any(isinstance(node, ir.Call) for node in walk(number)):
        number = reader.held(written(bound, "x"))  # it would be called 32 times
    shares = [number, *(ir.Binary("/", number, ir.RealLiteral(float(2**n))) for n in range(1, _BITS))]
    whole = [shares[0], *(ir.Convert("floor", one) for one in shares[1:])]
    odd = [ir.Binary("<>", ir.Binary("mod", one, ir.IntLiteral(2)), ir.IntLiteral(0)) for one in whole]
    return ir.Aggregate(tuple((None, one) for one in odd))


def _whole(reader: Expressions, bound: Bound) -> ir.Expression | None:
    """binary_list_to_integer, of a list whose length is known; what stands behind the first 32 bits does not count."""
    bits = written(bound, "l")
    kind = reader.kind(bits)
    if kind is None or kind.word != "list" or kind.length is None or kind.element not in (None, BOOL):
        return None
    total: ir.Expression | None = None
    for place in range(min(kind.length, _BITS)):
        if total is not None and place % _AT_ONCE == 0:
            total = reader.kept_apart(total, INT)
        part = reader.element(bits, place)
        if part is None:
            return None
        bit: ir.Expression = ir.Convert("bit", part)
        if place > 0:
            bit = ir.Binary("*", bit, ir.IntLiteral(2**place if place < _BITS - 1 else -(2**place)))
        total = bit if total is None else ir.Binary("+", total, bit)
    return total if total is not None else ir.IntLiteral(0)


BITS: dict[str, Callable[[Expressions, Bound], ir.Expression | None]] = {
    "integer_to_binary_list": _bits,
    "binary_list_to_integer": _whole,
}
