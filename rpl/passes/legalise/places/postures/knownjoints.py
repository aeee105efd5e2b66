"""The joints of a place that is constant, worked out with the arm's model, for targets that cannot calculate them.

The place must be written in full: its posture by all flags of the source's notation, or by constant joints that the
solution is nearest to; its tool and frame constant. What is not stays, and `refuse` names it.
"""

from __future__ import annotations

from typing import Any

from rpl import ir, registry
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, array
from rpl.passes.legalise.facts.taughtvalues import tell_written
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.values import Record, Target, component, pose_of, real
from rpl.source import NOWHERE

_SOLVED = {"target_to_joints": 1, "target_to_joints_near": 2}  # function -> arguments before tool and frame


@legalising(
    unless=lambda context: (
        context.robot is None
        or context.capabilities.places.kinematics is not None
        or (context.to_robot is not None and context.to_robot is not context.robot)
    ),
    sees=[f"function {one}" for one in _SOLVED],
)
def known_joints(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the functions, on the arm that the program was written for."""
    return _Known(program, context).program()


class _Known(Rewriter):
    """Rewrites the functions outside of moves, which find the joints themselves."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.unchanged, self.here = unchanged_in(program), NOWHERE

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        self.here = statement.origin
        return [statement] if isinstance(statement, ir.Move) else super().statement(statement)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function=function, arguments=given) if (
                function in _SOLVED and function not in self.context.capabilities.functions
            ):
                found = self.solved(given, _SOLVED[function])
                if found is not None:
                    tell_written(self.context, self.scope, self.here, "these joint values", *given)
                    entries = tuple(
                        (name, real(round(float(one), 9))) for name, one in zip(ir.AXES, found, strict=False)
                    )
                    return ir.Aggregate(entries, type_name="joints", origin=expression.origin)
        return rewrite_parts(expression, self.expression)

    def solved(self, given: tuple[ir.Expression, ...], own: int) -> Any:
        """The joints in the arm's units, or None."""
        arm = self.context.robot
        place, frames = constant(given[0], self.scope, self.unchanged), given[own:]
        pose = pose_of(place)
        tool = self.frame(frames[0], "frame") if frames else None
        base = self.frame(frames[1], "user_frame") if len(frames) > 1 else None
        if arm is None or pose is None or tool is None or base is None:
            return None
        flange: Any = base.then(pose).then(tool.inverse).matrix
        if own == 2:
            near = self.axes(given[1], arm.axes)
            return None if near is None else arm.nearest(flange, near)
        make = registry.dialect(self.context.source).notation
        if make is None or not isinstance(place, Target):
            return None
        notation, model = make(), _any(arm)
        flags = {name: value for name, value in place.flags if name in notation.fields}
        return notation.select(model, array(flange), flags, None).joints if len(flags) == len(notation.fields) else None

    def frame(self, given: ir.Expression, part: str) -> rigid.Pose | None:
        """A constant tool or work object as a pose."""
        if given in (ir.System("null_frame"), ir.System("world")):
            return rigid.IDENTITY
        value = constant(given, self.scope, self.unchanged)
        if not isinstance(value, Record):
            return pose_of(value)
        first = pose_of(value.part(part))
        if part == "frame":
            return None if value.part("held") is False else first
        inner = pose_of(value.part("object_frame"))
        return None if first is None or inner is None or value.part("held") is True else first.then(inner)

    def axes(self, given: ir.Expression, count: int) -> list[float] | None:
        """Constant joint values."""
        value = constant(given, self.scope, self.unchanged)
        if not isinstance(value, Record):
            return None
        found = [component(value, name) for name in ir.AXES[:count]]
        return [float(one) for one in found if isinstance(one, int | float)] if None not in found else None


def _any(arm: Any) -> Any:
    """A notation is written against the emulator's own model, which every arm is."""
    return arm


__all__ = ["known_joints"]
