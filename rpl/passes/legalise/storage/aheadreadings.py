"""The mark that lets the program go on while the robot moves holds for one statement; where that has become several
steps that ask the controller, each gets its own.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE


@legalising(unless=lambda context: "LookAhead" not in context.capabilities.statements)
def ahead_readings(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with such a mark."""

    def body(statements: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        allowed: ir.Statement | None = None  # the marked step whose others may follow
        for statement in statements:
            new = inside(statement, body)
            behind = bool(done) and isinstance(done[-1], ir.LookAhead)
            if behind:
                allowed = new
            elif allowed is not None and _same(allowed, new):
                if _asks(new):
                    done.append(ir.LookAhead(origin=replace(new.origin, comments=())))
            else:
                allowed = None
            done.append(new)
        return tuple(done)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, body)

    return edit_routines(program, context, work)


def _same(one: ir.Statement, other: ir.Statement) -> bool:
    """Were both one statement of the source?"""
    steps = isinstance(one, ir.Assign) and isinstance(other, ir.Assign)
    return steps and one.origin != NOWHERE and replace(one.origin, comments=()) == replace(other.origin, comments=())


def _asks(statement: ir.Statement) -> bool:
    return isinstance(statement, ir.Assign) and any(
        isinstance(node, ir.System | ir.Signal) for node in walk(statement.value)
    )


__all__ = ["ahead_readings"]
