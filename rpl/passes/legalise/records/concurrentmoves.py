"""Moves whose program goes on at once (INFORM NWAIT, RAPID \\Conc), for targets that have tasks but no such moves: a
task drives them.

The program waits for the end of the move where it did, and before whatever moves the robot, jumps, or leaves the
routine: a further wait changes nothing when the move has ended already.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import Beside, moves_or_waits, tidy
from rpl.passes.legalise.rewriting.editing import Editor, expansion
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.movers import Movers
from rpl.source import Origin

WAITED = code(
    "concurrent-move-waited",
    Severity.WARNING,
    "the program waits here for the end of the move in line {line}, because it leaves the routine or jumps",
)
STOPPED = code(
    "concurrent-move-stops",
    Severity.WARNING,
    "a move that the program does not wait for stops at its end, without the corner into the next one",
)
_LEAVING = (ir.Return, ir.Goto, ir.Label, ir.ExitLoop, ir.NextPass, ir.Halt, ir.Raise)


def has_concurrent(program: ir.Program) -> bool:
    return any(isinstance(node, ir.Move) and node.concurrent for node in walk_for({"Move"}, *program.modules))


class ConcurrentMoves:
    """Rewrites the moves of one routine. `going`: the move that may still go on."""

    def __init__(self, editor: Editor, routine: ir.Routine, beside: Beside, movers: Movers) -> None:
        self.editor, self.routine, self.beside, self.movers = editor, routine, beside, movers
        self.going: ir.Move | None = None
        self.inner = False

    def body(self, body: ir.Body) -> ir.Body:
        """The body of the routine, or of a block in it: there the move may go on behind the block."""
        if self.inner:
            return self.statements(body)
        self.going, self.inner = None, True
        done = self.statements(body)
        self.inner = False
        if self.going is None:
            return done
        last = next((one.origin for one in reversed(body)), self.routine.origin)
        return (*done, *self.ended(tidy(last)))

    def statements(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Move(concurrent=True, search=None, triggers=()):
                return self.begun(statement)
            case ir.WaitForMotion() if self.going is not None:
                return self.ended(statement.origin)
        before: ir.Body = ()
        if self.going is not None:
            leaves = any(isinstance(node, _LEAVING) for node in walk(statement))
            if leaves:
                self.beside.context.diagnostics.report(WAITED, statement.origin, line=self.going.origin.line)
            self.corner(statement)
            if leaves or moves_or_waits(statement, self.beside.routines):
                before = self.ended(tidy(statement.origin))
        if self.going is None and isinstance(statement, ir.While | ir.Repeat | ir.Loop | ir.For):
            self.going = _left(statement)  # the pass before may have left one going
        return (*before, inside(statement, self.statements))

    def begun(self, move: ir.Move) -> ir.Body:
        if self.going is not None:
            return (move,)  # both would stand in the queue of the controller: left for the writer to report
        self.going = move
        return expansion(move.origin, self.movers.begin(self.editor, self.routine, replace(move, concurrent=False)))

    def corner(self, next_one: ir.Statement) -> None:
        """Would the robot go through a corner from the move to this one?"""
        if isinstance(next_one, ir.Move) and self.going is not None and self.going.blend not in (None, ir.BlendStop()):
            self.beside.context.diagnostics.report(STOPPED, self.going.origin)

    def ended(self, origin: Origin) -> ir.Body:
        """The wait for the end of the move."""
        self.going = None
        return (ir.WaitUntil(ir.Unary("not", ir.Name(self.beside.moving_name())), origin=origin),)


def _left(statement: ir.Statement, before: ir.Move | None = None) -> ir.Move | None:
    """The move that may still go on behind the statement."""
    match statement:
        case ir.Move():
            return statement if statement.concurrent else None
        case ir.WaitForMotion():
            return None
    found = before
    for body in blocks(statement):
        here = before
        for one in body:
            here = _left(one, here)
        found = here or found
    return found


__all__ = ["ConcurrentMoves", "has_concurrent"]
