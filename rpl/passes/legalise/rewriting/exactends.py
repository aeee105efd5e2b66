"""A move that the program waits for at once ends exactly: there is no corner to go round.

Languages say it apart (a corner, then a wait for the robot) or at the move. What may stand between the two, and which
moves keep their corner all the same, is each target's own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.rewrite import rewrite_bodies, same

__all__ = ["ending_exactly", "says_nothing"]


def says_nothing(statement: ir.Statement) -> bool:
    """Is it a remark or a mark?"""
    return isinstance(statement, ir.Nothing)


def _any_move(move: ir.Move) -> bool:
    return True


def ending_exactly(
    body: ir.Body,
    between: Callable[[ir.Statement], bool] = says_nothing,
    may_stop: Callable[[ir.Move], bool] = _any_move,
) -> ir.Body:
    """The body with exact ends at the moves that are waited for. The wait stays; behind an exact end it has nothing to
    wait for. between: may this statement stand between a move and the wait for it? may_stop: may this move have no
    corner?"""

    def inner(part: ir.Body) -> ir.Body:
        return ending_exactly(part, between, may_stop)

    done = [rewrite_bodies(one, inner) if blocks(one) else one for one in body]
    awaited = False  # going back from the end: does the program wait for the robot here?
    for at in range(len(body) - 1, -1, -1):
        statement = done[at]
        if awaited and isinstance(statement, ir.Move) and may_stop(statement):
            done[at] = replace(statement, blend=ir.BlendStop())
        awaited = isinstance(statement, ir.WaitForMotion) or (awaited and between(body[at]))
    return body if same(done, body) else tuple(done)
