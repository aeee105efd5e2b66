"""How many bits a named group of signals gets, where its own controller's configuration would say it: eight where the
program only gives it numbers of eight bits or asks whether it equals such; otherwise as many as a group of its language
may have, as far as the target has them; and as many as the target has where the program shows a larger number for it.
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
_EQUALITIES = frozenset(("=", "<>"))
_Key = tuple[str, str]


def group_widths(
    program: ir.Program, known: Callable[[ir.Signal], str | None], widest: int, least: int = WIDTH, own: int = WIDTH
) -> dict[_Key, tuple[int, bool]]:
    """By kind and folded name of the groups that need other than the least count of bits (`own`: what a group of their
    language may have): the bits, and whether these are enough."""
    found: dict[_Key, list[int]] = {}
    plain: dict[_Key, int] = {}  # how often a constant is given, or equality with one asked
    seen: dict[_Key, int] = {}

    def note(place: ir.Expression, value: ir.Expression, settles: bool) -> None:
        number, key = _whole(value), _key(place, known)
        if number is not None and key is not None:
            found.setdefault(key, []).append(number)
            plain[key] = plain.get(key, 0) + settles

    for node in walk(*(routine for module in program.modules for routine in module.routines)):
        match node:
            case ir.Signal():
                if (key := _key(node, known)) is not None:
                    seen[key] = seen.get(key, 0) + 1
            case ir.Assign(target=target, value=value):
                note(target, value, True)
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARISONS:
                note(left, right, op in _EQUALITIES)
                note(right, left, op in _EQUALITIES)
    widths: dict[_Key, tuple[int, bool]] = {}
    for key, times in seen.items():
        numbers = found.get(key, [])
        most = max(numbers, default=0)
        wide = most >= 1 << least
        wanted = least if plain.get(key, 0) == times and not wide else own
        bits = max(least, widest if most >= 1 << max(own, least) else min(widest, wanted))
        fits = bits >= wanted and all(0 <= number < 1 << bits for number in numbers)
        if wide or not fits or bits > least:
            widths[key] = (bits, fits)
    return widths


def _key(place: ir.Expression, known: Callable[[ir.Signal], str | None]) -> _Key | None:
    """Kind and folded name of a named group; None for everything else."""
    if not isinstance(place, ir.Signal) or not place.kind.startswith("group"):
        return None
    name = known(place)
    return None if name is None else (place.kind, name.lower())


def _whole(value: ir.Expression) -> int | None:
    match value:
        case ir.IntLiteral(value=number):
            return number
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            return -number
    return None


__all__ = ["TOO_NARROW", "WIDTH", "group_widths"]
