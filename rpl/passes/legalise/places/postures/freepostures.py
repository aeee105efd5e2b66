"""Joint moves to places that say nothing about the arm's posture, where the two controllers choose it by other rules:
the solution nearest to where the arm is, or the posture in which it is.

Where place, tool, frame and the joints before are constant and the rules choose otherwise, the move goes to the joints
that the source's controller takes. Where only the joints before are not known, it goes to those that the source's
controller takes from everywhere the program is known to lead to, if these are the same, with a warning. Else a warning
names the difference.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Any

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.whereabouts import Whereabouts
from rpl.passes.legalise.facts.values.taughtvalues import JointsOfPlaces
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import Target, real

FREE = code(
    "posture-left-free",
    Severity.WARNING,
    "this place says nothing about the arm's posture: the source's controller and the target's choose it by other "
    "rules, and where the arm stands before is not known here",
    "write the posture into the place, or move to joints before",
)
ASSUMED = code(
    "posture-as-from-known",
    Severity.WARNING,
    "this place says nothing about the arm's posture, and where the arm stands before is not known here: it goes to "
    "the joints that the source's controller takes from every place that is known in this program",
    "write the posture into the place, or move to joints before",
)
_SAME_DEG = 0.01
_TRIED = 60  # pairs of places, spread evenly by chance over the ranges of the axes
_OFTEN = 0.05  # of them; what differs less often is a matter of the limits of the axes


@legalising()
def free_postures(program: ir.Program, context: Context) -> ir.Program:
    """Only on the arm that the program was written for, and between notations whose rules differ on it."""
    arm, other, can = context.robot, context.to_robot, context.capabilities
    if arm is None or can.carries_rules or not context.foreign or (other is not None and other is not arm):
        return program
    ours, theirs = registry.dialect(context.source).notation, registry.dialect(can.places.notation).notation
    if ours is None or theirs is None or not any(_may_be_free(one) for one in walk_for({"Move"}, *program.modules)):
        return program
    return _Free(program, context, ours, theirs).program()


def _may_be_free(node: object) -> bool:
    return isinstance(node, ir.Move) and node.kind == "joint" and node.relative is None


@lru_cache(maxsize=64)
def _apart(arm: Any, ours: Any, theirs: Any) -> bool:
    """Do the controllers often choose otherwise on this arm, with nothing said? ours, theirs: classes of notations."""
    import numpy as np  # most translations ask nothing of the arm

    low, high = arm.limits[:, 0], arm.limits[:, 1]
    spread = np.random.default_rng(1).uniform(-0.9, 0.9, size=(_TRIED, 2, len(low)))
    pairs = np.clip((low + high) / 2 + spread * (high - low) / 2, -170.0, 170.0)
    first, second = ours(), theirs()
    differ = sum(_differ(arm, first, second, arm.forward(to), at) for at, to in pairs)
    return differ > _OFTEN * _TRIED


def _chosen(arm: Any, notation: Any, flange: Any, before: Any) -> Any:
    return notation.select(arm, flange, {}, before).joints


def _differ(arm: Any, ours: Any, theirs: Any, flange: Any, before: Any) -> bool:
    """Do both controllers come there, but otherwise?"""
    first = _chosen(arm, ours, flange, before)
    second = None if first is None else _chosen(arm, theirs, flange, before)
    return second is not None and bool(abs(first - second).max() > _SAME_DEG)


class _Free(Rewriter):
    def __init__(self, program: ir.Program, context: Context, ours: Any, theirs: Any) -> None:
        super().__init__(program, context)
        self.arm: Any = context.robot
        self.notations = ours, theirs
        self.ours, self.theirs = ours(), theirs()

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
        return Whereabouts(self.source, self.context)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move) and _may_be_free(statement) and self.is_free(statement):
            return [self.move(statement)] if _apart(self.arm, *self.notations) else [statement]
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
            joints = self.from_everywhere(flange)
            self.context.diagnostics.report(FREE if joints is None else ASSUMED, move.origin)
            return move if joints is None else self.to_joints(move, joints)
        at = np.array(before.joints)
        if not _differ(self.arm, self.ours, self.theirs, flange, at):
            return move
        return self.to_joints(move, _chosen(self.arm, self.ours, flange, at))

    def from_everywhere(self, flange: Any) -> Any:
        """The joints that the source's controller takes from all places where the arm is known to be; None where these
        are not the same."""
        import numpy as np

        known = {one.joints for one in self.stands.ends.values() if one.joints is not None}
        found = [_chosen(self.arm, self.ours, flange, np.array(one)) for one in sorted(known)]
        if not found or any(one is None or abs(one - found[0]).max() > _SAME_DEG for one in found):
            return None
        return found[0]

    def to_joints(self, move: ir.Move, joints: Any) -> ir.Move:
        self.written.tell(move, self.scope, move.target)
        entries = tuple((name, real(round(float(one), 9))) for name, one in zip(ir.AXES, joints, strict=False))
        return replace(move, target=ir.Aggregate(entries, type_name="joints"))


__all__ = ["free_postures"]
