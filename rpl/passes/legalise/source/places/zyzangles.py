"""Angles about z, new y, new z for targets that know only angles about z, new y, new x: a part of a pose by a function
brought along, a pose from such angles as a product of three poses (worked out where the angles are constant)."""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.passes import rigid
from rpl.passes.legalise.rewriting.library import composed, function, minus, number, part, plus, times

ZYZ_PARTS = ("zyz_yaw", "zyz_pitch", "zyz_roll")
# Below this sine of the pitch only the sum (or difference) of yaw and roll is known: yaw is 0.
_SMALL = 1e-6
_REAL, _POSE, _INT = ir.RealType(), ir.PoseType(), ir.IntType()
Typed = tuple[tuple[str, ir.Type], ...]


def zyz_pose(place: Sequence[ir.Expression], angles: Sequence[ir.Expression], known: Sequence[float]) -> ir.Expression:
    """The pose at x, y, z (mm) turned by yaw, pitch, roll (deg); `known` holds the angles when they are constants."""
    if len(known) == len(angles):
        yaw, pitch, roll = known
        turned = rigid.rotation_of_zyx(yaw, pitch, 0.0).then(rigid.rotation_of_zyx(roll, 0.0, 0.0)).zyx
        return _pose((*place, *(ir.RealLiteral(rigid.clean(angle)) for angle in turned)))
    zero = number(0)
    yaw_, pitch_, roll_ = angles
    return composed(
        _pose((*place, yaw_, pitch_, zero)),
        _pose((zero, zero, zero, roll_, zero, zero)),
    )


def _pose(values: Sequence[ir.Expression]) -> ir.Aggregate:
    return ir.Aggregate(tuple(zip(ir.POSE, values, strict=True)), "pose")


def zyz_part() -> tuple[Typed, ir.Type, Typed, ir.Body]:
    """Function (pose, 1..3): yaw, pitch or roll of a pose, from the elements of its rotation matrix."""
    halves: ir.Body = tuple(
        _set(f"{kind}{angle}", function(name, part("p", angle)))
        for angle in "abc"
        for kind, name in (("s", "sin"), ("c", "cos"))
    )
    sa, ca, sb, cb, sc, cc = (ir.Name(name) for name in ("sa", "ca", "sb", "cb", "sc", "cc"))
    xz, yz, zz, n = (ir.Name(name) for name in ("xz", "yz", "zz", "n"))
    level = plus(times(sa, sb, sc), times(ca, cc))
    cross = minus(times(ca, sb, sc), times(sa, cc))
    down = ir.Binary("<", zz, number(0))
    upright: ir.Body = (
        ir.If(
            ((ir.Binary("=", n, ir.IntLiteral(2)), (ir.If(((down, (_set("v", number(180)),)),)),)),
             (ir.Binary("=", n, ir.IntLiteral(3)), (
                 _set("v", function("atan2", ir.Unary("-", cross), level)),
                 ir.If(((down, (_set("v", function("atan2", cross, level)),)),)),
             ))),
        ),
    )  # fmt: skip
    inclined: ir.Body = (
        ir.If(
            (
                (ir.Binary("=", n, ir.IntLiteral(1)), (_set("v", function("atan2", yz, xz)),)),
                (ir.Binary("=", n, ir.IntLiteral(2)), (_set("v", function("atan2", ir.Name("l"), zz)),)),
            ),
            (_set("v", function("atan2", times(cb, sc), sb)),),
        ),
    )
    body: ir.Body = (
        *halves,
        _set("xz", plus(times(ca, sb, cc), times(sa, sc))),
        _set("yz", minus(times(sa, sb, cc), times(ca, sc))),
        _set("zz", times(cb, cc)),
        _set("l", function("sqrt", plus(times(xz, xz), times(yz, yz)))),
        _set("v", number(0)),
        ir.If(((ir.Binary("<", ir.Name("l"), number(_SMALL)), upright),), inclined),
        ir.Return(ir.Name("v")),
    )
    local = tuple((name, _REAL) for name in ("sa", "ca", "sb", "cb", "sc", "cc", "xz", "yz", "zz", "l", "v"))
    return (("p", _POSE), ("n", _INT)), _REAL, local, body


def _set(name: str, value: ir.Expression) -> ir.Assign:
    return ir.Assign(ir.Name(name), value)
