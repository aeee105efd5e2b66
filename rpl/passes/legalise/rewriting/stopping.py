"""A statement that a pass cannot rewrite and no target is given: the report, and what every writer stops at.

The pass's construct is a row of the table of refusals without a question of its own.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code
from rpl.passes.legalise.context import Context
from rpl.source import Comment

__all__ = ["is_left_out", "left_out", "stopped"]

_LEFT_OUT = " left out, "


def stopped(statement: ir.Statement, code: Code, context: Context, **arguments: object) -> ir.Opaque:
    """The statement as a guarded stop. code: one that says by itself that the program stops there (`Code.stops`)."""
    context.diagnostics.report(code, statement.origin, **arguments)
    return ir.Opaque(statement.origin.text or type(statement).__name__, origin=statement.origin)


def left_out(statement: ir.Statement, why: str) -> ir.Nothing:
    """A statement that says nothing any more where the program has stopped before: a remark, where the source says
    it."""
    said = statement.origin.text.strip().splitlines()
    if not said:
        return ir.Nothing(origin=statement.origin)
    remark = Comment(f"{_LEFT_OUT}{why}: {said[0]}")
    return ir.Nothing(origin=replace(statement.origin, comments=(*statement.origin.comments, remark)))


def is_left_out(statement: ir.Statement) -> bool:
    """Is it the remark of `left_out` and nothing else?"""
    if not isinstance(statement, ir.Nothing) or len(statement.origin.comments) != 1:
        return False
    return statement.origin.comments[0].text.startswith(_LEFT_OUT)
