"""Programs that look where the robot is while a move goes on, in languages whose programs wait for the move.

Some controllers hold the program only until the robot has begun a move (V+), or let a move say so (INFORM and RAPID).
A step behind such a move sees the robot on its way. `begun_moves` makes the first kind the second one; `moves_ahead`
says that to controllers that run ahead over all moves (KRL): an action at the begin of the move tells the program when
to go on, and each step that would wait for the robot is allowed to come early.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import Concurrent
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.paths.lookahead import touches
from rpl.passes.legalise.paths.stepsbeside import StepsBeside
from rpl.passes.legalise.rewriting.beside import Beside, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_all, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

WAITED_FOR = code(
    "concurrent-move",
    Severity.LOSS,
    "the program goes on while this move is driven; the target's program waits for its end",
    "write what stands beside the move as an action on its path, or in a task of its own",
)
_SEEN = frozenset(("current_target", "current_joints", "current_position"))
_OF_NOW = frozenset(("actual_pose", "actual_joints", "actual_joint"))
_DRIVING = (ir.Move, ir.MoveExternal, ir.Spline)
_UNKNOWN = (*_DRIVING, ir.CallRoutine, ir.WaitForMotion, ir.Label, ir.Goto, ir.Return, ir.Halt, ir.Raise)


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
            if isinstance(node, _UNKNOWN):
                return False
            if looks(node):
                return True
    return False


def looks(node: object) -> bool:
    match node:
        case ir.System(name=name):
            return name in _OF_NOW
        case ir.Builtin(function=function):
            return function in _SEEN
    return False


@legalising(unless=lambda context: context.capabilities.motion.concurrent is Concurrent.MOVES, sees=("Move",))
def moves_ahead(program: ir.Program, context: Context) -> ir.Program:
    """Moves that the program does not wait for, as the target can say them; otherwise the loss is named."""
    kind = context.capabilities.motion.concurrent
    if not any(isinstance(node, ir.Move) and node.concurrent for node in walk(*program.modules)):
        return program
    beside = Beside(program, context)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        if kind is Concurrent.TASKS:
            return edit_bodies(routine, StepsBeside(editor, routine, beside).body)
        return edit_bodies(routine, _Ahead(editor, routine, beside, kind is Concurrent.ADVANCE).body)

    return beside.placed(edit_routines(program, context, work))


@legalising(
    unless=lambda context: (
        rules_of(context.source).advance.runs_ahead_of != "begun"
        or context.capabilities.motion.concurrent is not Concurrent.ADVANCE
    )
)
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
        if isinstance(statement, _UNKNOWN):
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
            case ir.Assign(value=ir.Builtin(function=function, arguments=(tool, *frame)) as value) if function in _SEEN:
                null = ir.System("null_frame")
                if tool == move.tool and (frame[0] if frame else null) == (move.frame or null):
                    return replace(statement, value=replace(value, arguments=()))
                self.beside.context.diagnostics.report(WAITED_FOR, move.origin)
        return statement


def _stops(node: object) -> bool:
    return isinstance(node, ir.Signal | ir.Wait | ir.WaitUntil) or looks(node)
