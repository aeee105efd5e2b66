"""Texts that are made in ways that few languages have."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.refusals.rows import Asked, Found, Refusal

__all__ = ["TEXTS"]

FORMAT = code(
    "text-format-lost",
    Severity.LOSS,
    "the target's texts of numbers have blanks in front and nothing else; {form} asks for more",
    "write a plain format (%d, %5.1f), and put what is in front of the number or behind it there as a text",
    stops=True,
)
_SPECIFICATION = re.compile(r"%(?:%|(?P<flags>[-+ 0]*)(?P<width>\d*)(?:\.(?P<digits>\d+))?l?(?P<kind>[a-zA-Z]))")


def _odd(form: str) -> Iterator[str]:
    """Pieces of a C-like format that are more than a number or a text, filled with blanks on the left."""
    for found in _SPECIFICATION.finditer(form):
        kind = found["kind"] or ""
        if (found["flags"] or "").strip() or kind in ("x", "X", "o") or (kind in ("s", "c") and found["digits"]):
            yield found[0]


def _format(statement: ir.Statement, asked: Asked) -> Found:
    can, found = asked.can, list[str]()
    if can.carries_rules or "format_into" in can.procedures:
        return ()

    def look(expression: ir.Expression) -> None:
        match expression:
            case ir.Builtin(function="format", arguments=(ir.TextLiteral(value=form), *_)):
                # whose writer has formats says most of these, and names the one that it has not
                if "format" not in can.functions:
                    found.extend(_odd(form))

    each_expression(statement, look, kinds={"function format"})
    match statement:
        case ir.Do(procedure="format_into", arguments=(_, _, _, ir.TextLiteral(value=form), *_)):
            found.extend(_odd(form))
    return ({"form": found[0]},) if found else ()


TEXTS = (
    Refusal(
        "a format that fills with zeros or behind, has signs or other bases",
        FORMAT,
        get_args(ir.Statement),
        _format,
        False,
    ),
)
