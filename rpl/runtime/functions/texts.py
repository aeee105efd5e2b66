"""Text functions and the conversions between values and text."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from decimal import ROUND_HALF_UP, Decimal, InvalidOperation

from rpl.passes.numeric import written_number
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import (
    STRUCTURED,
    Array,
    AxesValue,
    ConfigValue,
    ExternalValue,
    JointsValue,
    Member,
    PoseValue,
    Record,
    RotationValue,
    TargetValue,
    Value,
    VectorValue,
    whole,
)

_NO_MARKS: Mapping[str, int] = {}


def number_text(value: float, decimals: Value) -> str:
    """With a fixed count of decimals, halves away from zero."""
    places = max(whole(decimals), 0)
    try:
        text = str(Decimal(repr(float(value))).quantize(Decimal(1).scaleb(-places), ROUND_HALF_UP))
    except InvalidOperation:
        text = f"{value:.{places}f}"
    return text.removeprefix("-") if not text.strip("-0.") else text


def short_number(value: float) -> str:
    """A number as people write it: six significant digits, whole numbers without a point."""
    if isinstance(value, int) or (float(value).is_integer() and abs(value) < 1e15):
        return str(int(value))
    text = f"{value:.6g}"
    return "0" if text == "-0" else text


def value_text(value: Value, inside: bool = False) -> str:
    """Any value as text: TRUE, 1.5, [1,2,3]; texts inside a structure in quotes."""
    if value is None:
        raise ProgramError("no_value", "a value without content has no text")
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, Member):
        return f"#{value.upper()}"
    if isinstance(value, str):
        return f'"{value}"' if inside else value
    if isinstance(value, int | float):
        return short_number(value)
    return "[" + ",".join(value_text(part, True) for part in _parts(value)) + "]"


def shown_value(value: Value, decimals: int) -> str:
    """The text that a language makes of a value: `decimals` of a number with a fraction, where it has such a rule."""
    if decimals and isinstance(value, float):
        text = number_text(value, decimals)
        return text.rstrip("0").rstrip(".") if "." in text else text
    return value_text(value)


def _parts(value: Value) -> Iterator[Value]:
    match value:
        case Record():
            yield from value.parts.values()
        case Array():
            yield from value.items
        case TargetValue():
            yield from (value.pose.trans, value.pose.rot, value.conf, value.ext)
        case ConfigValue():
            yield from (0 if flag is None else flag for _, flag in value.flags)
        case ExternalValue() | AxesValue():
            yield from (9e9 if number is None else number for number in value.values)
        case RotationValue():
            yield from value.parts
        case VectorValue() | PoseValue() | JointsValue():
            yield from value
        case _:
            raise ProgramError("wrong_kind", "this value has no text")


def text_value(text: str, marks: Mapping[str, int] = _NO_MARKS, leading: bool = False) -> float:
    """The number written in the text (see `written_number`). Raises ProgramError when there is none."""
    number = written_number(text, marks, leading)
    if number is None:
        raise ProgramError("wrong_kind", f"{text!r} is no number")
    return number


# ---- parts of texts


def _position(text: str, position: Value, beyond: int = 0) -> int:
    place = whole(position) - 1
    if not 0 <= place < len(text) + beyond:
        raise ProgramError("out_of_range", f"position {place + 1} is outside a text of {len(text)} characters")
    return place


def _part(text: str, position: Value, count: Value) -> str:
    place, length = _position(text, position, 1), whole(count)
    if length < 0 or place + length > len(text):
        raise ProgramError("out_of_range", f"{length} characters from {place + 1} are not in a text of {len(text)}")
    return text[place : place + length]


def _find(text: str, position: Value, wanted: str) -> int:
    return text.find(wanted, max(whole(position) - 1, 0)) + 1


def _find_any(text: str, position: Value, wanted: str) -> int:
    for place in range(_position(text, position, 1), len(text)):
        if text[place] in wanted:
            return place + 1
    return len(text) + 1


def _find_none(text: str, position: Value, unwanted: str) -> int:
    for place in range(_position(text, position, 1), len(text)):
        if text[place] not in unwanted:
            return place + 1
    return len(text) + 1


def _match(text: str, position: Value, pattern: str) -> int:
    found = text.find(pattern, _position(text, position, 1))
    return found + 1 if found >= 0 else len(text) + 1


def _order(first: str, second: str, order: Value) -> bool:
    ranks = {character: rank for rank, character in enumerate(order if isinstance(order, str) else "")}

    def key(text: str) -> list[tuple[int, int]]:
        return [(0, ranks[c]) if c in ranks else (1, ord(c)) for c in text]

    return key(first) <= key(second)


def _map(text: str, old: str, new: str) -> str:
    if len(old) != len(new):
        raise ProgramError("out_of_range", "the two maps of characters differ in length")
    return text.translate(str.maketrans(old, new))


# ---- formatting

_FORMAT = re.compile(r"%(?P<flags>[-+0 #]*)(?P<width>\d+)?(?:\.(?P<digits>\d+))?(?P<kind>[diufeEgGxXoscr%])")


def formatted(pattern: str, *values: Value) -> str:
    """C's printf for %d %i %u %f %e %g %x %o %s %c; too few values are an error of the program."""
    rest = list(values)

    def replace(match: re.Match[str]) -> str:
        kind = match["kind"]
        if kind == "%":
            return "%"
        if not rest:
            raise ProgramError("wrong_kind", f"{pattern!r} asks for more values than there are")
        value = rest.pop(0)
        width = f"{match['flags']}{match['width'] or ''}"
        digits = f".{match['digits']}" if match["digits"] else ""
        if kind in "diuxXo":
            return f"%{width}{kind}" % int(value if value is not None else 0)
        if kind in "feEgG":
            return f"%{width}{digits}{kind}" % float(value)
        if kind == "c":
            return f"%{width}s" % (value if isinstance(value, str) else chr(whole(value)))
        return f"%{width}{digits}s" % value_text(value)

    return _FORMAT.sub(replace, pattern)


