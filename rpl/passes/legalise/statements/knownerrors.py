"""Handlers of an error whose number is known: the question for just that number is answered.

`WaitDI ...\\MaxTime` beside its handler `IF ERRNO=ERR_WAIT_MAXTIME ...` can raise nothing else, so the branch for it
stands there without the question, and what the others would do is left out.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.rewriting.editing import expansion

_HARMLESS = (ir.Message, ir.Nothing, ir.Wait, ir.Pulse)


def settled(body: ir.Body, number: ir.Expression, code: ir.Expression) -> ir.Body:
    """The handler's body behind `number = code`, its first question answered where it asks for that code."""
    if not isinstance(code, ir.Name | ir.IntLiteral):
        return body
    for at, statement in enumerate(body):
        match statement:
            case ir.If(branches=((condition, chosen), *others), otherwise=otherwise):
                left_out = (*(inner for _, inner in others), otherwise)
                labelled = any(isinstance(node, ir.Label) for inner in left_out for node in walk(*inner))
                if labelled or not _asks(condition, number, code):
                    return body
                return (*body[:at], *(expansion(statement.origin, chosen) if chosen else ()), *body[at + 1 :])
            case ir.Assign(target=ir.Name() as target) if target != number:
                continue
        if not isinstance(statement, _HARMLESS):
            return body
    return body


def _asks(condition: ir.Expression, number: ir.Expression, code: ir.Expression) -> bool:
    """Does the condition hold when the number is the code, whatever else is the case?"""
    match condition:
        case ir.Binary(op="or", left=left, right=right):
            return _asks(left, number, code) or _asks(right, number, code)
        case ir.Binary(op="=", left=left, right=right):
            numbers = (number, ir.System("error_number"))
            return (left in numbers and right == code) or (right in numbers and left == code)
    return False


__all__ = ["settled"]
