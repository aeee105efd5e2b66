"""Values of constants as plain Python, and what operators and pure functions make of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir, registry
from rpl.ir.columns import as_float, as_whole, by_row
from rpl.passes import rigid
from rpl.passes.numeric import NUMERIC, round_half_away
from rpl.passes.typewords import type_word


@dataclass(frozen=True, slots=True)
class Member:
    """A member of an enumeration, folded."""

    name: str


@dataclass(frozen=True, slots=True)
class Record:
    """Any structured value that is no vector, rotation or pose: components by neutral name."""

    type: ir.Type
    parts: tuple[tuple[str, Value], ...]

    def part(self, name: str) -> Value | None:
        for key, value in self.parts:
            if key == name:
                return value
        return None


@dataclass(frozen=True, slots=True)
class Target:
    """A pose with the flags of a notation and external axes, as far as they are given."""

    type: ir.TargetType
    pose: rigid.Pose
    flags: tuple[tuple[str, int], ...]
    external: tuple[tuple[str, float], ...]


Value = (
    bool
    | int
    | float
    | str
    | Member
    | Record
    | Target
    | rigid.Vector
    | rigid.Rotation
    | rigid.Pose
    | tuple["Value", ...]
)


def composed(type: ir.Type, parts: dict[str, Value]) -> Value | None:
    match type:
        case ir.VectorType():
            return _vector(parts)
        case ir.RotationType():
            return _rotation(parts)
        case ir.PoseType():
            return _pose(parts)
        case ir.TargetType(notation=notation):
            pose = _pose(parts)
            if pose is None:
                return None
            names = registry.dialect(notation).notation_fields
            flags = {name: value for name, value in parts.items() if name in names}
            conf, ext = parts.get("conf"), parts.get("ext")
            if isinstance(conf, Record):
                flags.update(conf.parts)
            external = {name: value for name, value in parts.items() if name in ir.COMPONENTS[ir.ExternalType]}
            if isinstance(ext, Record):
                external.update(ext.parts)
            return Target(
                type,
                pose,
                tuple((name, as_whole(v)) for name, v in flags.items() if isinstance(v, int | float)),
                tuple((name, as_float(v)) for name, v in external.items() if isinstance(v, int | float)),
            )
    return Record(type, tuple(parts.items()))


def _numbers(parts: dict[str, Value], names: tuple[str, ...]) -> list[float] | None:
    values = [parts.get(name) for name in names]
    found = [as_float(value) for value in values if isinstance(value, int | float)]
    return found if len(found) == len(names) else None


def _vector(parts: dict[str, Value]) -> rigid.Vector | None:
    xyz = _numbers(parts, ("x", "y", "z"))
    return rigid.Vector(*xyz) if xyz else None


def _rotation(parts: dict[str, Value]) -> rigid.Rotation | None:
    quaternion = _numbers(parts, ("q1", "q2", "q3", "q4"))
    if quaternion:
        return rigid.rotation_of_quaternion(*quaternion)
    angles = _numbers(parts, ir.ANGLES)
    return rigid.rotation_of_zyx(*angles) if angles else None


def _pose(parts: dict[str, Value]) -> rigid.Pose | None:
    trans, rot = parts.get("trans"), parts.get("rot")
    position = trans if isinstance(trans, rigid.Vector) else _vector(parts)
    rotation = rot if isinstance(rot, rigid.Rotation) else _rotation(parts)
    return rigid.Pose(position, rotation) if position and rotation else None


def component(value: Value, name: str) -> Value | None:
    """A component by its neutral name; None when the value has none of that name."""
    match value:
        case rigid.Vector():
            return {"x": value.x, "y": value.y, "z": value.z}.get(name)
        case rigid.Rotation():
            if name in ("q1", "q2", "q3", "q4"):
                return value.quaternion[int(name[1]) - 1]
            return value.zyx["abc".index(name)] if name in ir.ANGLES else None
        case rigid.Pose():
            if name == "trans":
                return value.position
            if name == "rot":
                return value.rotation
            return component(value.position if name in ("x", "y", "z") else value.rotation, name)
        case Target():
            for key, number in (*value.flags, *value.external):
                if key == name:
                    return number
            if name == "conf":
                return Record(ir.ConfigType(value.type.notation), value.flags)
            if name == "ext":
                return Record(ir.ExternalType(), value.external)
            return component(value.pose, name)
        case Record():
            return value.part(name) if value.part(name) is not None else value.part(name.lower())
    return None


def scaled(value: Value | None, factor: float) -> Value | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return value if factor == 1.0 else _rounded(value * factor)


@by_row
def _rounded(value: float) -> float:
    return float(f"{value:.15g}")


def unary(op: str, value: Value | None) -> Value | None:
    match op, value:
        case "not", bool():
            return not value
        case "-", int() | float():
            return -value
        case "+", int() | float():
            return value
        case "bnot", int():
            return ~value
        case "-", rigid.Vector():
            return value.times(-1.0)
    return None


def converted(how: str, value: Value | None) -> Value | None:
    match how, value:
        case "real", int() | float():
            return as_float(value)
        case "round_half_away", int() | float():
            return round_half_away(float(value))
        case "trunc", int() | float():
            return math.trunc(value)
        case "bit", bool():
            return int(value)
        case "minus_bit", bool():
            return -int(value)
        case "floor", int() | float():
            return math.floor(value)
        case "truth", int() | float():
            return value != 0
        case "code", str() if value:
            return ord(value[0])
        case "char", int():
            return chr(value) if 0 <= value < 256 else None
    return None


def _whole_division(one: float, other: float) -> float:
    quotient = math.trunc(one / other)
    return quotient if isinstance(one, int) and isinstance(other, int) else float(quotient)


_ARITHMETIC: dict[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "div": _whole_division,
    "mod": lambda a, b: a - b * _whole_division(a, b),
    "**": lambda a, b: float(a) ** b,
    "quo": lambda a, b: _whole_division(a, b) if isinstance(a, int) and isinstance(b, int) else a / b,
}
_ORDER: dict[str, Callable[[float, float], bool]] = {
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}
_LOGIC: dict[str, Callable[[bool, bool], bool]] = {
    "and": lambda a, b: a and b,
    "cand": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "cor": lambda a, b: a or b,
    "xor": lambda a, b: a != b,
}
_BITS: dict[str, Callable[[int, int], int]] = {
    "band": lambda a, b: a & b,
    "bor": lambda a, b: a | b,
    "bxor": lambda a, b: a ^ b,
}


def binary(op: str, one: Value, other: Value) -> Value | None:
    if op in ("=", "<>"):
        return (one == other) == (op == "=")
    match one, other:
        case bool(), bool():
            return _LOGIC[op](one, other) if op in _LOGIC else None
        case bool(), _:
            return None
        case _, bool():
            return None
        case ((int() | float()), (int() | float())):
            return _of_numbers(op, one, other)
        case str(), str():
            return one + other if op in ("&", "+") else None
        case rigid.Vector(), rigid.Vector():
            table = {"+": one.plus(other), "-": one.plus(other, -1.0), "@": one.cross(other)}
            return table.get(op)
        case rigid.Vector(), (int() | float()):
            factor = {"*": float(other), "/": 1.0 / other if other else 0.0}.get(op)
            return one.times(factor) if factor is not None else None
        case ((int() | float()), rigid.Vector()):
            return other.times(float(one)) if op == "*" else None
        case rigid.Rotation(), rigid.Rotation():
            return one.then(other) if op in (":", "*") else None
    return _composition(one, other) if op == ":" else None


def _of_numbers(op: str, one: float, other: float) -> Value | None:
    if op in _ORDER:
        return _ORDER[op](one, other)
    if op in _BITS and isinstance(one, int) and isinstance(other, int):
        return _BITS[op](one, other)
    if op not in _ARITHMETIC:
        return None
    try:
        result = _ARITHMETIC[op](one, other)
    except (ZeroDivisionError, OverflowError):
        return None  # the run reports it with its place
    return None if isinstance(result, complex) else result


def pose_of(value: Value | None) -> rigid.Pose | None:
    """The pose of a pose or target, a vector or rotation taken as a pose; None for anything else."""
    match value:
        case rigid.Pose():
            return value
        case Target():
            return value.pose
        case rigid.Vector():
            return rigid.Pose(value, rigid.NO_TURN)
        case rigid.Rotation():
            return rigid.Pose(rigid.IDENTITY.position, value)
    return None


def _composition(one: Value, other: Value) -> Value | None:
    left, right = pose_of(one), pose_of(other)
    if left is None or right is None:
        return None
    done = left.then(right)
    return replace(other, pose=done, flags=()) if isinstance(other, Target) else done


def pure(function: str, values: list[Value], given: int) -> Value | None:
    if len(values) != given:
        return None
    numbers = [value for value in values if isinstance(value, int | float) and not isinstance(value, bool)]
    if len(numbers) == given and function in NUMERIC and given:
        try:
            return NUMERIC[function](*numbers)
        except (ValueError, TypeError, ZeroDivisionError, OverflowError):
            return None
    return _geometric(function, values, [float(number) for number in numbers])


def _geometric(function: str, values: list[Value], numbers: list[float]) -> Value | None:
    match function, values:
        case "rotation_zyx", [_, _, _] if len(numbers) == 3:
            return rigid.rotation_of_zyx(*numbers)
        case (("euler_x" | "euler_y" | "euler_z"), [rigid.Rotation() as rotation]):
            return rigid.quaternion_to_zyx(rotation.quaternion)["zyx".index(function[-1])]
        case "normalise", [rigid.Rotation() as rotation]:
            return rotation
        case "magnitude", [rigid.Vector() as vector]:
            return vector.length
        case "distance", [rigid.Vector() as one, rigid.Vector() as other]:
            return one.plus(other, -1.0).length
        case "dot", [rigid.Vector() as one, rigid.Vector() as other]:
            return one.dot(other)
        case "inverse", [one]:
            pose = pose_of(one)
            return pose.inverse if pose else None
        case "pose_of", [one]:
            return pose_of(one)
        case "compose", [one, other]:
            return _composition(one, other)
        case "transform", [rigid.Pose() as pose, rigid.Vector() as vector]:
            return pose.place(vector)
        case "frame_from_points", [rigid.Vector() as one, rigid.Vector() as two, rigid.Vector() as three, *_]:
            return _from_points(one, two, three, int(numbers[0]) if numbers else 1)
        case (("offset" | "tool_offset"), [rigid.Pose() | Target() as one, *_]) if len(numbers) == len(values) - 1:
            return moved(function, one, numbers)
        case (("displaced" | "displaced_in_tool"), [Target() as one, other]):
            shift = pose_of(other)
            if shift is None:
                return None
            return replace(one, pose=shift.then(one.pose) if function == "displaced" else one.pose.then(shift))
    return None


def _from_points(one: rigid.Vector, two: rigid.Vector, three: rigid.Vector, origin: int) -> rigid.Pose | None:
    """x from the first to the second point, y towards the third. Origin: 1 first point, 2 second, 3 the point of
    the line nearest to the third."""
    along = two.plus(one, -1.0)
    across = along.cross(three.plus(one, -1.0))
    if along.length < 1e-9 or across.length < 1e-9:
        return None
    x, z = along.times(1.0 / along.length), across.times(1.0 / across.length)
    y = z.cross(x)
    place = {2: two, 3: one.plus(x, three.plus(one, -1.0).dot(x))}.get(origin, one)
    return rigid.Pose(place, rigid.rotation_of_rows(((x.x, y.x, z.x), (x.y, y.y, z.y), (x.z, y.z, z.z))))


def moved(function: str, value: rigid.Pose | Target, numbers: list[float]) -> rigid.Pose | Target | None:
    """The pose or target moved by `offset` (x, y, z of its frame) or `tool_offset` (x, y, z of its own, then turns)."""
    pose = value.pose if isinstance(value, Target) else value
    shift = rigid.Vector(*numbers[:3]) if len(numbers) >= 3 else None
    if shift is None:
        return None
    if function == "offset":
        done = replace(pose, position=pose.position.plus(shift))
    else:
        x, y, z = (*numbers[3:], 0.0, 0.0, 0.0)[:3]
        done = pose.then(rigid.Pose(shift, rigid.NO_TURN))
        for angles in ((0.0, 0.0, x), (0.0, y, 0.0), (z, 0.0, 0.0)):
            if any(angles):
                done = done.then(rigid.Pose(rigid.IDENTITY.position, rigid.rotation_of_zyx(*angles)))
    return replace(value, pose=done) if isinstance(value, Target) else done


# ---- values written back


def real(value: float) -> ir.Expression:
    """A real literal without the noise of the last binary places."""
    return ir.RealLiteral(rigid.clean(value))


def literal(value: Value) -> ir.Expression | None:
    """An expression of that value: structures with named components, in the order of a positional aggregate."""
    match value:
        case bool():
            return ir.BoolLiteral(value)
        case int():
            return ir.IntLiteral(value)
        case float():
            return real(value)
        case str():
            return ir.TextLiteral(value)
        case Member():
            return ir.EnumLiteral(value.name)
        case rigid.Vector():
            return _written(ir.VectorType(), (("x", real(value.x)), ("y", real(value.y)), ("z", real(value.z))))
        case rigid.Rotation():
            names = ("q1", "q2", "q3", "q4")
            return _written(
                ir.RotationType(), tuple((n, real(q)) for n, q in zip(names, value.quaternion, strict=True))
            )
        case rigid.Pose(position=position, rotation=rotation):
            return _written(ir.PoseType(), _all((("trans", literal(position)), ("rot", literal(rotation)))))
        case Record(type=type, parts=parts):
            return _written(type, _all(tuple((name, literal(part)) for name, part in parts)))
        case tuple():
            return ir.Aggregate(_all(tuple((None, literal(part)) for part in value)))
    return None


def _written(type: ir.Type, entries: tuple[tuple[str | None, ir.Expression], ...]) -> ir.Aggregate:
    return ir.Aggregate(entries, type_name=type_word(type))


def _all(
    entries: tuple[tuple[str | None, ir.Expression | None], ...],
) -> tuple[tuple[str | None, ir.Expression], ...]:
    return tuple((name, value) for name, value in entries if value is not None)
