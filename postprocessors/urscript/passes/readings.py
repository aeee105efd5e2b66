"""Numbers read out of poses and joints, in mm and degrees, lose what the change of units leaves behind them.

A pose in metres and radians gives 89.99999999 where its source had 90, so a number that is kept, compared or cut is
rounded first. Five decimals are far below what a robot repeats, and keep whole numbers within 32 bits up to 20 m.
What the source itself reads in metres or radians (`Magnitude`) is the same number here.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

DECIMALS = 5
_PLACES = (ir.PoseType, ir.TargetType, ir.VectorType, ir.RotationType, ir.JointsType, ir.AxesType)
_COMPARISONS = frozenset(("=", "<>", "<", ">", "<=", ">="))
_CUT = frozenset(("floor", "ceil", "trunc", "fraction", "value_text", "sign"))


@legalising()
def clean_readings(program: ir.Program, context: Context) -> ir.Program:
    """Numbers read out of poses are rounded where they are kept, compared or cut."""
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        routines = tuple(_routine(routine, scopes.routine(module, routine)) for routine in module.routines)
        modules.append(replace(module, routines=routines))
    return replace(program, modules=tuple(modules))


def _routine(routine: ir.Routine, scope: Scope) -> ir.Routine:
    def cleaned(value: ir.Expression) -> ir.Expression:
        if not isinstance(type_of(value, scope), ir.RealType) or not reads(value, scope):
            return value
        return ir.Builtin("round", (value, ir.IntLiteral(DECIMALS)), origin=value.origin)

    def change(node: object) -> object:
        match node:
            case ir.Assign(value=value) | ir.Binary(op="<" | "<=" | ">" | ">=", left=value) if _on_the_way(value):
                return node
            case ir.Assign(target=ir.Name() | ir.Index() as target, value=value):
                return replace(node, value=cleaned(value)) if _is_number(target, scope) else node
            case ir.Assign(target=ir.Field(base=base) as target, value=value):
                own = isinstance(type_of(base, scope), _PLACES)
                return node if own or not _is_number(target, scope) else replace(node, value=cleaned(value))
            case ir.Binary(op=op, left=left, right=right) if op in _COMPARISONS:
                return replace(node, left=cleaned(left), right=cleaned(right))
            case ir.Convert(how="trunc" | "floor" | "round_half_away", operand=operand):
                return replace(node, operand=cleaned(operand))
            case ir.Builtin(function=function, arguments=(value, *rest)) if function in _CUT:
                return replace(node, arguments=(cleaned(value), *rest))
            case ir.Return(value=value) if value is not None:
                return replace(node, value=cleaned(value))
        return node

    return rewrite(routine, change)


def _on_the_way(value: ir.Expression) -> bool:
    """How far a robot that moves is from somewhere: no number that anything could have been meant to be."""
    return (
        isinstance(value, ir.Builtin)
        and value.function == "distance"
        and value.arguments[0] == ir.System("actual_pose")
    )


def reads(value: ir.Expression, scope: Scope) -> bool:
    """Does the number come out of a pose or of joints, not rounded yet?"""
    if isinstance(value, ir.Builtin) and value.function in ("round", "trunc", "floor", "ceil", "sign"):
        return False
    for node in walk((rewrite(value, _without_measures),)):
        match node:
            case ir.Field(base=base) if isinstance(type_of(base, scope), _PLACES):
                return True
            case ir.System(name="actual_joint") | ir.Builtin(function="distance" | "rotation_angle"):
                return True
            case ir.Builtin(function="euler_x" | "euler_y" | "euler_z" | "zyz_yaw" | "zyz_pitch" | "zyz_roll"):
                return True
    return False


def _without_measures(node: object) -> object:
    return ir.RealLiteral(0.0) if isinstance(node, ir.Magnitude) else node


def _is_number(target: ir.Expression, scope: Scope) -> bool:
    return isinstance(type_of(target, scope), ir.RealType)
