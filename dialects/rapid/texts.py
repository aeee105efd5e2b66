"""RAPID's functions about texts and times whose options or formats decide what they mean.

Each maker gives None where an option has no neutral form; then the function stays the controller's own. Source:
reference manual, functions StrFormat, ByteToStr, GetTime.
"""

from __future__ import annotations

import re

from rpl import ir
from rpl.ir.walk import walk

from .arguments import Arguments, Signals

_ZERO = ir.IntLiteral(0)
_DIGITS = ir.TextLiteral("0123456789ABCDEF")
# Base and count of digits of a byte, by the option that asks for them.
BASES = {"hex": (16, 2), "okt": (8, 3), "bin": (2, 8)}
# Relations and calculations of digits in texts, by the names of their constants (reference manual, StrDigCmp and
# StrDigCalc).
# A relation: the function, whether its arguments change places, whether the opposite is asked for.
RELATIONS = {
    "lt": ("digits_less", False, False),
    "lteq": ("digits_less", True, True),
    "eq": ("digits_equal", False, False),
    "noteq": ("digits_equal", False, True),
    "gteq": ("digits_less", False, True),
    "gt": ("digits_less", True, False),
}
CALCULATIONS = {
    "opadd": "digits_sum",
    "opsub": "digits_difference",
    "opmult": "digits_product",
    "opdiv": "digits_quotient",
    "opmod": "digits_remainder",
}
# Where a part stands in the text of the date (YYYY-MM-DD) or the time (HH:MM:SS).
_PARTS = {
    "year": ("date_text", 1, 4),
    "month": ("date_text", 6, 2),
    "mday": ("date_text", 9, 2),
    "hour": ("time_text", 1, 2),
    "min": ("time_text", 4, 2),
    "sec": ("time_text", 7, 2),
}
_PLACE = re.compile(r"\{([1-6])\}")


def _joined(parts: list[ir.Expression]) -> ir.Expression:
    whole = parts[0]
    for part in parts[1:]:
        whole = ir.Binary("+", whole, part)
    return whole


def _only_option(arguments: Arguments) -> str | None:
    return next(iter(arguments.options)) if len(arguments.options) == 1 else None


def text_of_byte(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    r"""ByteToStr byte [\Hex] | [\Okt] | [\Bin] | [\Char]: the character of a code, or the number in a base."""
    (value,) = arguments.need(1)
    if not arguments.options:
        return ir.Builtin("number_text", (value, _ZERO))
    option = _only_option(arguments)
    if option == "char":
        return ir.Builtin("from_code", (value,))
    if option not in BASES or any(isinstance(node, ir.Call) for node in walk(value)):
        return None  # each digit asks for the value again
    base, count = BASES[option]
    return _joined([_digit(value, base, base**place) for place in reversed(range(count))])


def _digit(value: ir.Expression, base: int, weight: int) -> ir.Expression:
    """The digit of that weight as a character."""
    shifted = value if weight == 1 else ir.Binary("div", value, ir.IntLiteral(weight))
    rest = ir.Binary("mod", shifted, ir.IntLiteral(base))
    return ir.Builtin("text_part", (_DIGITS, ir.Binary("+", rest, ir.IntLiteral(1)), ir.IntLiteral(1)))


def digits_compared(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """StrDigCmp text relation text: do the whole numbers in the texts stand in this relation?"""
    one, relation, two = arguments.need(3)
    found = RELATIONS.get(relation.id.lower()) if isinstance(relation, ir.Name) else None
    if found is None:
        return None
    function, turned, opposite = found
    asked = ir.Builtin(function, (two, one) if turned else (one, two))
    return ir.Unary("not", asked) if opposite else asked


def digits_calculated(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    """StrDigCalc text operation text: the whole number that comes of it, as a text."""
    one, operation, two = arguments.need(3)
    function = CALCULATIONS.get(operation.id.lower()) if isinstance(operation, ir.Name) else None
    return None if function is None else ir.Builtin(function, (one, two))


def part_of_time(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    r"""GetTime \Year | \Month | \MDay | \Hour | \Min | \Sec: that number of the date or the time of day."""
    arguments.need(0)
    found = _PARTS.get(_only_option(arguments) or "")
    if found is None:
        return None
    function, first, count = found
    shown = ir.Builtin(function, ())
    return ir.Builtin("text_value", (ir.Builtin("text_part", (shown, ir.IntLiteral(first), ir.IntLiteral(count))),))


def formatted(arguments: Arguments, expressions: Signals) -> ir.Expression | None:
    r"""StrFormat text \Arg1 ... \Arg6: `{1}` ... `{6}` of a text that is written out become the arguments."""
    (pattern,) = arguments.need(1)
    if not isinstance(pattern, ir.TextLiteral):
        return None
    parts: list[ir.Expression] = []
    for place, piece in enumerate(_PLACE.split(pattern.value)):
        if place % 2:
            value = arguments.options.get(f"arg{piece}")
            if value is None:
                return None
            parts.append(value)
        elif piece:
            parts.append(ir.TextLiteral(piece))
    return _joined(parts or [ir.TextLiteral("")])
