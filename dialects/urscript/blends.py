"""Blends that overlap: the controller leaves out a move whose blend reaches into the next one (script manual, movej),
and says so only on its log. Here it is reported where the places are written out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code

OVERLAP = code(
    "urscript-overlapping-blends",
    Severity.WARNING,
    "this blend of {radius} m and that of the point beside it, {distance} m away, overlap",
    "the controller leaves such a move out; make the radius smaller",
)
_SLACK_M = 1e-6
Place = tuple[float, float, float]


def check_blends(body: ir.Body, given: Mapping[str, ir.Expression], diagnostics: Diagnostics) -> None:
    """Report overlapping blends of moves that follow each other. `given`: values of names that never change."""
    last: tuple[ir.Move, Place, float] | None = None
    for statement in body:
        if isinstance(statement, ir.Nothing):
            continue
        if not isinstance(statement, ir.Move) or statement.relative is not None:
            last = None
            continue
        place, radius = _place(statement.target, given), _radius(statement.blend)
        if place is None or radius is None:
            last = None
            continue
        if last is not None and last[2] > 0.0:
            distance = math.dist(last[1], place)
            if distance > _SLACK_M and last[2] + radius > distance + _SLACK_M:
                late = radius > 0.0  # the later one of two blends is left out, see rpl.runtime.moves.leftout
                told, size = (statement, radius) if late else (last[0], last[2])
                diagnostics.report(OVERLAP, told.origin, radius=f"{size:g}", distance=f"{distance:.4g}")
                if late:
                    continue
        last = (statement, place, radius)


def _radius(blend: ir.Blend | None) -> float | None:
    match blend:
        case ir.BlendDistance(distance=ir.Quantity(value=value)):
            return _number(value)
        case ir.BlendStop() | None:
            return 0.0
    return None


def _place(target: ir.Expression, given: Mapping[str, ir.Expression]) -> Place | None:
    if isinstance(target, ir.Name):
        known = given.get(target.id)
        return _place(known, {}) if known is not None else None
    if not isinstance(target, ir.Builtin) or target.function != "pose_from_rotation_vector":
        return None
    parts = [_number(part.value) for part in target.arguments[:3] if isinstance(part, ir.Quantity)]
    found = [part for part in parts if part is not None]
    return (found[0], found[1], found[2]) if len(found) == 3 else None


def _number(value: ir.Expression) -> float | None:
    return float(value.value) if isinstance(value, ir.IntLiteral | ir.RealLiteral) else None
