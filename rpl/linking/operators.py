"""Operators and conversions as closures: what each one does to Python values."""

from __future__ import annotations

import math
import operator
from array import array
from collections.abc import Callable

from rpl.passes.numeric import round_half_away
from rpl.runtime.code import Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions import neutral
from rpl.runtime.limits import MOST_CHARACTERS, MOST_WHOLE
from rpl.runtime.values import Value, equal, whole

# Where a number is rounded to four bytes: stored in such an array and taken back, as numpy.float32 does, but faster.
_SINGLE = array("f", [0.0])
_LARGEST_SINGLE = 3.4028235677973366e38  # beyond it rounding gives no number of four bytes


def single(value: Value) -> Value:
    """A real number as one of four bytes (24 bits of mantissa); everything else as it is."""
    if value.__class__ is float:
        if not -_LARGEST_SINGLE < value < _LARGEST_SINGLE:
            raise ProgramError("overflow", f"{value:g} is too large for a real number")
        _SINGLE[0] = value
        return _SINGLE[0]
    return value


def single_number(value: Value) -> Value:
    """The same in a language with one type of numbers: a whole number of more than 24 bits is rounded too."""
    if value.__class__ is int and not -(2**24) <= value <= 2**24:
        return int(single(float(value)))
    return single(value)


def rounded(read: Read, to: Callable[[Value], Value]) -> Read:
    return lambda f: to(read(f))


def bounded(read: Read, bits: int) -> Read:
    """The value of an expression of a type of whole numbers with so many bits."""
    most = 2 ** (bits - 1)

    def check(f: Values) -> Value:
        value = read(f)
        if value.__class__ is int and not -most <= value < most:
            raise ProgramError("overflow", f"{value} is too large for a whole number")
        return value

    return check


def scaled(read: Read, factor: float) -> Read:
    return read if factor == 1.0 else lambda f: read(f) * factor


def divided(read: Read, factor: float) -> Read:
    return read if factor == 1.0 else lambda f: read(f) / factor


def _truth(value: Value) -> bool:
    return bool(value != 0)


_CONVERSIONS: dict[str, Callable[[Value], Value]] = {
    "real": float,
    "round_half_away": lambda v: v if v.__class__ is int else round_half_away(v),
    "trunc": int,
    "bit": int,
    "truth": _truth,
    "code": lambda v: ord(v[0]) if v else 0,
    "char": lambda v: chr(whole(v) & 0xFF),
    "minus_bit": lambda v: -1 if v else 0,
    "floor": math.floor,
}


def converted(how: str, read: Read) -> Read:
    convert = _CONVERSIONS[how]
    return lambda f: convert(read(f))


def logic(op: str, left: Read, right: Read) -> Read:
    match op:
        case "cand":
            return lambda f: left(f) and right(f)
        case "cor":
            return lambda f: left(f) or right(f)
        case "and":
            return lambda f: bool(left(f)) & bool(right(f))
        case "or":
            return lambda f: bool(left(f)) | bool(right(f))
    return lambda f: bool(left(f)) != bool(right(f))


def equality(op: str, left: Read, right: Read, plain: bool) -> Read:
    if plain:
        if op == "=":
            return lambda f: left(f) == right(f)
        return lambda f: left(f) != right(f)
    if op == "=":
        return lambda f: equal(left(f), right(f))
    return lambda f: not equal(left(f), right(f))


def _div(a: Value, b: Value) -> Value:
    if a.__class__ is int and b.__class__ is int:
        quotient = abs(a) // abs(b)
        return quotient if (a < 0) == (b < 0) else -quotient
    return float(int(a / b))


def _quo(a: Value, b: Value) -> Value:
    return _div(a, b) if a.__class__ is int and b.__class__ is int else a / b


def _joined(first: Value, second: Value) -> str:
    if not isinstance(first, str) or not isinstance(second, str):
        raise ProgramError("wrong_kind", "only texts can be joined")
    if len(first) + len(second) > MOST_CHARACTERS:
        raise ProgramError("overflow", f"the text has more than {MOST_CHARACTERS} characters")
    return first + second


def _product(a: Value, b: Value) -> Value:
    """A product; what is too large for a whole number goes on as a real one, as in languages with one kind of them."""
    product = a * b
    if product.__class__ is int and not -MOST_WHOLE <= product <= MOST_WHOLE:
        return float(product)
    return product


def whole_product(left: Read, right: Read) -> Read:
    """The product of two expressions of a type of whole numbers."""

    def multiply(f: Values) -> Value:
        product = left(f) * right(f)
        if not -MOST_WHOLE <= product <= MOST_WHOLE:
            raise ProgramError("overflow", "the product is too large for a whole number")
        return product

    return multiply


OPERATIONS: dict[str, Callable[[Value, Value], Value]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": _product,
    "/": operator.truediv,
    "div": _div,
    "mod": lambda a, b: a - b * _div(a, b),
    "quo": _quo,
    "**": lambda a, b: float(a) ** b,
    ":": neutral.compose,
    "&": _joined,
    "@": neutral.cross,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
    "band": lambda a, b: whole(a) & whole(b),
    "bor": lambda a, b: whole(a) | whole(b),
    "bxor": lambda a, b: whole(a) ^ whole(b),
}
# The commonest operators get closures of their own: one call less.
NUMBERS: dict[str, Callable[[Read, Read], Read]] = {
    "+": lambda a, b: lambda f: a(f) + b(f),
    "-": lambda a, b: lambda f: a(f) - b(f),
    "*": lambda a, b: lambda f: _product(a(f), b(f)),
    "/": lambda a, b: lambda f: a(f) / b(f),
    "<": lambda a, b: lambda f: a(f) < b(f),
    ">": lambda a, b: lambda f: a(f) > b(f),
    "<=": lambda a, b: lambda f: a(f) <= b(f),
    ">=": lambda a, b: lambda f: a(f) >= b(f),
}
WITH_NUMBER: dict[str, Callable[[Read, float], Read]] = {
    "+": lambda a, n: lambda f: a(f) + n,
    "-": lambda a, n: lambda f: a(f) - n,
    "*": lambda a, n: lambda f: _product(a(f), n),
    "<": lambda a, n: lambda f: a(f) < n,
    ">": lambda a, n: lambda f: a(f) > n,
    "<=": lambda a, n: lambda f: a(f) <= n,
    ">=": lambda a, n: lambda f: a(f) >= n,
}
