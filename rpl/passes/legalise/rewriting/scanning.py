"""Numbers read by a constant format from a text (KRL SREAD), for targets that cannot: the text is taken apart in steps.

Each number is read by a routine brought along, from a position of the text on; literal signs must stand there as they
are. What does not fit ends the reading, and the variables behind it keep their values.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from rpl import ir
from rpl.diagnostics import Severity, code

NO_STATE = code(
    "scan-state-left-out",
    Severity.WARNING,
    "the numbers of the text are read, but the record that says how that went is not set",
    "look at the variables instead",
)
SCAN = "rpl_scan_number"
_PIECES = re.compile(r"%([df])|\s+|([^%\s]+)|(.)")


def scanned(
    arguments: Sequence[ir.Expression | None],
    call: Callable[..., ir.Expression],
    temporary: Callable[[str, ir.Type], ir.Name],
    whole: Callable[[ir.Expression], bool],
) -> ir.Body | None:
    """The statements for text, state, offset, format and what gets the values; None for a format of another kind."""
    if len(arguments) < 5 or any(one is None for one in arguments):
        return None
    text, _, offset, template, *targets = (one for one in arguments if one is not None)
    if not isinstance(template, ir.TextLiteral) or not isinstance(offset, ir.Name):
        return None
    pieces = list(_PIECES.finditer(template.value))
    numbers = sum(1 for piece in pieces if piece[1])
    if numbers != len(targets) or any(piece[3] for piece in pieces):
        return None
    at, behind = temporary("scan_at", ir.IntType()), temporary("scan_behind", ir.IntType())
    value, fits = temporary("scan_value", ir.RealType()), temporary("scan_fits", ir.BoolType())
    steps: list[ir.Statement] = [
        ir.Assign(at, ir.Binary("+", offset, ir.IntLiteral(1))),
        ir.Assign(fits, ir.BoolLiteral(True)),
    ]
    left = iter(targets)
    for piece in pieces:
        if piece[1]:
            steps.append(ir.If(((fits, _number(next(left), piece[1], text, (at, behind, value, fits), call, whole)),)))
        elif piece[2]:
            steps.append(ir.If(((fits, _literal(piece[2], text, at, fits)),)))
    return (*steps, ir.Assign(offset, ir.Binary("-", at, ir.IntLiteral(1))))


def _number(
    target: ir.Expression,
    kind: str,
    text: ir.Expression,
    names: tuple[ir.Name, ir.Name, ir.Name, ir.Name],
    call: Callable[..., ir.Expression],
    whole: Callable[[ir.Expression], bool],
) -> ir.Body:
    at, behind, value, fits = names
    read = call(SCAN, text, at, ir.IntLiteral(1 if kind == "f" else 0), value)
    rounded = ir.Convert("round_half_away", value) if whole(target) else value
    found = (ir.Assign(target, rounded), ir.Assign(at, behind))
    missing = (ir.Assign(fits, ir.BoolLiteral(False)),)
    none = ir.Binary("=", behind, ir.IntLiteral(0))
    return (ir.Assign(value, ir.RealLiteral(0.0)), ir.Assign(behind, read), ir.If(((none, missing),), found))


def _literal(wanted: str, text: ir.Expression, at: ir.Name, fits: ir.Name) -> ir.Body:
    length = ir.IntLiteral(len(wanted))
    part = ir.Builtin("text_part", (text, at, length))
    further = (ir.Assign(at, ir.Binary("+", at, length)),)
    enough = ir.Binary("<=", ir.Binary("+", at, ir.IntLiteral(len(wanted) - 1)), ir.Builtin("text_length", (text,)))
    same = ir.If(((ir.Binary("=", part, ir.TextLiteral(wanted)), further),), (ir.Assign(fits, ir.BoolLiteral(False)),))
    return (ir.If(((enough, (same,)),), (ir.Assign(fits, ir.BoolLiteral(False)),)),)


__all__ = ["NO_STATE", "SCAN", "scanned"]
