"""How many bits a named group of signals gets, where its own controller's configuration would say it: eight, or as many
as the target takes where the program gives it, or compares it with, a number beyond these. A group that has more of
them on every controller of its language (URScript's registers) gets as many as the target has.
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk

WIDTH = 8
TOO_NARROW = code(
    "group-too-narrow",
    Severity.WARNING,
    "the group of signals {name} gets {bits} bits here, which hold 0 to {most}; the program has other numbers "
    "for it, or may work them out",
)
_COMPARISONS = frozenset(("=", "<>", "<", ">", "<=", ">="))
_Key = tuple[str, str]


def group_widths(
    program: ir.Program, known: Callable[[ir.Signal], str | None], widest: int, least: int = WIDTH, own: int = WIDTH
) -> dict[_Key, tuple[int, bool]]:
    """By kind and folded name of the groups that are given other numbers than the least count of bits holds, or that
    have `own` bits in their language: the bits, and whether these are enough."""
    found: dict[_Key, list[int]] = {}

    def note(place: ir.Expression, value: ir.Expression) -> None:
        number = _whole(value)
        name = known(place) if isinstance(place, ir.Signal) and place.kind.startswith("group") else None
        if number is not None and name is not None and isinstance(place, ir.Signal):
            found.setdefault((place.kind, name.lower()), []).append(number)

    for node in walk(*(routine for module in program.modules for routine in module.routines)):
        match node:
            case ir.Signal(kind=kind) if own > WIDTH and kind.startswith("group") and (name := known(node)) is not None:
                found.setdefault((kind, name.lower()), [])
            case ir.Assign(target=target, value=value):
                note(target, value)
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARISONS:
                note(left, right)
                note(right, left)
    widths: dict[_Key, tuple[int, bool]] = {}
    for key, numbers in found.items():
        wide = any(number >= 1 << least for number in numbers)
        bits = max(least, widest) if wide else max(least, min(widest, own))
        fits = bits >= own and all(0 <= number < 1 << bits for number in numbers)
        if wide or not fits or bits > least:
            widths[key] = (bits, fits)
    return widths


def _whole(value: ir.Expression) -> int | None:
    match value:
        case ir.IntLiteral(value=number):
            return number
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            return -number
    return None


__all__ = ["TOO_NARROW", "WIDTH", "group_widths"]
