"""Interrupts that brake a move which then goes on, for targets whose brake drops the move (V+ BRAKE).

The interrupt's routine notes that it has braked. While such an interrupt may come, each move is repeated until none
has: it is commanded again to the same target, from where the robot stands. A corner of such a move is not rounded.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import InterruptRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.jumps import inside
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.interrupts.endedmoves import CORNER
from rpl.passes.legalise.interrupts.heldmotion import ANOTHER, not_again, path_differs, with_kept_target
from rpl.passes.legalise.interrupts.reach import armed_statements
from rpl.passes.legalise.interrupts.watching import number_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body, negation
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.tasks.beside import tidy


@legalising(
    unless=lambda context: (
        InterruptRule.STOPPING not in context.capabilities.interrupts.rules
        or "StartMotion" in context.capabilities.statements
        or "ClearMotion" not in context.capabilities.statements
    )
)
def repeated_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose interrupts stop the robot and drop the move, with no word that lets it go on."""
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    keys: set[int] = set()
    handlers: set[str] = set()
    for node in walk(*program.modules):
        if isinstance(node, ir.DeclareInterrupt) and isinstance(node.action, ir.CallRoutine):
            key = number_of(node.identity if node.identity is not None else node.priority)
            below = called_below(program, {node.action.name.lower()})
            if key is not None and any(_holds(routines[name]) for name in below if name in routines):
                keys.add(key)
                handlers |= below
    if not keys:
        return program
    worker = _Repeated(context, frozenset(keys), handlers)
    worker.marked = armed_statements(program, worker)
    done = edit_routines(program, context, worker.routine)
    flag = ir.Variable(worker.flag(), ir.BoolType(), ir.BoolLiteral(False), scope="global")
    return with_support(done, context, (flag,), (), program.modules[0].task)


def _holds(routine: ir.Routine) -> bool:
    """Does it brake without dropping the move in the next statement?"""
    found = False

    def look(body: ir.Body) -> ir.Body:
        nonlocal found
        for at, statement in enumerate(body):
            if isinstance(statement, ir.StopMotion):
                found = found or not _drops(body, at)
            inside(statement, look)
        return body

    edit_bodies(routine, look)
    return found


def _drops(body: ir.Body, at: int) -> bool:
    return at + 1 < len(body) and isinstance(body[at + 1], ir.ClearMotion)


@dataclass(slots=True)
class _Repeated:
    """`keys`: numbers of the interrupts; `handlers`: their routines and what these call (folded)."""

    context: Context
    keys: frozenset[int]
    handlers: set[str]
    marked: frozenset[int] = frozenset()
    name: str = ""

    def flag(self) -> str:
        self.name = self.name or self.context.fresh("rpl_braked")
        return self.name

    def arms(self, statement: ir.ControlInterrupt) -> bool | None:
        if statement.op not in ("on", "off", "delete"):
            return None
        key = number_of(statement.handle)
        if statement.handle is not None and key not in self.keys:
            return None
        if statement.op == "on":
            return True
        return False if statement.handle is None or len(self.keys) == 1 else None

    def routine(self, editor: Editor, routine: ir.Routine) -> ir.Routine:
        if routine.name.lower() in self.handlers:
            return edit_bodies(routine, self.handler)
        return edit_bodies(routine, lambda body: map_body(body, lambda one: self.statement(editor, one)))

    def handler(self, body: ir.Body) -> ir.Body:
        """A brake is noted; one that drops the move for good takes the note back."""
        done: list[ir.Statement] = []
        for at, statement in enumerate(body):
            later = tidy(statement.origin)
            if isinstance(statement, ir.StopMotion) and not _drops(body, at):
                noted = ir.Assign(ir.Name(self.flag()), ir.BoolLiteral(True), origin=later)
                done += [statement, ir.ClearMotion(origin=later), noted]
            elif isinstance(statement, ir.ClearMotion):
                done += [statement, ir.Assign(ir.Name(self.flag()), ir.BoolLiteral(False), origin=later)]
            else:
                done.append(inside(statement, self.handler))
        return tuple(done)

    def statement(self, editor: Editor, statement: ir.Statement) -> ir.Body:
        if id(statement) in self.marked:
            if isinstance(statement, ir.Move):
                first, move = with_kept_target(editor, statement)
                return (*first, *self.move(move))
            if isinstance(statement, ir.Spline | ir.MoveExternal):
                self.context.diagnostics.report(ANOTHER, statement.origin, reason="it is no single move")
        return (inside(statement, lambda body: map_body(body, lambda one: self.statement(editor, one))),)

    def move(self, move: ir.Move) -> ir.Body:
        reason = _reason(move)
        if reason:
            return not_again(move, reason, self.context)
        if not isinstance(move.blend, ir.BlendStop | None):
            self.context.diagnostics.report(CORNER, move.origin)
        flag, later = ir.Name(self.flag()), tidy(move.origin)
        driven = (
            ir.Assign(flag, ir.BoolLiteral(False), origin=later),
            replace(move, blend=ir.BlendStop()),
            ir.WaitForMotion(origin=later),
        )
        return expansion(move.origin, (ir.Repeat(negation(flag), driven, origin=move.origin),))


def _reason(move: ir.Move) -> str:
    """Why the move cannot begin again from its middle; empty when it can."""
    if path_differs(move):
        return path_differs(move)
    if move.search is not None:
        return "it searches"
    if move.triggers:
        return "its events on the path would come twice"
    return "the program goes on beside it" if move.concurrent else ""


__all__ = ["repeated_moves"]
