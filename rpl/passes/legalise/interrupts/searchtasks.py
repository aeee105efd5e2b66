"""Search moves for targets that have tasks but no searches: a task drives the move while the program looks.

When the condition comes true the place is kept, the task ended and the robot braked. One cycle of the target's
controller is how exactly the place is kept.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.conditions import negation
from rpl.passes.legalise.rewriting.beside import Beside, tidy
from rpl.passes.legalise.rewriting.editing import Editor, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.movers import Movers

WATCHED = code(
    "search-watched",
    Severity.WARNING,
    "a search looks at its condition once in each cycle of the controller, and keeps the place of that moment",
)


class SearchTasks:
    """Rewrites the searches of one routine."""

    def __init__(self, editor: Editor, routine: ir.Routine, beside: Beside, movers: Movers) -> None:
        self.editor, self.routine, self.beside, self.movers = editor, routine, beside, movers

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move) and statement.search is not None:
            return self.search(statement, statement.search)
        return (inside(statement, self.body),)

    def search(self, move: ir.Move, search: ir.Search) -> ir.Body:
        """The move in a task, and what looks."""
        self.beside.context.diagnostics.report(WATCHED, move.origin)
        later = tidy(move.origin)
        moving = ir.Name(self.beside.moving_name())
        wanted = search.condition
        before: list[ir.Statement] = []
        if search.edge == "falling":
            wanted = negation(wanted)
        elif search.edge == "either":
            first = self.editor.temporary("at_first", ir.BoolType())
            before.append(ir.Assign(first, search.condition, origin=later))
            wanted = ir.Binary("<>", search.condition, first)
        reached: list[ir.Statement] = []
        if search.found is not None:
            reached.append(ir.Assign(search.found, _here(move), origin=later))
        if search.hit is not None:
            reached.append(ir.Assign(search.hit, ir.BoolLiteral(True), origin=later))
        stops: list[ir.Statement] = [
            ir.TaskControl("stop", self.movers.task(), origin=later),
            ir.StopMotion(search.stop == "stop", origin=later),
            ir.Assign(moving, ir.BoolLiteral(False), origin=later),
        ]
        if search.stop == "none":
            stops = [ir.WaitUntil(ir.Unary("not", moving), origin=later)]
        passing = (
            search.stop == "none" and search.edge != "either"
        )  # then what is there already is not what is searched
        way: list[ir.Statement] = [
            *self.movers.begin(self.editor, self.routine, move),
            *((ir.WaitUntil(ir.Binary("cor", negation(wanted), ir.Unary("not", moving))),) if passing else ()),
            ir.WaitUntil(ir.Binary("cor", wanted, ir.Unary("not", moving))),
            ir.If(((moving, (*reached, *stops)),), origin=later),
        ]
        if search.hit is not None:
            before.append(ir.Assign(search.hit, ir.BoolLiteral(False), origin=later))
        if search.edge == "either" or search.hit is None or passing:
            return expansion(move.origin, (*before, *way))
        return expansion(move.origin, (*before, ir.If(((wanted, tuple(reached)),), tuple(way), origin=later)))


def _here(move: ir.Move) -> ir.Expression:
    """Where the tool is, in the move's frame."""
    here = ir.System("actual_pose")
    return here if move.frame is None else ir.Binary(":", ir.Builtin("inverse", (move.frame,)), here)


__all__ = ["SearchTasks"]
