"""What a program asks of the robot and of its signals: a controller that runs ahead of the moves waits there."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.scope import Scope

_SEEN = frozenset(("current_target", "current_joints", "current_position"))
_OF_NOW = frozenset(("actual_pose", "actual_joints", "actual_joint"))
# Behind these nothing is known of the move that the robot drives.
UNKNOWN_BEHIND = (
    *(ir.Move, ir.MoveExternal, ir.Spline, ir.CallRoutine, ir.WaitForMotion),
    *(ir.Label, ir.Goto, ir.Return, ir.Halt, ir.Raise),
)


def looks(node: object) -> bool:
    """Is it a question where the robot is?"""
    match node:
        case ir.System(name=name):
            return name in _OF_NOW
        case ir.Builtin(function=function):
            return function in _SEEN
    return False


def touches(statement: ir.Statement, scope: Scope) -> bool:
    """Does the statement itself (not its bodies) read or write a signal or an actual position?"""
    found = False

    def look(expression: ir.Expression) -> None:
        nonlocal found
        match expression:
            case ir.Signal():
                found = found or not is_flag(expression)
            case ir.System(name=name) if name in ir.SYSTEM_VARIABLES:
                found = found or ir.SYSTEM_VARIABLES[name].stops_advance
            case ir.Name(id=name):
                symbol = scope.value(name)
                found = found or (symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration))
            case ir.Builtin(function="current_target" | "current_joints" | "current_position"):
                found = True

    each_expression(statement, look)
    return found


def is_flag(expression: object) -> bool:
    """A flag of the controller: it is no signal of the machine."""
    match expression:
        case ir.Signal(kind="flag") | ir.System(name="flag" | "cyclic_flag"):
            return True
    return False
