"""Moves that the program does not wait for: it looks where the robot is, or does something beside it.

To a controller that runs ahead over all moves (KRL) an action at the begin of the move tells when the program is to go
on, and each step that would wait for the robot is allowed to come early. Where there are tasks, one has the steps.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import Concurrent
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.advance import SEEN, UNKNOWN_BEHIND, looks, touches
from rpl.passes.legalise.rewriting.beside import Beside, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.settings.stepsbeside import StepsBeside
from rpl.passes.legalise.stages import legalising

WAITED_FOR = code(
    "concurrent-move",
    Severity.LOSS,
    "the program goes on while this move is driven; the target's program waits for its end",
    "write what stands beside the move as an action on its path, or in a task of its own",
)


@legalising(
    unless=lambda context: context.capabilities.motion.concurrent is Concurrent.MOVES, sees=("concurrent move",)
)
def moves_ahead(program: ir.Program, context: Context) -> ir.Program:
    """Moves that the program does not wait for, as the target can say them; otherwise the loss is named."""
    kind = context.capabilities.motion.concurrent
    beside = Beside(program, context)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        if kind is Concurrent.TASKS:
            return edit_bodies(routine, StepsBeside(editor, routine, beside).body)
        return edit_bodies(routine, _Ahead(editor, routine, beside, kind is Concurrent.ADVANCE).body)

    return beside.placed(edit_routines(program, context, work))


class _Ahead:
    """Rewrites one routine. `going`: the move that is driven; `owed`: the program has not waited yet for its begin."""

    def __init__(self, editor: Editor, routine: ir.Routine, beside: Beside, ahead: bool) -> None:
        self.editor, self.routine, self.beside, self.ahead = editor, routine, beside, ahead
        self.going: ir.Move | None = None
        self.owed: ir.Name | None = None
        self.flag: ir.Name | None = None

    def body(self, body: ir.Body) -> ir.Body:
        outer, self.going = self.going, self.going if self.owed is None else None
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        self.going = outer
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move) and statement.concurrent:
            return self.begin(statement)
        if isinstance(statement, UNKNOWN_BEHIND):
            self.going = self.owed = None
            return (inside(statement, self.body),)
        if self.going is None:
            return (inside(statement, self.body),)
        statement = self.seen(statement, self.going)
        scope = self.editor.scope
        stops = isinstance(statement, ir.Wait | ir.WaitUntil) or touches(statement, scope)
        waits: ir.Body = ()
        if self.owed is not None and (stops or any(_stops(node) for node in walk(statement))):
            ahead = ir.LookAhead(origin=tidy(statement.origin))
            waits = (ahead, ir.WaitUntil(self.owed, origin=tidy(statement.origin)))
            self.owed = None
        allowed = (ir.LookAhead(origin=tidy(statement.origin)),) if stops else ()
        return (*waits, *allowed, inside(statement, self.body))

    def begin(self, move: ir.Move) -> ir.Body:
        if not self.ahead:
            self.beside.context.diagnostics.report(WAITED_FOR, move.origin)
            return (replace(move, concurrent=False),)
        if self.flag is None:
            self.flag = self.beside.kept(self.editor, self.routine, "rpl_begun", ir.BoolType())
        self.going, self.owed = move, self.flag
        later = tidy(move.origin)
        return (
            ir.Assign(self.flag, ir.BoolLiteral(False), origin=move.origin),
            ir.Trigger("start", ir.Assign(self.flag, ir.BoolLiteral(True), origin=later), origin=later),
            replace(move, origin=later),
        )

    def seen(self, statement: ir.Statement, move: ir.Move) -> ir.Statement:
        """A place seen with the tool and in the frame of the move is what the controller itself gives."""
        match statement:
            case ir.Assign(value=ir.Builtin(function=function, arguments=(tool, *frame)) as value) if function in SEEN:
                null = ir.System("null_frame")
                if tool == move.tool and (frame[0] if frame else null) == (move.frame or null):
                    return replace(statement, value=replace(value, arguments=()))
                self.beside.context.diagnostics.report(WAITED_FOR, move.origin)
        return statement


def _stops(node: object) -> bool:
    return isinstance(node, ir.Signal | ir.Wait | ir.WaitUntil) or looks(node)