def message_text(text: str, *values: Value) -> str:
    """`%1`, `%2` ... replaced by the values; a place without a value stays."""

    def replace(match: re.Match[str]) -> str:
        place = int(match[1]) - 1
        return value_text(values[place]) if 0 <= place < len(values) else match[0]

    return re.sub(r"%(\d)", replace, text)


def scanned(pattern: str, text: str, offset: int) -> tuple[list[Value], int]:
    """Values read by a format from a text, and the position behind them."""
    found: list[Value] = []
    at = offset
    for match in re.finditer(r"%(\d+)?[.\d]*([difegsxcb])|\s+|[^%\s]+", pattern):
        kind, width = match[2], int(match[1]) if match[1] else None
        if kind is None:
            wanted = match[0].strip()
            while at < len(text) and text[at].isspace():
                at += 1
            if not text.startswith(wanted, at):
                break
            at += len(wanted)
            continue
        rule = r"\s*[+-]?\d+" if kind in "di" else r"\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?" if kind in "feg" else r"\s*\S+"
        rule = "." if kind == "c" else r"\s*[0-9A-Fa-f]+" if kind == "x" else rule
        piece = re.compile(rule).match(text, at, len(text) if width is None else min(len(text), at + width))
        if piece is None:
            break
        word = piece[0].strip() if kind != "c" else piece[0]
        found.append(_scanned_word(kind, word))
        at = piece.end()
    return found, at


def _scanned_word(kind: str, word: str) -> Value:
    match kind:
        case "d" | "i":
            return int(word)
        case "x":
            return int(word, 16)
        case "f" | "e" | "g":
            return float(word)
    return word


# ---- reading values


def parsed(text: str, like: Value) -> Value:
    """A text as a value of the same shape as another; raises ValueError when it is none."""
    stripped = text.strip()
    if isinstance(like, bool):
        if stripped.upper() not in ("TRUE", "FALSE"):
            raise ValueError(text)
        return stripped.upper() == "TRUE"
    if isinstance(like, int | float) or like is None:
        number = written_number(text)
        if number is None:
            raise ValueError(text)
        return number
    if isinstance(like, str):
        return stripped[1:-1] if len(stripped) > 1 and stripped[0] == stripped[-1] == '"' else text
    if like.__class__ not in STRUCTURED or not (stripped.startswith("[") and stripped.endswith("]")):
        raise ValueError(text)
    pieces = split_list(stripped[1:-1])
    shapes = list(_parts(like))
    if len(pieces) != len(shapes):
        raise ValueError(text)
    return _rebuilt(like, [parsed(piece, shape) for piece, shape in zip(pieces, shapes, strict=True)])


def split_list(text: str) -> list[str]:
    """The elements of a list, nested lists and quoted texts whole."""
    pieces, depth, quoted, start = [], 0, False, 0
    for place, character in enumerate(text):
        if character == '"':
            quoted = not quoted
        elif not quoted and character in "[]":
            depth += 1 if character == "[" else -1
        elif not quoted and depth == 0 and character == ",":
            pieces.append(text[start:place])
            start = place + 1
    return [*pieces, text[start:]]


