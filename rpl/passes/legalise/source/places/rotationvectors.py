"""Rotation vectors, ZYZ angles, and numbers counted in other units than the IR's, for targets that know neither.

A pose written with constants becomes its components (x, y, z, a, b, c); a computed one is made by a function brought
along, as are the parts of a rotation vector, interpolated poses and sums of poses. `Quantity` in metres or radians and
every `Magnitude` become plain arithmetic.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes import rigid
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.library import call, composed, function, minus, number, part, plus, times
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.source.places.zyzangles import ZYZ_PARTS, zyz_part, zyz_pose
from rpl.passes.legalise.stages import legalising

_REAL, _POSE, _INT = ir.RealType(), ir.PoseType(), ir.IntType()
_PARTS = ("rotation_vector_x", "rotation_vector_y", "rotation_vector_z")
_UNITS = ("m", "rad")
_SMALL = 1e-9
_HALF_RADIAN = 0.008726646259971648  # half a degree in rad


@legalising()
def rotation_vectors(program: ir.Program, context: Context) -> ir.Program:
    """The program without them, as far as the target lacks them."""
    worker = _Worker(context)
    done = rewrite(program, worker.changed)
    task = done.modules[0].task if done.modules else ""
    return with_support(done, context, (), worker.routines, task)


@dataclass(slots=True)
class _Worker:
    context: Context
    names: dict[str, str] = field(default_factory=dict)
    routines: list[ir.Routine] = field(default_factory=list)

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
        if name in _MAKERS:
            return self.made(name, *arguments)
        return node

    def made(self, name: str, *arguments: ir.Expression) -> ir.Call:
        """The call of the function brought along."""
        return call(self.name(name), *arguments)

    def name(self, key: str) -> str:
        if key not in self.names:
            name = self.names[key] = self.context.fresh(f"rpl_{key}")
            parameters, returns, locals, body = _MAKERS[key](self)
            variables = tuple(ir.Variable(one, type, scope="routine") for one, type in locals)
            given = tuple(ir.Parameter(one, type) for one, type in parameters)
            self.routines.append(ir.Routine(name, "function", given, returns, variables, body, scope="global"))
        return self.names[key]


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


# ---- functions brought along

Typed = tuple[tuple[str, ir.Type], ...]
Made = tuple[Typed, ir.Type, Typed, ir.Body]


def _all(names: str, type: ir.Type) -> Typed:
    return tuple((name, type) for name in names.split())


def _set(name: str, value: ir.Expression) -> ir.Assign:
    base, _, component = name.partition(".")
    return ir.Assign(part(base, component) if component else ir.Name(base), value)


def _v(names: str) -> list[ir.Expression]:
    return [ir.Name(name) for name in names.split()]


def _if(condition: ir.Expression, then: ir.Body, otherwise: ir.Body = ()) -> ir.If:
    return ir.If(((condition, then),), otherwise)


def _half(name: str, of: ir.Expression) -> ir.Builtin:
    return function(name, ir.Binary("/", of, number(2)))


def _from_vector(worker: _Worker) -> Made:
    """Quaternion of the vector, then its ZYX angles."""
    rx, ry, rz, t, s, w = _v("rx ry rz t s w")
    two, one = number(2), number(1)
    qx, qy, qz = _v("qx qy qz")
    body: ir.Body = (
        _set("t", function("sqrt", plus(times(rx, rx), times(ry, ry), times(rz, rz)))),
        _if(
            ir.Binary("<", t, number(_SMALL)),
            (_set("s", number(_HALF_RADIAN)),),
            (_set("s", ir.Binary("/", _half("sin", t), t)),),
        ),
        _set("w", _half("cos", t)),
        _set("qx", times(rx, s)),
        _set("qy", times(ry, s)),
        _set("qz", times(rz, s)),
        _set("h", times(two, minus(times(w, qy), times(qx, qz)))),
        _set("f", minus(one, times(two, plus(times(qy, qy), times(qz, qz))))),
        _set("g", times(two, plus(times(qx, qy), times(w, qz)))),
        _set("n", function("sqrt", plus(times(*_v("f f")), times(*_v("g g"))))),
        *(_set(f"p.{name}", ir.Name(name)) for name in ("x", "y", "z")),
        _set("p.b", function("atan2", ir.Name("h"), ir.Name("n"))),
        _if(
            ir.Binary("<", ir.Name("n"), number(_SMALL)),
            (
                _set(
                    "p.a",
                    function(
                        "atan2",
                        times(two, minus(times(w, qz), times(qx, qy))),
                        minus(one, times(two, plus(times(qx, qx), times(qz, qz)))),
                    ),
                ),
                _set("p.c", number(0)),
            ),
            (
                _set("p.a", function("atan2", ir.Name("g"), ir.Name("f"))),
                _set(
                    "p.c",
                    function(
                        "atan2",
                        times(two, plus(times(qy, qz), times(w, qx))),
                        minus(one, times(two, plus(times(qx, qx), times(qy, qy)))),
                    ),
                ),
            ),
        ),
        ir.Return(ir.Name("p")),
    )
    return _all("x y z rx ry rz", _REAL), _POSE, (*_all("t s w qx qy qz h f g n", _REAL), ("p", _POSE)), body


def _vector_part(worker: _Worker) -> Made:
    """Part 1, 2 or 3 of the rotation vector of a pose: the quaternion of its angles, then twice its angle."""
    halves: ir.Body = tuple(
        _set(f"{kind}{angle}", _half(name, part("p", angle)))
        for angle in "abc"
        for kind, name in (("s", "sin"), ("c", "cos"))
    )
    sa, ca, sb, cb, sc, cc = _v("sa ca sb cb sc cc")
    length = function("sqrt", plus(times(*_v("qx qx")), times(*_v("qy qy")), times(*_v("qz qz"))))
    negative: ir.Body = tuple(_set(name, ir.Unary("-", ir.Name(name))) for name in ("w", "qx", "qy", "qz"))
    body: ir.Body = (
        *halves,
        _set("w", plus(times(ca, cb, cc), times(sa, sb, sc))),
        _set("qx", minus(times(ca, cb, sc), times(sa, sb, cc))),
        _set("qy", plus(times(ca, sb, cc), times(sa, cb, sc))),
        _set("qz", minus(times(sa, cb, cc), times(ca, sb, sc))),
        _if(ir.Binary("<", ir.Name("w"), number(0)), negative),
        _set("l", length),
        _if(
            ir.Binary("<", ir.Name("l"), number(_SMALL)),
            (_set("s", number(1 / _HALF_RADIAN)),),
            (
                _set(
                    "s",
                    ir.Binary("/", times(number(2), function("atan2", ir.Name("l"), ir.Name("w"))), ir.Name("l")),
                ),
            ),
        ),
        ir.If(
            (
                (ir.Binary("=", ir.Name("n"), ir.IntLiteral(1)), (_set("v", times(*_v("qx s"))),)),
                (ir.Binary("=", ir.Name("n"), ir.IntLiteral(2)), (_set("v", times(*_v("qy s"))),)),
            ),
            (_set("v", times(*_v("qz s"))),),
        ),
        ir.Return(ir.Name("v")),
    )
    return (("p", _POSE), ("n", _INT)), _REAL, _all("sa ca sb cb sc cc w qx qy qz l s v", _REAL), body


def _vector_of(worker: _Worker, pose: str) -> list[ir.Expression]:
    name = worker.name("rotation_vector_part")
    return [call(name, ir.Name(pose), ir.IntLiteral(place)) for place in (1, 2, 3)]


def _between(one: str, other: str) -> ir.Expression:
    """The rotation that leads from one pose to the other."""
    return composed(function("inverse", ir.Name(one)), ir.Name(other))


def _interpolated(worker: _Worker) -> Made:
    turns: ir.Body = tuple(
        _set(name, times(one, ir.Name("n")))
        for name, one in zip(("rx", "ry", "rz"), _vector_of(worker, "d"), strict=True)
    )
    zero = number(0)
    turned = call(worker.name("pose_from_rotation_vector"), zero, zero, zero, *_v("rx ry rz"))
    body: ir.Body = (
        _set("d", _between("p", "q")),
        *turns,
        _set("d", turned),
        _set("d", composed(ir.Name("p"), ir.Name("d"))),
        *(
            _set(f"d.{name}", plus(part("p", name), times(minus(part("q", name), part("p", name)), ir.Name("n"))))
            for name in ("x", "y", "z")
        ),
        ir.Return(ir.Name("d")),
    )
    return (("p", _POSE), ("q", _POSE), ("n", _REAL)), _POSE, (("d", _POSE), *_all("rx ry rz", _REAL)), body


def _angle(worker: _Worker) -> Made:
    parts: ir.Body = tuple(
        _set(name, one) for name, one in zip(("rx", "ry", "rz"), _vector_of(worker, "d"), strict=True)
    )
    squares = [times(one, one) for one in _v("rx ry rz")]
    body: ir.Body = (_set("d", _between("p", "q")), *parts, ir.Return(function("sqrt", plus(*squares))))
    return (("p", _POSE), ("q", _POSE)), _REAL, (("d", _POSE), *_all("rx ry rz", _REAL)), body


def _summed(worker: _Worker) -> Made:
    sums = tuple(_set(f"d.{name}", plus(part("p", name), part("q", name))) for name in ("x", "y", "z"))
    body: ir.Body = (_set("d", composed(*_v("p q"))), *sums, ir.Return(ir.Name("d")))
    return (("p", _POSE), ("q", _POSE)), _POSE, (("d", _POSE),), body


def _subtracted(worker: _Worker) -> Made:
    rests = tuple(_set(f"d.{name}", minus(part("p", name), part("q", name))) for name in ("x", "y", "z"))
    body: ir.Body = (_set("d", _between("q", "p")), *rests, ir.Return(ir.Name("d")))
    return (("p", _POSE), ("q", _POSE)), _POSE, (("d", _POSE),), body


_MAKERS: dict[str, Callable[[_Worker], Made]] = {
    "pose_from_rotation_vector": _from_vector,
    "rotation_vector_part": _vector_part,
    "interpolate_pose": _interpolated,
    "rotation_angle": _angle,
    "zyz_part": lambda worker: zyz_part(),
    "pose_sum": _summed,
    "pose_difference": _subtracted,
}
