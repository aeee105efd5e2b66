"""Actions on the way that stand in front of their move are the move's own, for the writer to say with it.

INFORM has no statement for an action on the way, so one that waits for the next move is said where that move is.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.rewrite import rewrite_bodies, same
from rpl.writing.target import WriteContext


def actions_of_moves(program: ir.Program, context: WriteContext) -> ir.Program:
    """An action goes to the next move of its body; one without such a move stays, and is refused."""
    return edit_all(program, _body)


def _body(body: ir.Body) -> ir.Body:
    done: list[ir.Statement] = []
    waiting: list[ir.Trigger] = []
    for one in body:
        if isinstance(one, ir.Trigger):
            waiting.append(one)
        elif isinstance(one, ir.Move) and waiting:
            given = {id(trigger) for trigger in waiting}
            done = [other for other in done if id(other) not in given]
            one, waiting = _with(one, waiting), []
        elif blocks(one):
            one = rewrite_bodies(one, _body)
        done.append(one)
    return body if same(done, body) else tuple(done)


def _with(move: ir.Move, triggers: list[ir.Trigger]) -> ir.Move:
    """The move with these actions behind its own, and their remarks in front of its own."""
    remarks = tuple(comment for trigger in triggers for comment in trigger.origin.comments)
    origin = replace(move.origin, comments=(*remarks, *move.origin.comments)) if remarks else move.origin
    return replace(move, triggers=(*move.triggers, *triggers), origin=origin)


__all__ = ["actions_of_moves"]
