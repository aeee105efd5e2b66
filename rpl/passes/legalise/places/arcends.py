"""Where an arc by an angle ends, computed by the program itself: its start, its point on the way or its end are known
only in a run.

With u and v from the start to the point on the way and to the end, uu, vv, uv their products and D = uu*vv - uv*uv, the
point at an angle t from the start is start + p*u + q*v with
p = (1-cos t) * vv*(uu-uv) / 2D + sin t * vv / (2*sqrt D) and q = (1-cos t) * uu*(vv-uv) / 2D - sin t * uu / (2*sqrt D).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.values import real

COMPUTED = code(
    "arc-end-computed",
    Severity.WARNING,
    "the target's arcs have no angle; the program computes where this one of {angle:g} degrees ends",
    "look on the robot that the arc ends where it should",
)
_POSITION = ("x", "y", "z")
_PLACES = 9
Temporary = Callable[[str, ir.Type], ir.Name]


@dataclass(frozen=True, slots=True)
class _Sizes:
    """Variables: the products and sqrt(D)."""

    uu: ir.Name
    vv: ir.Name
    uv: ir.Name
    area: ir.Name


def computed_arc(
    move: ir.Move,
    places: tuple[tuple[ir.Expression, ir.Type], ...],
    angle: float,
    temporary: Temporary,
    count: int = 1,
    corner: ir.Blend | None = None,
) -> ir.Body:
    """The arc without its angle (deg) and what comes before it; `count` arcs of less than a turn each, which meet in
    such corners. `places`: where it begins, the point on the way and the end, in the same frame, with their types. They
    are kept first: a start that is read from the robot is read once."""
    number = ir.RealType()
    stems = ("begin", "through", "end_at")
    begin, through, end = (temporary(stem, type) for stem, (_, type) in zip(stems, places, strict=True))
    later = replace(move.origin, comments=())
    given = zip((begin, through, end), places, strict=True)
    steps: list[ir.Statement] = [ir.Assign(name, place, origin=move.origin) for name, (place, _) in given]
    uu, vv, uv, area = (temporary(stem, number) for stem in ("uu", "vv", "uv", "area"))
    sizes = _Sizes(uu, vv, uv, area)
    far = [_distance(*pair) for pair in ((begin, through), (begin, end), (through, end))]
    for size, length in zip((uu, vv, area), far, strict=True):
        steps += [ir.Assign(size, length), ir.Assign(size, _times(size, size))]
    steps.append(ir.Assign(uv, _half(ir.Binary("-", ir.Binary("+", uu, vv), area))))
    square = ir.Binary("-", _times(uu, vv), _times(uv, uv))
    steps.append(ir.Assign(area, ir.Builtin("sqrt", (square,))))
    goals = [
        _goal(angle * at / (2 * count), (begin, through, end), sizes, (f"arc_{at}", places[2][1]), temporary, steps)
        for at in range(1, 2 * count + 1)
    ]
    arcs = [
        replace(move, via=via, target=goal, swept=None, blend=move.blend if goal is goals[-1] else corner)
        for via, goal in zip(goals[::2], goals[1::2], strict=True)
    ]
    return tuple(one if at == 0 else replace(one, origin=later) for at, one in enumerate((*steps, *arcs)))


def _goal(
    angle: float,
    places: tuple[ir.Name, ir.Name, ir.Name],
    sizes: _Sizes,
    named: tuple[str, ir.Type],
    temporary: Temporary,
    steps: list[ir.Statement],
) -> ir.Name:
    """The point at an angle from the start, with the rotation of the end."""
    begin, through, end = places
    first, second = (temporary(stem, ir.RealType()) for stem in ("along_via", "along_end"))
    goal = temporary(*named)
    steps += [
        ir.Assign(first, _share(sizes.vv, sizes.uu, angle, sizes)),
        ir.Assign(second, _share(sizes.uu, sizes.vv, -angle, sizes)),
        ir.Assign(goal, end),
    ]
    for axis in _POSITION:
        ways = (_times(share, _way(begin, to, axis)) for share, to in ((first, through), (second, end)))
        value: ir.Expression = ir.Field(begin, axis)
        for way in ways:
            value = ir.Binary("+", value, way)
        steps.append(ir.Assign(ir.Field(goal, axis), value))
    return goal


def _share(factor: ir.Name, other: ir.Name, angle: float, sizes: _Sizes) -> ir.Expression:
    """How much of one way it is to the point at an angle."""
    turn = math.radians(angle)
    inner = ir.Binary("-", other, sizes.uv)
    over = _times(real(round((1.0 - math.cos(turn)) / 2.0, _PLACES)), ir.Binary("/", inner, sizes.area))
    whole = ir.Binary("+", over, real(round(math.sin(turn) / 2.0, _PLACES)))
    return _times(ir.Binary("/", factor, sizes.area), whole)


def _distance(one: ir.Name, other: ir.Name) -> ir.Expression:
    return ir.Builtin("distance", (ir.Field(one, "trans"), ir.Field(other, "trans")))


def _times(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    return ir.Binary("*", one, other)


def _half(value: ir.Expression) -> ir.Expression:
    return _times(real(0.5), value)


def _way(begin: ir.Name, to: ir.Name, axis: str) -> ir.Expression:
    return ir.Binary("-", ir.Field(to, axis), ir.Field(begin, axis))


__all__ = ["COMPUTED", "computed_arc"]
