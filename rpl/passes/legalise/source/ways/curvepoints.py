"""Spline blocks as curves through the same points, for targets that draw one through moves of the kind spline.

Controllers draw their own curve between the points. It is taken where it keeps to that of the source, else the block is
written as arcs along the latter (`splinearcs`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.curves import Segment
from rpl.passes.rigid import Vector

AS_POINTS = code(
    "spline-as-points",
    Severity.WARNING,
    "the target's own curve through the same {count} points is within {deviation:.3f} mm of the one that a run takes;"
    " neither controller's curve is published",
    "look on the robot that the path goes where it should between the points",
)
OTHER_CURVE = code(
    "spline-other-curve",
    Severity.WARNING,
    "the target's own curve through these points leaves the source's by {deviation:.3f} mm between them",
    "teach more points where the path has to keep to its curve",
)
# How far two controllers' curves through the same points may be from each other.
SAME_CURVE_MM = 0.05
_LOOKS = 16


def apart(ours: Sequence[Sequence[Segment]], theirs: Sequence[Sequence[Segment]]) -> float:
    """How far one curve is from the other beside its direction, mm; the segments of both have the same ends."""
    worst = 0.0
    for one, other in zip(
        (part for run in ours for part in run), (part for run in theirs for part in run), strict=True
    ):
        for look in range(1, _LOOKS):
            u = look / _LOOKS
            way = _place(one, u + 1e-4).plus(_place(one, u - 1e-4), -1.0)
            off = _place(other, u).plus(_place(one, u), -1.0)
            if way.length > 0.0:
                off = off.plus(way, -off.dot(way) / way.dot(way))
            worst = max(worst, off.length)
    return worst


def _place(segment: Segment, u: float) -> Vector:
    return segment.at(u).position


def through_points(spline: ir.Spline, begin: ir.Expression, moves: Sequence[ir.Move], parted: bool) -> ir.Body | None:
    """The moves of a block that has points of one curve alone, the first at its beginning. `parted`: a curve ends right
    there, of which that move would be one more point. None: there is more in the block than points."""
    others = [item for item in spline.body if not isinstance(item, ir.Move | ir.Nothing)]
    if others or any(move.kind != "spline" or move.orientation == "constant" for move in moves):
        return None
    stop = ir.BlendStop()
    later = replace(spline.origin, comments=())
    first = replace(moves[0], target=begin, blend=stop, motion_class="classic", origin=later)
    lead = (replace(first, kind="linear"),) if parted else ()
    points = [replace(move, blend=None, motion_class="classic") for move in moves]
    points[-1] = replace(points[-1], blend=spline.blend or stop)
    return (*lead, first, *points)


__all__ = ["AS_POINTS", "SAME_CURVE_MM", "OTHER_CURVE", "apart", "through_points"]
