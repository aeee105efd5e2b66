"""Angles about z, new y, new z for targets that know only angles about z, new y, new x: a part of a pose by a function
brought along, a pose from such angles as a product of three poses (worked out where the angles are constant)."""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.passes import rigid
from rpl.passes.legalise.rewriting.formulas import composed, number

ZYZ_PARTS = ("zyz_yaw", "zyz_pitch", "zyz_roll")


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
