"""Rotation vectors, ZYZ angles, and numbers counted in other units than the IR's, for targets that know neither.

A pose written with constants becomes its components (x, y, z, a, b, c); a computed one is made by a function brought
along, as are the parts of a rotation vector, interpolated poses and sums of poses. `Quantity` in metres or radians and
every `Magnitude` become plain arithmetic.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rpl import ir
from rpl.passes import rigid
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import rewrite_for
from rpl.passes.legalise.rewriting.formulas import number
from rpl.passes.legalise.rewriting.library import Library
from rpl.passes.legalise.source.places.zyzangles import ZYZ_PARTS, zyz_pose
from rpl.passes.legalise.stages import legalising

_PARTS = ("rotation_vector_x", "rotation_vector_y", "rotation_vector_z")
_UNITS = ("m", "rad")
_MADE = frozenset(
    ("interpolate_pose", "rotation_angle", "pose_sum", "pose_difference", "rotation_vector_part", "zyz_part")
)
_SMALL = 1e-9


_ACTS_ON = frozenset(("Quantity", "Magnitude", "Builtin"))


@legalising(sees=_ACTS_ON)
def rotation_vectors(program: ir.Program, context: Context) -> ir.Program:
    """The program without them, as far as the target lacks them."""
    worker = _Worker(context, Library(context, ("geometry",)))
    done = rewrite_for(_ACTS_ON, program, worker.changed)
    task = done.modules[0].task if done.modules else ""
    return worker.library.added_to(done, task)


@dataclass(slots=True)
class _Worker:
    context: Context
    library: Library

    def changed(self, node: object) -> object:
        match node:
            case ir.Quantity(value=value, unit=unit) if unit in _UNITS:
                return _scaled(value, ir.UNITS[unit])
            case ir.Magnitude(value=value, unit=unit) if not isinstance(value, ir.System):
                return ir.Binary("/", value, number(ir.UNITS[unit]), origin=node.origin)
            case ir.Builtin(function=name, arguments=arguments):
                if name in self.context.capabilities.functions:
                    return node
                return self.function(node, name, arguments)
        return node

    def function(self, node: ir.Builtin, name: str, arguments: tuple[ir.Expression, ...]) -> object:
        if name == "pose_from_rotation_vector":
            return _pose(arguments) or self.made(name, *arguments)
        if name in _PARTS:
            of = _posed(arguments[0])
            return node if of is None else self.made("rotation_vector_part", of, ir.IntLiteral(_PARTS.index(name) + 1))
        if name == "pose_zyz":
            known = [one for one in map(_number, arguments[3:]) if one is not None]
            return zyz_pose(arguments[:3], arguments[3:], known)
        if name in ZYZ_PARTS:
            return self.made("zyz_part", *arguments, ir.IntLiteral(ZYZ_PARTS.index(name) + 1))
        if name == "pose_sum" and (shifted := _shifted(*arguments)) is not None:
            return shifted
        if name in _MADE:
            return self.made(name, *arguments)
        return node

    def made(self, name: str, *arguments: ir.Expression) -> ir.Call:
        """The call of the function brought along."""
        return self.library.call(f"rpl_{name}", *arguments)


def _scaled(value: ir.Expression, factor: float) -> ir.Expression:
    plain = _number(value)
    if plain is not None:
        return ir.RealLiteral(rigid.clean(plain * factor), origin=value.origin)
    return ir.Binary("*", value, number(factor), origin=value.origin)


def _number(value: ir.Expression) -> float | None:
    match value:
        case ir.IntLiteral(value=plain) | ir.RealLiteral(value=plain):
            return float(plain)
        case ir.Unary(op="-", operand=operand):
            inner = _number(operand)
            return None if inner is None else -inner
    return None


def _pose(arguments: tuple[ir.Expression, ...]) -> ir.Aggregate | None:
    """The pose in components, when its rotation is written out."""
    vector = [_number(one) for one in arguments[3:]]
    known = [one for one in vector if one is not None]
    if len(known) < len(vector):
        return None
    angles = _angles(known)
    turned = [ir.RealLiteral(rigid.clean(angle)) for angle in angles]
    return ir.Aggregate(tuple(zip(ir.POSE, (*arguments[:3], *turned), strict=True)), "pose")


def _shifted(one: ir.Expression, other: ir.Expression) -> ir.Expression | None:
    """The sum of two poses of which one does not turn: the other one is shifted in its frame."""
    for shift, place in ((one, other), (other, one)):
        parts = dict(shift.entries) if isinstance(shift, ir.Aggregate) else {}
        if set(ir.POSE) <= set(parts) and all(_number(parts[name]) == 0.0 for name in ir.ANGLES):
            return ir.Builtin("offset", (place, *(parts[name] for name in ("x", "y", "z"))))
    return None


def _angles(vector: list[float]) -> tuple[float, float, float]:
    """ZYX angles of a rotation vector, degrees."""
    angle = math.hypot(*vector)
    if angle < _SMALL:
        return 0.0, 0.0, 0.0
    share = math.sin(math.radians(angle / 2)) / angle
    rotation = rigid.rotation_of_quaternion(math.cos(math.radians(angle / 2)), *(one * share for one in vector))
    return rotation.zyx if rotation is not None else (0.0, 0.0, 0.0)


def _posed(rotation: ir.Expression) -> ir.Expression | None:
    """A pose that has this rotation."""
    match rotation:
        case ir.Field(base=base, name="rot"):
            return base
        case ir.Builtin(function="rotation_zyx", arguments=(a, b, c)):
            zero = number(0)
            return ir.Aggregate(tuple(zip(ir.POSE, (zero, zero, zero, a, b, c), strict=True)), "pose")
    return None
