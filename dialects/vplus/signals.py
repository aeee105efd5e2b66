"""V+ signal numbers: which physical signal a number means, when the number is written out and when it is not.

A number's size tells what it is: output, input, software signal, signal of the robot; its sign tells which state is
meant. A variable that only ever gets whole numbers of one kind is of that kind; of any other nothing is known before
the program runs, so the expression asks for all kinds.
"""

from __future__ import annotations

from collections.abc import Iterable

from rpl import ir
from rpl.reading.shapes import StatementError
from rpl.source import Origin

from . import tables
from .expressions import Facts, significant

_RANGES = tables.SIGNAL_RANGES


def kind_of(number: int) -> tuple[str, int] | None:
    """Neutral kind and what is taken off the number; None when there is no such signal."""
    for first, last, kind, offset in _RANGES:
        if first <= abs(number) <= last:
            return kind, offset
    return None


def split_sign(expression: ir.Expression) -> tuple[ir.Expression, bool]:
    """The number without its sign, and whether the sign asks for the signal to be on."""
    match expression:
        case ir.Unary(op="-", operand=operand):
            return operand, False
    return expression, True


def numbers_of(expression: ir.Expression, facts: Facts) -> frozenset[int]:
    """All values the expression can have; empty when nobody can tell."""
    match expression:
        case ir.IntLiteral(value=value):
            return frozenset((value,))
        case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
            return facts.numbers.get(significant(name), frozenset())
        case ir.Binary(op="+" | "-" | "*" as op, left=left, right=right):
            pairs = [(a, b) for a in numbers_of(left, facts) for b in numbers_of(right, facts)]
            return frozenset(a + b if op == "+" else a - b if op == "-" else a * b for a, b in pairs)
    return frozenset()


def known(number: ir.Expression, facts: Facts) -> ir.Expression:
    """A variable that only ever gets one whole number is that number."""
    values = numbers_of(number, facts)
    only = next(iter(values)) if len(values) == 1 and isinstance(number, ir.Name) else -1
    return ir.IntLiteral(only, origin=number.origin) if only >= 0 else number


def port(expression: ir.Expression, facts: Facts, origin: Origin) -> ir.Signal | None:
    """The physical signal of a number without sign; None when it could be of several kinds."""
    values = numbers_of(expression, facts)
    kinds = {kind_of(value) for value in values}
    if isinstance(expression, ir.IntLiteral) and kinds == {None}:
        raise StatementError(f"there is no signal {expression.value}", 0)
    if len(kinds) != 1 or any(value < 0 for value in values):
        return None
    found = next(iter(kinds))
    return None if found is None else signal(found[0], expression, found[1], origin)


def signal(kind: str, number: ir.Expression, offset: int, origin: Origin) -> ir.Signal:
    return ir.Signal(kind, less(number, offset), origin=origin)


def less(number: ir.Expression, offset: int) -> ir.Expression:
    """The number with an offset taken off."""
    if isinstance(number, ir.IntLiteral):
        return ir.IntLiteral(number.value - offset)
    return ir.Binary("-", number, ir.IntLiteral(offset)) if offset else number


def reading(operands: Iterable[ir.Expression], facts: Facts, origin: Origin) -> ir.Expression:
    """SIG(a, -b, ...): are all in the states asked for?"""
    whole: ir.Expression | None = None
    for operand in operands:
        number, wanted = split_sign(operand)
        value = _reading_of(number, facts, origin)
        if not wanted:
            value = ir.Unary("not", value, origin=origin)
        whole = value if whole is None else ir.Binary("and", whole, value, origin=origin)
    if whole is None:
        raise StatementError("SIG needs a signal number", 0)
    return whole


def _reading_of(number: ir.Expression, facts: Facts, origin: Origin) -> ir.Expression:
    """SIG(n): is the signal in the state that the sign asks for? The sign may show only when the program runs."""
    found = port(number, facts, origin)
    if found is not None:
        return found
    values = numbers_of(number, facts)
    if values and all(value > 0 for value in values):
        return _any_kind(number, origin, values)
    size = ir.Builtin("abs", (number,), origin=origin)
    kinds = {kind_of(value) for value in values}
    known = next(iter(kinds)) if len(kinds) == 1 else None
    state = _any_kind(size, origin, values) if known is None else signal(known[0], size, known[1], origin)
    if values and all(value < 0 for value in values):
        return ir.Unary("not", state, origin=origin)
    negative = ir.Binary("<", number, ir.IntLiteral(0), origin=origin)
    return ir.Binary("xor", state, negative, origin=origin)


