"""Signals: INFORM's names for physical inputs and outputs, and the neutral signals they are.

Groups have eight (IG, OG) or four (IGH, OGH) consecutive signals: IG#(2) is IN#(9)..IN#(16), IGH#(2) is IN#(5)..IN#(8).
"""

from __future__ import annotations

import re

from rpl import ir
from rpl.source import NOWHERE, Origin
from rpl.words import spelled

from . import tables

GROUPS: dict[str, tuple[str, int]] = {
    "IG": ("group_in", 8),
    "OG": ("group_out", 8),
    "IGH": ("group_in", 4),
    "OGH": ("group_out", 4),
}
_GROUP = re.compile(rf"({'|'.join(GROUPS)})#\((\d+)\)")
_SINGLE = ("digital_in", "digital_out", "flag")
# Signals that have a place of their own in the controller: specific inputs and outputs, auxiliary relays.
NAMED: dict[str, str] = {
    "RIN": "digital_in",
    "SIN": "digital_in",
    "SOUT": "digital_out",
    "EXIN": "digital_in",
    "EXOUT": "digital_out",
    "IU": "digital_in",
    "OU": "digital_out",
    "AX": "flag",
    # outputs of ANTOUT, groups of the user: which signals they are stands in the controller's parameters
    "AT": "digital_out",
    "OGU": "group_out",
    "IGU": "group_in",
}


def numbered(word: str, number: ir.Expression, origin: Origin) -> ir.Signal | None:
    """`IN#(3)` and the like; None when the word names no signal."""
    if word in tables.SIGNALS:
        return ir.Signal(tables.SIGNALS[word], number, origin=origin)
    if word in GROUPS:
        kind, bits = GROUPS[word]
        return ir.Signal(kind, _line(number, bits, 1 - bits), _line(number, bits, 0), origin=origin)
    if word == "RIN" and not isinstance(number, ir.IntLiteral):
        return ir.Signal("digital_in", _line(number, 1, tables.DIRECT_INPUTS), origin=origin)
    if word in NAMED and isinstance(number, ir.IntLiteral):
        return ir.Signal(NAMED[word], name=f"{word}{number.value}", origin=origin)
    return None


def _line(number: ir.Expression, bits: int, add: int) -> ir.Expression:
    """number * bits + add."""
    if isinstance(number, ir.IntLiteral):
        return ir.IntLiteral(number.value * bits + add, origin=number.origin)
    product = number if bits == 1 else ir.Binary("*", number, ir.IntLiteral(bits), origin=number.origin)
    if not add:
        return product
    return ir.Binary("+" if add > 0 else "-", product, ir.IntLiteral(abs(add)), origin=number.origin)


def is_digital(signal: ir.Expression) -> bool:
    return isinstance(signal, ir.Signal) and signal.last is None and signal.kind in _SINGLE


def signal_of(text: str) -> ir.Signal | None:
    """The signals that a spelling of a group means: `OG#(2)` outputs 9 to 16, `IGH#(2)` inputs 5 to 8."""
    found = _GROUP.fullmatch(text.upper())
    return numbered(found[1], ir.IntLiteral(int(found[2])), NOWHERE) if found is not None else None


def signal_name(kind: str, number: int) -> str:
    """How INFORM spells a physical signal."""
    if kind == "digital_in" and number > tables.DIRECT_INPUTS:
        return f"RIN#({number - tables.DIRECT_INPUTS})"
    words = spelled(tables.SIGNALS) | {"group_in": "IG", "group_out": "OG", "flag": "AX"}
    return f"{words[kind]}#({number})"
