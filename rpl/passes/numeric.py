"""Functions of plain numbers, and numbers written in texts: for the passes that fold constants and for the machine that
runs programs.

Angles in degrees. A function raises ValueError, ZeroDivisionError or OverflowError where it has no value.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping

_NO_MARKS: Mapping[str, int] = {}
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*")


def round_half_away(value: float) -> int:
    """To the nearest whole number, halves away from zero."""
    return math.floor(value + 0.5) if value >= 0 else -math.floor(-value + 0.5)


def _rounding(cut: Callable[[float], int]) -> Callable[..., float]:
    def to_decimals(value: float, decimals: float = 0) -> float:
        places = int(decimals)
        if places != decimals:
            raise ValueError(f"a whole number of decimals is needed, not {decimals!r}")
        if places <= 0:
            return cut(value)
        scale = 10.0**places
        return cut(float(f"{value * scale:.15g}")) / scale

    return to_decimals


NUMERIC: dict[str, Callable[..., float]] = {
    "abs": abs,
    "sqrt": math.sqrt,
    "sin": lambda v: math.sin(math.radians(v)),
    "cos": lambda v: math.cos(math.radians(v)),
    "tan": lambda v: math.tan(math.radians(v)),
    "asin": lambda v: math.degrees(math.asin(v)),
    "acos": lambda v: math.degrees(math.acos(v)),
    "atan": lambda v: math.degrees(math.atan(v)),
    "atan2": lambda y, x: math.degrees(math.atan2(y, x)),
    "exp": math.exp,
    "power": lambda base, exponent: float(base) ** exponent,
    "log": math.log,
    "round": _rounding(round_half_away),
    "trunc": _rounding(math.trunc),
    "floor": math.floor,
    "ceil": math.ceil,
    "min": min,
    "max": max,
}


def written_number(text: str, marks: Mapping[str, int] = _NO_MARKS, leading: bool = False) -> float | None:
    """The number written in the text; None when there is none. `marks`: what stands before the digits of a number to
    another base. `leading`: the text may go on behind a number; without one it is 0."""
    plain = text.strip().lower()
    for mark, base in marks.items():
        if plain.startswith(mark):
            digits = plain[len(mark) :]
            try:
                return int(_begun(digits, base) if leading else digits, base)
            except ValueError:
                continue
    match = _NUMBER.match(text) if leading else _NUMBER.fullmatch(text)
    if match is None:
        return 0 if leading else None
    return int(match[1]) if match[1].lstrip("+-").isdigit() else float(match[1])


def _begun(text: str, base: int) -> str:
    """What the text begins with of digits to the base."""
    known = "0123456789abcdef"[:base]
    return text[: next((at for at, sign in enumerate(text) if sign not in known), len(text))]
