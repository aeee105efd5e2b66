"""Places on another arm than the one they were written for, where written flags do not say all of it.

Flags of written places are converted beside this, with the reach of what they name. What has none (URScript, V+) or is
worked out from a place is looked at here: whether the other arm comes to it at all, and where only the run knows that.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.columns import LooksInsideError
from rpl.ir.walk import bodies, walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Arm, Context
from rpl.passes.legalise.facts.motion.whereabouts import Whereabouts
from rpl.passes.legalise.places.postures.choices import FREE
from rpl.passes.legalise.places.postures.rowpostures import flanges_in_rows, stretch_of_matrix
from rpl.passes.legalise.places.postures.unreachable import reached
from rpl.passes.legalise.source.places.rotationvectors import rotation_vectors
from rpl.passes.legalise.stages import legalising
from rpl.passes.rigid import Pose
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.passes.values import Target, Value

NOT_LOOKED_AT = code(
    "place-not-looked-at",
    Severity.WARNING,
    "this place, its tool or its frame is worked out by the run: whether the arm {arm} reaches it is not known here",
    "run the result on that arm (rpl run --robot)",
)


@legalising()
def places_on_other_arm(program: ir.Program, context: Context) -> ir.Program:
    """Reports only, and what it has found out for those who stop at places that are not reached."""
    arm, other = context.robot, context.to_robot
    if arm is None or other is None or other.name == arm.name:
        return program
    stands = Whereabouts(_neutral(program, context), replace(context, to_robot=None), postures=False)
    places = _Places(context, other)
    for module, routine in stands.scopes.routines():
        scope = stands.scopes.routine(module, routine)
        for body in bodies(routine):
            for node in walk(body):
                if isinstance(node, ir.Move) and node.relative is None and id(node) in stands.ends:
                    goal = constant(node.target, scope, stands.unchanged)
                    places.move(node, goal, stands.ends[id(node)].flange, scope)
    return program


def _neutral(program: ir.Program, context: Context) -> ir.Program:
    """With constant rotation vectors as angles, also where the result is in the language of the source."""
    if context.foreign:
        return program
    plain = replace(context.capabilities, functions=frozenset())
    return rotation_vectors(program, replace(context, capabilities=plain, taken=set(context.taken)))


class _Places:
    def __init__(self, context: Context, arm: Arm) -> None:
        self.context, self.arm = context, arm
        self.found: dict[Pose, str] = {}  # why not; empty: it is reached

    def move(self, move: ir.Move, goal: Value | None, flange: Pose | None, scope: Scope) -> None:
        stretch = None if flange is None else stretch_of_matrix(flange.matrix)
        flanges: Any = None
        if flange is not None and stretch is not None:
            flanges, first = flanges_in_rows(stretch, flange.matrix), stretch.row(stretch.first)
            self.context.flanges += flanges[first : first + stretch.end - stretch.first].tolist()
        elif flange is not None:
            self.context.flanges.append(flange.matrix)
        type = type_of(move.target, scope)
        written = isinstance(goal, Target) and any(value is not None for _, value in goal.flags)
        if isinstance(type, ir.JointsType) or (written and isinstance(move.target, ir.Name | ir.Index | ir.Aggregate)):
            return  # the conversion of what is written reports these itself
        report = self.context.diagnostics.report
        if stretch is not None and (missed := stretch.moves_where(~reached(self.arm, flanges))):
            raise LooksInsideError(stretch, missed)
        reason = None if flange is None else "" if stretch is not None else self.why_not(flange)
        if reason is None:
            report(NOT_LOOKED_AT, move.origin, arm=self.arm.name)
        elif reason:
            self.context.not_reached(move.origin, "place", reason)
        free = move.kind == "joint" and not written and not _asks_for_a_posture(move)
        if free and not reason and self.context.foreign:
            report(FREE, move.origin)

    def why_not(self, flange: Pose) -> str:
        if flange not in self.found:
            import numpy as np  # most translations ask nothing of the arm

            arm: Any = self.arm
            solutions = arm.inverse(np.array(flange.matrix), arm.home)
            within = any(len(arm.expand_turns(one)) for one in solutions)
            beyond = "every posture exceeds a joint limit" if solutions else "it is out of reach"
            self.found[flange] = "" if within else beyond
        return self.found[flange]


def _asks_for_a_posture(move: ir.Move) -> bool:
    return any(isinstance(one, ir.System) and one.name.startswith("posture_") for one, _ in move.settings)


__all__ = ["places_on_other_arm"]
