"""Stop watches whose reset stops them, for targets where a watch that is set to zero goes on counting.

Such a watch is stopped first, unless the step in front has stopped it or the step behind starts it again anyway.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies


@legalising(sees=("Clock",))
def stopped_resets(program: ir.Program, context: Context) -> ir.Program:
    """A stop watch that is set to zero counts on."""
    return edit_all(program, _body)


def _body(body: ir.Body) -> ir.Body:
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        if isinstance(statement, ir.Clock):
            beside = (body[at - 1] if at else None, body[at + 1] if at + 1 < len(body) else None)
            if statement.op == "reset" and not _stopped_or_started(statement.clock, *beside):
                done.append(replace(statement, op="stop"))
                statement = replace(statement, origin=replace(statement.origin, comments=()))
            done.append(statement)
        else:
            done.append(rewrite_bodies(statement, _body))
    return tuple(done)


def _stopped_or_started(clock: ir.Expression, before: ir.Statement | None, behind: ir.Statement | None) -> bool:
    """Does the step in front stop this watch, or the one behind start it?"""
    stopped = isinstance(before, ir.Clock) and before.op == "stop" and before.clock == clock
    started = isinstance(behind, ir.Clock) and behind.op == "start" and behind.clock == clock
    return stopped or started
