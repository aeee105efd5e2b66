"""Moves to places that the arm cannot reach, where a routine for all errors holds in the source (V+ REACTE).

Targets stop at such a move without asking anybody. Where place, tool and frame are constant and no posture of the arm
gets there, the error is raised instead of the move, so that the routine is called.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.errornames import neutral_name
from rpl.ir.walk import walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.flow import ModalFlow
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import pose_of

RAISED = code(
    "unreachable-move-raised",
    Severity.WARNING,
    "the arm cannot reach this place: the error is raised here in place of the move",
    "write a place that the arm reaches",
)
_NAME = "unreachable"


@legalising(
    unless=lambda context: (
        "OnError" in context.capabilities.statements
        or context.robot is None
        or (context.to_robot is not None and context.to_robot is not context.robot)
    ),
    sees=("OnError",),
)
def errors_of_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such a routine, for the arm that the program was written for."""
    if not any(isinstance(one, ir.OnError) and one.routine is not None for one in walk(*program.modules)):
        return program
    numbers = [number for name, number in rules_of(context.source).errors.items() if neutral_name(name) == _NAME]
    return _Places(program, context, numbers[0]).program() if numbers else program


class _Places(Rewriter):
    def __init__(self, program: ir.Program, context: Context, number: int) -> None:
        super().__init__(program, context)
        self.number = number
        self.flow, self.unchanged = ModalFlow(program, self.scopes), unchanged_in(program)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if not isinstance(statement, ir.Move) or not self.out_of_reach(statement):
            return super().statement(statement)
        self.context.diagnostics.report(RAISED, statement.origin)
        return [ir.Raise(ir.IntLiteral(self.number), origin=statement.origin)]

    def out_of_reach(self, move: ir.Move) -> bool:
        """Has no posture of the arm its flange there?"""
        frames, arm = self.flow.frames.get(id(move)), self.context.robot
        pose = pose_of(constant(move.target, self.scope, self.unchanged))
        if frames is None or pose is None or arm is None or move.relative is not None or move.group != 1:
            return False
        flange = frames.flange(pose)
        return flange is not None and not arm.inverse(flange.matrix, arm.home)


__all__ = ["errors_of_places"]
