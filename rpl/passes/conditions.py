"""The opposite of a condition."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir

_DUAL = {"and": "or", "or": "and", "cand": "cor", "cor": "cand"}


def negation(condition: ir.Expression) -> ir.Expression:
    """The opposite condition, in the shorter way of writing it."""
    opposite = {"=": "<>", "<>": "=", "<": ">=", ">=": "<", ">": "<=", "<=": ">"}
    match condition:
        case ir.Unary(op="not", operand=operand):
            return operand
        case ir.BoolLiteral(value=value):
            return replace(condition, value=not value)
        case ir.Binary(op=op) if op in opposite:
            return replace(condition, op=opposite[op])
    return ir.Unary("not", condition, origin=condition.origin)


def opposite(condition: ir.Expression) -> ir.Expression:
    """The opposite condition as a person writes it: comparisons turned round, `not (a and b)` as `not a or not b`."""
    match condition:
        case ir.Binary(op=op, left=left, right=right) if op in _DUAL:
            return replace(condition, op=_DUAL[op], left=opposite(left), right=opposite(right))
    return negation(condition)
