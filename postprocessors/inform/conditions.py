"""Conditions: comparisons joined by ANDEXP and OREXP without brackets, `and` before `or`."""

from __future__ import annotations

from rpl import ir
from rpl.writing.statements import CannotSayError

from . import tables
from .operands import bank_of, is_digital, operand, signal, simple

Atom = tuple[str, str, str]  # left, operator, right
_OTHER = {"and": "or", "cand": "cor", "or": "and", "cor": "cand"}


def alternatives(condition: ir.Expression, wanted: bool = True) -> list[list[Atom]]:
    """The condition as alternatives of comparisons that all have to hold; `wanted` False: its opposite."""
    match condition:
        case ir.Unary(op="not", operand=inner):
            return alternatives(inner, not wanted)
        case ir.Binary(op="=" | "<>" as op, left=ir.Signal() as left, right=ir.Signal() as right) if (
            is_digital(left) and is_digital(right)  # no comparison takes two signals
        ):
            same = (op == "=") == wanted
            return [[atom(left, on), atom(right, on == same)] for on in (True, False)]
        case ir.Binary(op="and" | "cand" | "or" | "cor" as op, left=left, right=right):
            if (op if wanted else _OTHER[op]) in ("or", "cor"):
                found = [*alternatives(left, wanted), *alternatives(right, wanted)]
            else:
                found = [[*a, *b] for a in alternatives(left, wanted) for b in alternatives(right, wanted)]
            if sum(map(len, found)) > tables.MOST_TERMS:
                raise CannotSayError(f"a condition has at most {tables.MOST_TERMS} comparisons")
            return found
    return [[atom(condition, wanted)]]


def atom(condition: ir.Expression, wanted: bool = True) -> Atom:
    """One comparison."""
    match condition:
        case ir.Binary(op=op, left=left, right=right) if op in tables.COMPARISONS:
            return _compared(left, op if wanted else tables.OPPOSITE[op], right)
        case ir.Signal():
            return signal(condition), "=", "ON" if wanted else "OFF"
    return operand(condition), "=", "1" if wanted else "0"


def _compared(left: ir.Expression, op: str, right: ir.Expression) -> Atom:
    if isinstance(right, ir.Signal) and not isinstance(left, ir.Signal):
        left, op, right = right, tables.TURNED[op], left
    if is_digital(left) and isinstance(left, ir.Signal):
        if isinstance(right, ir.BoolLiteral) and op in ("=", "<>"):
            return signal(left), "=", "ON" if right.value == (op == "=") else "OFF"
        shown = simple(right)
        if shown is None or bank_of(shown) != "B":
            raise CannotSayError("a signal is compared with ON, OFF or a byte")
        return signal(left), op, shown
    if isinstance(left, ir.Signal):
        return signal(left), op, operand(right)
    return operand(left), op, operand(right)


def text(found: list[list[Atom]]) -> str:
    return " OREXP ".join(" ANDEXP ".join("".join(one) for one in group) for group in found)


def single(condition: ir.Expression) -> str | None:
    """The text of a condition that is one comparison."""
    found = alternatives(condition)
    return text(found) if len(found) == 1 and len(found[0]) == 1 else None
