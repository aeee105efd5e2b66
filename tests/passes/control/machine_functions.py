"""What the test machine's operators, conversions and functions give."""

from __future__ import annotations

import math
from typing import Any


def away(x: float) -> int:
    return math.floor(abs(x) + 0.5) * (1 if x >= 0 else -1)


def convert(how: str, value: Any) -> Any:
    table = {
        "real": float,
        "round_half_away": away,
        "trunc": int,
        "bit": int,
        "truth": bool,
        "code": lambda c: ord(c[0]),
        "char": chr,
    }
    return table[how](value)


def _round(x: float, decimals: int = 0) -> float:
    return float(away(x * 10**decimals) / 10**decimals)


def _message(template: str, *values: Any) -> str:
    for at, value in enumerate(values):
        template = template.replace(f"%{at + 1}", str(value))
    return template


def _trunc(x: float, decimals: int = 0) -> float:
    return int(x * 10**decimals) / 10**decimals


def _product(a: Any, b: Any) -> Any:
    """Whole numbers stay short: generated loops multiply them without end."""
    product = a * b
    return product % 2**31 if isinstance(product, int) and abs(product) > 2**60 else product


FUNCTIONS: dict[str, Any] = {
    "abs": abs,
    "sqrt": math.sqrt,
    "sin": lambda x: math.sin(math.radians(x)),
    "cos": lambda x: math.cos(math.radians(x)),
    "tan": lambda x: math.tan(math.radians(x)),
    "asin": lambda x: math.degrees(math.asin(x)),
    "acos": lambda x: math.degrees(math.acos(x)),
    "atan": lambda x: math.degrees(math.atan(x)),
    "atan2": lambda y, x: math.degrees(math.atan2(y, x)),
    "exp": math.exp,
    "log": math.log,
    "power": lambda a, b: float(a) ** b,
    "round": _round,
    "trunc": _trunc,
    "floor": math.floor,
    "ceil": math.ceil,
    "min": min,
    "max": max,
    "bit_shift_left": lambda a, n: a << n,
    "bit_shift_right": lambda a, n: a >> n,
    "length": len,
    "dimension": lambda a, n: len(a) if n == 1 else len(a[0]),
    "text_length": len,
    "text_part": lambda s, at, n: s[at - 1 : at - 1 + n],
    "text_find": lambda s, at, w: s.find(w, at - 1) + 1,
    "text_find_any": lambda s, at, w: next((i + 1 for i in range(at - 1, len(s)) if s[i] in w), len(s) + 1),
    "text_match": lambda s, at, w: (s.find(w, at - 1) + 1) or len(s) + 1,
    "text_member": lambda s, at, w: s[at - 1] in w,
    "text_equal": lambda a, b, ignore=False: a.lower() == b.lower() if ignore else a == b,
    "text_upper": str.upper,
    "text_lower": str.lower,
    "text_map": lambda s, a, b: s.translate(str.maketrans(a, b)),
    "message_text": _message,
    "value_text": str,
    "number_text": lambda x, n: f"{x:.{n}f}",
    "character_code": lambda c: ord(c[0]),
    "from_code": chr,
}
BINARY: dict[str, Any] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": _product,
    "/": lambda a, b: a / b,
    "div": lambda a, b: int(a / b),
    "mod": lambda a, b: a - b * int(a / b),
    "**": lambda a, b: float(a) ** b,
    "&": lambda a, b: a + b,
    "=": lambda a, b: a == b,
    "<>": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "cand": lambda a, b: b,
    "cor": lambda a, b: b,
    "xor": lambda a, b: a != b,
    "band": lambda a, b: a & b,
    "bor": lambda a, b: a | b,
    "bxor": lambda a, b: a ^ b,
}
