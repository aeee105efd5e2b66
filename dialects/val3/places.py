"""Values with what VAL3 knows of them beside the value: their kind, and where a point, frame or tool hangs.

A point counts in its father frame, a frame in its father frame up to the world, a tool in its father tool up to the
flange. `place` is the pose of what it hangs on as an expression of the IR: for a point its frame in the world, for a
frame or tool its own pose in the world or on the flange.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.passes.rigid import rotation_of_turns

WORLD = ir.System("null_frame")
TARGET = ir.TargetType("val3", external=False)
POSE_PARTS = ("x", "y", "z", "a", "b", "c")


@dataclass(frozen=True, slots=True)
class Value:
    """An expression and its kind: num, bool, string, trsf, frame, tool, point, joint, config, mdesc, dio, aio, sio, or
    empty where it is not known."""

    node: ir.Expression
    kind: str = ""
    place: ir.Expression = WORLD


def composed(first: ir.Expression, second: ir.Expression) -> ir.Expression:
    """first * second, without factors that do nothing."""
    if first == WORLD:
        return second
    return first if second == WORLD else ir.Binary(":", first, second)


def inverted(pose: ir.Expression) -> ir.Expression:
    match pose:
        case ir.System(name="null_frame"):
            return pose
        case ir.Builtin(function="inverse", arguments=(inner,)):
            return inner
    return ir.Builtin("inverse", (pose,))


def moved_to(point: Value, place: ir.Expression) -> ir.Expression:
    """The point as it counts in the frame at `place`, at the same place in the room."""
    if point.place == place:
        return point.node
    return ir.Builtin("displaced", (point.node, composed(inverted(place), point.place)))


def number_of(value: ir.Expression) -> float | None:
    """The number that an expression is, when it is one."""
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return float(number)
        case ir.Unary(op="-", operand=inner):
            found = number_of(inner)
            return None if found is None else -found
    return None


def real(value: float) -> ir.RealLiteral | ir.IntLiteral:
    return ir.IntLiteral(int(value)) if value == int(value) and abs(value) < 1e9 else ir.RealLiteral(value)


def pose(parts: tuple[ir.Expression, ...]) -> ir.Expression:
    """A trsf of x, y, z, rx, ry, rz."""
    numbers = [number_of(part) for part in parts[3:]]
    if all(number is not None for number in numbers):
        rx, ry, rz = [number or 0.0 for number in numbers]
        if not (rx or ry):
            angles: tuple[ir.Expression, ...] = (parts[5], real(0.0), real(0.0))
        elif not (ry or rz):
            angles = (real(0.0), real(0.0), parts[3])
        else:
            angles = tuple(real(angle) for angle in rotation_of_turns((1, rx), (2, ry), (3, rz)).zyx)
        return ir.Aggregate(tuple(zip(POSE_PARTS, (*parts[:3], *angles), strict=True)), "pose")
    return ir.Builtin("tool_offset", (WORLD, *parts))


def angle(value: ir.Expression, name: str) -> ir.Expression:
    """rx, ry or rz of a pose: those of ZYX angles of its inverse, with the other sign."""
    function = {"rx": "euler_x", "ry": "euler_y", "rz": "euler_z"}[name]
    turned = ir.Field(ir.Builtin("inverse", (ir.Builtin("pose_of", (value,)),)), "rot")
    return ir.Unary("-", ir.Builtin(function, (turned,)))


__all__ = ["TARGET", "WORLD", "Value", "angle", "composed", "inverted", "moved_to", "number_of", "pose", "real"]
