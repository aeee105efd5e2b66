"""Interrupts that stop the robot, for targets whose tasks cannot stop it, but whose moves end at a condition.

While such an interrupt may come, each move is a search for its condition. Where that came, the program acts behind the
move: it goes on there, drives to the end of the move, or leaves the level of the declaration.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.control.jumps import inside
from rpl.passes.legalise.interrupts.heldmotion import not_again, path_differs, with_kept_target
from rpl.passes.legalise.interrupts.served import Served
from rpl.passes.legalise.rewriting.editing import Editor, negation
from rpl.passes.legalise.tasks.beside import tidy

CORNER = code(
    "interrupt-stops-corner",
    Severity.WARNING,
    "a move that an interrupt may stop ends at its point: its corner is not rounded while the interrupt may come",
)


def unending(
    one: ir.DeclareInterrupt, brakes: bool, data: bool = False, signals: Mapping[str, ir.Signal] | None = None
) -> str:
    """Why no move can end for it; empty when one can. `data`: a move may end at a truth value too; `signals`: those
    that have names, folded."""
    if not brakes and not one.stops:
        return "it takes time while the robot moves on"
    if not _looks_at_input(one.condition, data, signals or {}):
        return "a move ends at one input only"
    return ""


def _looks_at_input(condition: ir.Expression, data: bool, signals: Mapping[str, ir.Signal]) -> bool:
    match condition:
        case ir.Name(id=name) if name.lower() in signals:
            return _looks_at_input(signals[name.lower()], data, {})
        case ir.Name():
            return data
        case ir.Signal(kind="digital_in", last=None):
            return True
        case ir.Unary(op="not", operand=operand) | ir.Binary(op="=" | "<>", left=operand, right=ir.BoolLiteral()):
            return _looks_at_input(operand, data, signals)
    return False


@dataclass(slots=True)
class EndedMoves(Served):
    """Serves as `Served` does, with searches in place of a task that drives."""

    def body(self, editor: Editor, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.Move) and statement.search is None and id(statement) in self.marked:
                done.extend(self.drive(editor, [statement]))
            else:
                done.extend(self.statement(editor, statement))
        return tuple(done)

    def statement(self, editor: Editor, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move) and statement.search is not None:
            return (statement,)
        if isinstance(statement, ir.WaitForMotion) and id(statement) in self.marked:
            look = ir.CallRoutine(self.name("rpl_interrupts"), origin=tidy(statement.origin))
            return self.leaving(statement, (statement, look))
        return Served.statement(self, editor, statement)

    def drive(self, editor: Editor, moves: list[ir.Move]) -> ir.Body:
        """The move, which ends where the condition comes; what was only stopped begins again from there. Where the
        condition holds from the start the interrupt has come before and the move is one as any other."""
        (move,) = moves
        first: ir.Body = ()
        again = id(move) in self.again
        if again:
            first, move = with_kept_target(editor, move)
        if again and path_differs(move):
            return not_again(move, path_differs(move), self.context)
        if not isinstance(move.blend, ir.BlendStop | None):
            self.context.diagnostics.report(CORNER, move.origin)
        (watch,) = self.watches.values()
        hit = editor.temporary("hit", ir.BoolType())
        condition, was = watch.declared.condition, ir.Name(watch.was)
        look = ir.CallRoutine(self.name("rpl_interrupts"))
        bare = replace(move, origin=tidy(move.origin))
        ended = replace(bare, search=ir.Search(condition, stop="stop", hit=hit), blend=ir.BlendStop())
        comes: ir.Expression = ir.Binary("cand", ir.Name(watch.armed), negation(was))
        held = watch.may_come()
        if held is not None:
            comes = ir.Binary("cand", comes, held)
        rest: ir.Body = () if watch.declared.stops else (self.onward(hit, bare),)
        tried: ir.Body = (ended, ir.If(((hit, (look, *rest)),)))
        told = self.leaving(move, (look,), True)
        return (*first, *told, *self.leaving(bare, (ir.If(((comes, tried),), (bare,)),), True))

    def onward(self, hit: ir.Expression, move: ir.Move) -> ir.Statement:
        """The rest of the move, unless the level was left."""
        if not self.leaves:
            return move
        return ir.If(((negation(ir.Name(self.name("rpl_left"))), (move,)),))

    def handler(self, statement: ir.Statement) -> ir.Body:
        """The robot stands when the interrupt acts."""
        match statement:
            case ir.StopMotion() | ir.ClearMotion() | ir.StartMotion():
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.ResumeLevel():
                left = ir.Assign(ir.Name(self.name("rpl_left")), ir.BoolLiteral(True), origin=statement.origin)
                return (left, ir.Return(origin=tidy(statement.origin)))
        return (inside(statement, lambda body: tuple(one for each in body for one in self.handler(each))),)

    def looking(self) -> ir.Body:
        """The interrupt, unless it is acting."""
        (watch,) = self.watches.values()
        was, condition = ir.Name(watch.was), watch.declared.condition
        comes: ir.Expression = ir.Binary("cand", ir.Name(watch.armed), negation(was))
        held = watch.may_come()
        if held is not None:
            comes = ir.Binary("cand", comes, held)
        acts: list[ir.Statement] = [ir.Assign(was, ir.BoolLiteral(True))]
        if watch.declared.once:
            acts.insert(0, ir.Assign(ir.Name(watch.armed), ir.BoolLiteral(False)))
        acts.append(replace(watch.declared.action, origin=tidy(watch.declared.action.origin)))
        gone = (negation(condition), (ir.Assign(was, ir.BoolLiteral(False)),))
        return (ir.If(((ir.Binary("cand", condition, comes), tuple(acts)), gone)),)

    def data(self) -> tuple[ir.Variable, ...]:
        if "rpl_left" not in self.names:
            return ()
        return (ir.Variable(self.names["rpl_left"], ir.BoolType(), ir.BoolLiteral(False), scope="global"),)


__all__ = ["EndedMoves", "unending"]