def _rebuilt(like: Value, parts: list[Value]) -> Value:
    match like:
        case Record():
            return Record(like.type_name, dict(zip(like.parts, parts, strict=True)))
        case Array():
            return Array(parts, like.base)
        case TargetValue():
            return TargetValue(PoseValue(parts[0], parts[1]), parts[2], parts[3])
        case ConfigValue():
            return ConfigValue(like.notation, tuple((n, v) for (n, _), v in zip(like.flags, parts, strict=True)))
        case ExternalValue() | AxesValue():
            return like.__class__(tuple(parts))
        case RotationValue():
            return RotationValue(like.convention, tuple(parts))
    return like.__class__(*parts)


def _code(text: str) -> int:
    if not text:
        raise ProgramError("out_of_range", "an empty text has no first character")
    return ord(text[0])


def _number_bytes(number: float, count: Value) -> str:
    size = whole(count)
    limit = 1 << 8 * size
    value = math.floor(abs(number) + 0.5) * (-1 if number < 0 else 1)
    if not -limit // 2 <= value < limit:
        raise ProgramError("out_of_range", f"{value} does not fit into {size} bytes")
    return (value % limit).to_bytes(size, "big").decode("latin-1")


def _bytes_number(text: str, position: Value, count: Value) -> int:
    codes = [ord(one) for one in _part(text, position, count)]
    if any(code > 255 for code in codes):
        raise ProgramError("out_of_range", f"{text!r} is no row of bytes")
    return int.from_bytes(bytes(codes), "big", signed=True)


# ---- whole numbers in texts


_DIGITS = "0123456789ABCDEF"
_MOST_DIGITS = 0xFFFFFFFF  # the result of a calculation with digits


def based_number(text: str, base: Value) -> int:
    """The whole number that the digits show. Raises ProgramError when they are none of the base (2 ... 16)."""
    size = whole(base)
    if not 2 <= size <= len(_DIGITS):
        raise ProgramError("out_of_range", f"there are no digits for the base {size}")
    digits = text.upper()
    if not digits or not set(digits) <= set(_DIGITS[:size]) or len(digits) > 80:
        raise ProgramError("wrong_kind", f"{text!r} is no whole number in the base {size}")
    return int(digits, size)


def _digits_in_base(text: str, base: Value, other: Value) -> str:
    number, size = based_number(text, base), whole(other)
    based_number("0", size)
    found = ""
    while number or not found:
        number, digit = divmod(number, size)
        found = _DIGITS[digit] + found
    return found


def _calculated(work: Callable[[int, int], int]) -> Callable[[str, str], str]:
    def calculate(one: str, two: str) -> str:
        first, second = based_number(one, 10), based_number(two, 10)
        if max(first, second) > _MOST_DIGITS:
            raise ProgramError("overflow", "a number of digits is larger than 32 bits")
        try:
            result = work(first, second)
        except ZeroDivisionError:
            raise ProgramError("division_by_zero", "division by zero") from None
        if result < 0:
            raise ProgramError("negative_result", f"{one} - {two} is below zero")
        if result > _MOST_DIGITS:
            raise ProgramError("overflow", f"{result} is larger than 32 bits")
        return str(result)

    return calculate


PURE: dict[str, Callable[..., Value]] = {
    "text_length": len,
    "text_part": _part,
    "text_find": _find,
    "text_find_any": _find_any,
    "text_find_none": _find_none,
    "text_match": _match,
    "text_member": lambda text, position, wanted: text[_position(text, position)] in wanted,
    "text_order": _order,
    "text_equal": lambda a, b, ignore=False: a.lower() == b.lower() if ignore else a == b,
    "text_upper": str.upper,
    "text_lower": str.lower,
    "text_map": _map,
    "number_text": number_text,
    "power_text": lambda number, decimals: f"{number:.{whole(decimals)}E}",
    "based_number": based_number,
    "digits_in_base": _digits_in_base,
    "digits_less": lambda one, two: based_number(one, 10) < based_number(two, 10),
    "digits_equal": lambda one, two: based_number(one, 10) == based_number(two, 10),
    "digits_sum": _calculated(operator.add),
    "digits_difference": _calculated(operator.sub),
    "digits_product": _calculated(operator.mul),
    "digits_quotient": _calculated(operator.floordiv),
    "digits_remainder": _calculated(operator.mod),
    "format": formatted,
    "message_text": message_text,
    "character_code": _code,
    "from_code": lambda code: chr(whole(code)),
    "number_bytes": _number_bytes,
    "bytes_number": _bytes_number,
}