def _any_kind(size: ir.Expression, origin: Origin, values: frozenset[int]) -> ir.Expression:
    """The signal of a number without sign: by its size, which only can be that of one of the values, where there are
    some."""
    sizes = {abs(value) for value in values}
    ranges = [one for one in _RANGES if not sizes or any(one[0] <= value <= one[1] for value in sizes)] or _RANGES
    done: ir.Expression | None = None
    for place, (first, last, kind, offset) in enumerate(ranges):
        here: ir.Expression = signal(kind, size, offset, origin)
        if not sizes or any(value > last for value in sizes):
            fits: ir.Expression = ir.Binary("<=", size, ir.IntLiteral(last), origin=origin)
            here = ir.Binary("cand", fits, here, origin=origin)
        if first > 1 and (not sizes or place > 0):
            above = ir.Binary(">=", size, ir.IntLiteral(first), origin=origin)
            here = ir.Binary("cand", above, here, origin=origin)
        done = here if done is None else ir.Binary("cor", done, here, origin=origin)
    assert done is not None
    return done


def switching(operand: ir.Expression, facts: Facts, origin: Origin) -> tuple[ir.Statement, ...] | None:
    """SIGNAL n or -n; None when the number is an input's."""
    number, on = split_sign(operand)
    found = port(number, facts, origin)
    if found is not None:
        if found.kind == "digital_in":
            return None
        return (ir.Assign(found, ir.BoolLiteral(on), origin=origin),)
    return (_by_size(number, on, origin),)


def _by_size(number: ir.Expression, on: bool, origin: Origin) -> ir.Statement:
    """A number of which nothing is known: its size and its sign decide when the program runs."""
    size = ir.Builtin("abs", (number,), origin=origin)
    positive = ir.Binary(">" if on else "<", number, ir.IntLiteral(0), origin=origin)
    branches = []
    for first, last, kind, offset in _RANGES:
        if kind == "digital_in":
            continue
        fits = ir.Binary("<=", size, ir.IntLiteral(last), origin=origin)
        if first > 1:
            above = ir.Binary(">=", size, ir.IntLiteral(first), origin=origin)
            fits = ir.Binary("and", above, fits, origin=origin)
        branches.append((fits, (ir.Assign(signal(kind, size, offset, origin), positive, origin=origin),)))
    return ir.If(tuple(branches), origin=origin)


def soft_bits(
    first: ir.Expression, count: ir.Expression | None, value: ir.Expression, facts: Facts, origin: Origin
) -> tuple[ir.Statement, ...] | None:
    """BITS of software signals = value: one signal after the other. None when the numbers are not known."""
    bits = _soft(first, count, facts)
    if bits is None:
        return None
    done = []
    for place, number in enumerate(bits):
        weight = ir.IntLiteral(1 << place)
        bit = ir.Binary("<>", ir.Binary("band", value, weight, origin=origin), ir.IntLiteral(0), origin=origin)
        done.append(ir.Assign(signal("flag", ir.IntLiteral(number), 0, origin), bit, origin=origin))
    return tuple(done)


def soft_number(
    first: ir.Expression, count: ir.Expression | None, facts: Facts, origin: Origin
) -> ir.Expression | None:
    """BITS(first, count) of software signals; None when the numbers are not known."""
    whole: ir.Expression | None = None
    for place, number in enumerate(_soft(first, count, facts) or ()):
        bit: ir.Expression = ir.Convert("bit", signal("flag", ir.IntLiteral(number), 0, origin), origin=origin)
        if place:
            bit = ir.Binary("*", ir.IntLiteral(1 << place), bit, origin=origin)
        whole = bit if whole is None else ir.Binary("+", whole, bit, origin=origin)
    return whole


def _soft(first: ir.Expression, count: ir.Expression | None, facts: Facts) -> range | None:
    """The numbers of the flags."""
    size = count if count is not None else ir.IntLiteral(1)
    match first, size:
        case ir.IntLiteral(value=start), ir.IntLiteral(value=length):
            kind = kind_of(start)
            return range(start - kind[1], start - kind[1] + length) if kind and kind[0] == "flag" else None
    return None


def group(first: ir.Expression, count: ir.Expression | None, facts: Facts, origin: Origin) -> ir.Signal | None:
    """BITS first, count as one number; None when the kind is not known or has no groups."""
    found = port(first, facts, origin)
    kinds = {"digital_in": "group_in", "digital_out": "group_out"}
    if found is None or found.kind not in kinds or found.index is None:
        return None
    size = count if count is not None else ir.IntLiteral(1)
    last: ir.Expression
    if isinstance(found.index, ir.IntLiteral) and isinstance(size, ir.IntLiteral):
        last = ir.IntLiteral(found.index.value + size.value - 1)
    else:
        span = less(size, 1)
        last = ir.Binary("+", found.index, span, origin=origin)
    return ir.Signal(kinds[found.kind], found.index, last, origin=origin)
