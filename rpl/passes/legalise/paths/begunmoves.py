"""Programs that look where the robot is while a move goes on, in languages whose programs wait for the move.

Some controllers hold the program only until the robot has begun a move (V+), or let a move say so (INFORM and RAPID).
A step behind such a move sees the robot on its way. Here the first kind becomes the second one.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.advance import UNKNOWN_BEHIND, looks
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising()
def begun_moves(program: ir.Program, context: Context) -> ir.Program:
    """Moves behind which the source's program looks where the robot is, while it drives."""
    source, target = (rules_of(one).advance.runs_ahead_of for one in (context.source, context.target))
    if source != "begun" or target == "begun":
        return program
    return edit_all(program, _begun)


def _begun(body: ir.Body) -> ir.Body:
    done = []
    for position, statement in enumerate(body):
        statement = inside(statement, _begun)
        if isinstance(statement, ir.Move) and statement.search is None and _looked_at(body[position + 1 :]):
            statement = replace(statement, concurrent=True)
        done.append(statement)
    return tuple(done)


def _looked_at(rest: ir.Body) -> bool:
    """Does the program look at the robot's place before the next step that waits or drives, as far as is seen here?"""
    for statement in rest:
        for node in walk(statement):
            if isinstance(node, UNKNOWN_BEHIND):
                return False
            if looks(node):
                return True
    return False


__all__ = ["begun_moves"]
