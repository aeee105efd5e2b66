"""A move with a corner behind which the program waits for the robot at once is one with `fine`: there is no corner, and
RAPID's program waits at `fine` by itself. It comes from languages whose moves are joined unless the next statement says
otherwise (V+ BREAK). A wait of no time behind a move with `fine` is what other languages write to wait for the robot
(KRL WAIT SEC 0): WaitRob says so.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.exactends import ending_exactly
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

__all__ = ["fine_stops"]

_IN_PLACE = (ir.Assign, ir.Wait, ir.WaitUntil, ir.Nothing, ir.Message, ir.Pulse)  # the robot stays where it stands


@legalising(sees=("WaitForMotion", "Wait"))
def fine_stops(program: ir.Program, context: Context) -> ir.Program:
    """Only right behind the move; what is attached to the corner needs it."""
    return edit_all(program, lambda body: _body(ending_exactly(body, between=_nothing, may_stop=_can_stop)))


def _nothing(statement: ir.Statement) -> bool:
    return False


def _body(body: ir.Body) -> ir.Body:
    done: list[ir.Statement] = []
    stands = False  # at the last move, with `fine`
    for statement in body:
        last = done[-1] if done else None
        if isinstance(statement, ir.Move):
            stands = isinstance(statement.blend, ir.BlendStop) and not statement.concurrent
        elif not isinstance(statement, _IN_PLACE):
            stands = False
        if stands and _is_no_time(statement):
            statement = ir.WaitForMotion(origin=statement.origin)
            done.append(statement)
            continue
        if isinstance(statement, ir.WaitForMotion) and isinstance(last, ir.Move) and _can_stop(last):
            if statement.origin.comments:
                done.append(ir.Nothing(origin=statement.origin))
        else:
            done.append(rewrite_bodies(statement, _body))
    return tuple(done)


def _is_no_time(statement: ir.Statement) -> bool:
    match statement:
        case ir.Wait(time=ir.IntLiteral() | ir.RealLiteral() as time, in_position=False):
            return time.value == 0
    return False


def _can_stop(move: ir.Move) -> bool:
    return not move.concurrent and not move.triggers and move.search is None
