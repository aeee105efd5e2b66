"""Waits beside a move that the program does not wait for: they have become loops, and KRL's program runs ahead of moves
only where each step allows it.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.advance import touches
from rpl.passes.legalise.rewriting.beside import tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: rules_of(context.source).advance.runs_ahead_of != "begun", sees=("LookAhead",))
def polled_ahead(program: ir.Program, context: Context) -> ir.Program:
    """Waits beside a move that have become loops since: each step in them that would wait for the robot comes early."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def early(body: ir.Body) -> ir.Body:
            done: list[ir.Statement] = []
            for statement in body:
                if isinstance(statement, ir.Wait | ir.WaitUntil) or touches(statement, editor.scope):
                    done.append(ir.LookAhead(origin=tidy(statement.origin)))
                done.append(inside(statement, early))
            return tuple(done)

        def loops(body: ir.Body) -> ir.Body:
            done: list[ir.Statement] = []
            for statement in body:
                if isinstance(statement, ir.Loop) and done and isinstance(done[-1], ir.LookAhead):
                    allowed = any(isinstance(node, ir.LookAhead) for node in walk(*statement.body))
                    done.append(statement if allowed else inside(statement, early))
                else:
                    done.append(inside(statement, loops))
            same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
            return body if same else tuple(done)

        return edit_bodies(routine, loops)

    return edit_routines(program, context, work)
