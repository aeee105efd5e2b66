"""What TYPE, WRITE and $ENCODE print: items with format controls, joined to one text.

A format control governs all numbers behind it, until the next one. Without one a number is written as short as it can
be, with a blank in the place of the sign: programs build `/LOCAL_PORT` + $ENCODE(11000) and mean `/LOCAL_PORT 11000`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rpl import ir
from rpl.reading.shapes import StatementError
from rpl.source import Origin

# M: eight significant digits, what a number of single precision holds at most.
DEFAULT = "% .8g"
_CONTROL = re.compile(r"/([A-Za-z])(\d*)(?:\.(\d+))?")
_TEXT_FUNCTIONS = frozenset(
    (
        "from_code",
        "text_part",
        "format",
        "error_text",
        "time_text",
        "date_text",
        "text_upper",
        "value_text",
        "number_bytes",
    )
)


@dataclass(frozen=True, slots=True)
class Item:
    """One item: format controls in front of it, and the value if there is one."""

    controls: tuple[str, ...]
    value: ir.Expression | None


def text_of(items: Sequence[Item], origin: Origin, line_end: str = "\n") -> ir.Expression:
    """All items as one text. `line_end`: what /C gives (M: $ENCODE gives both signs)."""
    parts: list[ir.Expression] = []
    form = DEFAULT
    for item in items:
        for control in item.controls:
            form, shown = _controlled(control, form)
            _append(parts, shown.replace("\n", line_end))
        value = item.value
        if value is None:
            continue
        if isinstance(value, ir.TextLiteral):
            _append(parts, value.value)
        elif is_text(value):
            parts.append(value)
        else:
            parts.append(ir.Builtin("format", (ir.TextLiteral(form), value), origin=origin))
    if not parts:
        return ir.TextLiteral("", origin=origin)
    whole = parts[0]
    for part in parts[1:]:
        whole = ir.Binary("&", whole, part, origin=origin)
    return whole


def _append(parts: list[ir.Expression], text: str) -> None:
    if not text:
        return
    if parts and isinstance(parts[-1], ir.TextLiteral):
        parts[-1] = ir.TextLiteral(parts[-1].value + text)
    else:
        parts.append(ir.TextLiteral(text))


def _controlled(control: str, form: str) -> tuple[str, str]:
    """The number format from now on, and what the control itself prints."""
    found = _CONTROL.fullmatch(control)
    if found is None:
        raise StatementError(f"{control} is no format control", 0)
    letter, width, digits = found[1].upper(), found[2].lstrip("0"), found[3]
    count = int(found[2] or 1)
    match letter:
        case "D":
            return DEFAULT, ""
        case "F" | "E" | "G":
            return f"%{width}.{digits or 0}{'f' if letter == 'F' else letter.lower()}", ""
        case "I":
            return f"%{width}d", ""
        case "H" | "O":
            return f"%{width}{'X' if letter == 'H' else 'o'}", ""
        case "X":
            return form, " " * count
        case "C":
            return form, "\n" * count
        case "S" | "N" | "B" | "U" | "L" | "R" | "K" | "P":
            return form, ""  # cursor, bell, no new line, no waiting: nothing that a message shows
    raise StatementError(f"{control} is no format control", 0)


def is_text(expression: ir.Expression) -> bool:
    """Is the value certainly a text?"""
    match expression:
        case ir.TextLiteral():
            return True
        case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
            return name.startswith("$")
        case ir.Binary(op="+" | "&", left=left, right=right):
            return is_text(left) or is_text(right)
        case ir.Builtin(function=function):
            return function in _TEXT_FUNCTIONS
        case ir.VendorValue(type=type):
            return isinstance(type, ir.StringType)
    return False


__all__ = ["DEFAULT", "Item", "is_text", "text_of"]
