"""Searches as VAL3 has them: a movement goes on by itself while the program waits for the condition or its end.

`movel(pLowest,tTip,mSearch)`, `wait(diTouch or isSettled())`, and where it has come: `pFound=here(tTip,fPart)` and
`resetMotion()`, which stops the robot and forgets the movement. No task and no instruction of its own is needed, since
movements only go into the controller's queue; `waits` has put a wait in front, so that the queue is empty then.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

WATCHED = code(
    "val3-search-watched",
    Severity.WARNING,
    "the program looks for the condition of this search once in each cycle of the controller, and brakes then",
)
# In this time a movement in an empty queue has begun, s (M); one to where the robot is never begins.
_BEGUN_S = 0.1
_MOVES = ir.System("moving")
_NONE = ir.System("null_frame")


@legalising(sees=("Search",))
def searches_beside_the_queue(program: ir.Program, context: Context) -> ir.Program:
    """The program watches while the movement in the queue is driven."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Move) and statement.search is not None:
                return _searched(statement, statement.search, editor)
            return (rewrite_bodies(statement, lambda body: map_body(body, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _searched(move: ir.Move, search: ir.Search, editor: Editor) -> ir.Body:
    """The movement, the wait beside it, and what is done where the condition has come."""
    editor.context.diagnostics.report(WATCHED, move.origin)
    wanted, before = search.condition, list[ir.Statement]()
    if search.edge == "falling":
        wanted = negation(wanted)
    elif search.edge == "either":
        first = editor.temporary("bAtFirst", ir.BoolType())
        before.append(ir.Assign(first, search.condition))
        wanted = ir.Binary("<>", search.condition, first)
    reached: list[ir.Statement] = []
    if search.found is not None:
        here = ir.Builtin("current_target", (move.tool or _NONE, move.frame or _NONE))
        reached.append(ir.Assign(search.found, here))
    if search.hit is not None:
        before.append(ir.Assign(search.hit, ir.BoolLiteral(False)))
        reached.append(ir.Assign(search.hit, ir.BoolLiteral(True)))
    came = editor.temporary("bCame", ir.BoolType())
    stopped: tuple[ir.Statement, ...] = (ir.StopMotion(), ir.ClearMotion())
    stopped = (*stopped, ir.WaitUntil(ir.Unary("not", _MOVES)))
    if search.stop == "none":
        stopped = (ir.WaitForMotion(),)
    new = search.edge != "either" and (search.stop == "none" or search.hit is None)
    late, begun = editor.temporary("bLate", ir.BoolType()), ir.Quantity(ir.RealLiteral(_BEGUN_S), "s")
    way: list[ir.Statement] = [
        replace(move, search=None, blend=None),
        ir.WaitUntil(_MOVES if new else ir.Binary("cor", wanted, _MOVES), begun, timed_out=late),
    ]
    if new:  # what is there already is not what is searched
        way.append(ir.WaitUntil(ir.Binary("cor", negation(wanted), ir.Unary("not", _MOVES))))
    way += [
        ir.WaitUntil(ir.Binary("cor", wanted, ir.Unary("not", _MOVES))),
        ir.Assign(came, ir.Binary("cand", _MOVES, wanted)),
        ir.If(((came, (*reached, *stopped)),)),
    ]
    if new or search.edge == "either":
        return expansion(move.origin, (*before, *way))
    there = ir.If(((wanted, tuple(reached)),), tuple(way))
    return expansion(move.origin, (*before, there))
