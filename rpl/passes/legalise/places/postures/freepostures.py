"""Joint moves to places that say nothing about the arm's posture, where the two controllers choose it by other rules:
the solution nearest to where the arm is, or the posture in which it is.

Where place, tool, frame and the joints before are constant and the rules choose otherwise, the move goes to the joints
that the source's controller takes. Where only the joints before are not known, it goes to those that the source's
controller takes from everywhere the program is known to lead to, if these are the same, with a warning. Else a warning
names the difference.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

from rpl import ir
from rpl.passes.capabilities import Postures
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.whereabouts import Whereabouts
from rpl.passes.legalise.facts.values.taughtvalues import JointsOfPlaces
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.places.postures.choices import ASSUMED, FREE, Choices, joint_target, to_a_place
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import Target


@legalising()
def free_postures(program: ir.Program, context: Context) -> ir.Program:
    """Only on the arm that the program was written for, and between notations whose rules differ on it."""
    choices = Choices.of(context)
    if choices is None or not any(to_a_place(one) for one in walk_for({"Move"}, *program.modules)):
        return program
    return _Free(program, context, choices).program()


class _Free(Rewriter):
    def __init__(self, program: ir.Program, context: Context, choices: Choices) -> None:
        super().__init__(program, context)
        self.choices = choices

    # What costs something is asked when the first move needs it: few do.

    @cached_property
    def unchanged(self) -> Unchanged:
        return unchanged_in(self.source)

    @cached_property
    def written(self) -> JointsOfPlaces:
        return JointsOfPlaces(self.source, self.context)

    @cached_property
    def stands(self) -> Whereabouts:
        """Followed through the program when first asked for."""
        return Whereabouts(self.source, self.context, assuming=True)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move) and to_a_place(statement) and self.is_free(statement):
            return [self.move(statement)] if self.choices.apart else [statement]
        return super().statement(statement)

    def is_free(self, move: ir.Move) -> bool:
        """A pose, a product of places, which has no flags, or a target that is known to have none; one whose posture is
        asked for is not."""
        if any(isinstance(one, ir.System) and one.name.startswith("posture_") for one, _ in move.settings):
            return False
        product = isinstance(move.target, ir.Binary) and move.target.op == ":"
        if product or isinstance(self.type_of(move.target), ir.PoseType):
            return True
        goal = constant(move.target, self.scope, self.unchanged)
        return isinstance(goal, Target) and all(value is None for _, value in goal.flags)

    def move(self, move: ir.Move) -> ir.Move:
        import numpy as np

        before, end = self.stands.starts.get(id(move)), self.stands.ends.get(id(move))
        if before is None or end is None or end.flange is None or move.search is not None:
            self.context.diagnostics.report(FREE, move.origin)
            return move
        flange = np.array(end.flange.matrix)
        if before.joints is None:
            joints = self.choices.from_everywhere(flange, self.stands)
            self.context.diagnostics.report(FREE if joints is None else ASSUMED, move.origin)
            return move if joints is None else self.to_joints(move, joints)
        at = np.array(before.joints)
        if not self.choices.differ(flange, at):
            return move
        return self.to_joints(move, self.choices.source(flange, at))

    def to_joints(self, move: ir.Move, joints: Any) -> ir.Move:
        """To these joints; to the solution of the place next to them, where the target's moves can be told so."""
        if self.context.capabilities.places.postures is Postures.JOINTS:
            return replace(move, target=ir.Builtin("target_to_joints_near", (move.target, joint_target(joints, 0))))
        self.written.tell(move, self.scope, move.target)
        return replace(move, target=joint_target(joints))


__all__ = ["free_postures"]
