"""Where an arc is halved, computed by the program from its three points.

With a, b, c the distances start-via, via-end and start-end, the arc's middle is
start + k*(via-start) + (1/2 - k*(a*a + c*c - b*b)/(2*c*c))*(end-start), k = c*c/(c*c - (a-b)*(a-b)): beside the middle
of the chord, on the via's side. With l the distance start-middle and f = l*l/(2*c*c + l*l), the point
(1-f)*middle + 2*f*start - f*end is on the first half, and the same from the end on the second.
"""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.passes.legalise.rewriting.library import function, minus, number, part, plus, times

_SHORT = 0.2  # twice the cosine of half the angle: an arc of less than about 169 degrees is short


def is_short(sizes: Sequence[str]) -> ir.Expression:
    """Is the arc clearly less than half a circle? `sizes` as measured by `split_points`."""
    a, b, c, _ = map(ir.Name, sizes)
    return ir.Binary(">", minus(minus(times(c, c), times(a, a)), times(b, b)), times(number(_SHORT), a, b))


def split_points(
    places: tuple[str, str, str], goals: tuple[str, str, str], sizes: Sequence[str]
) -> tuple[ir.Body, ir.Body]:
    """The steps that measure the arc, and those that put the positions of a point on the first half, the middle and a
    point on the second half into `goals`. `places`: start, via, end; `sizes`: four numbers for the results."""
    start, via, end = places
    before, middle, behind = goals
    a, b, c, share = map(ir.Name, sizes)
    measured = (
        ir.Assign(a, _distance(start, via)),
        ir.Assign(b, _distance(via, end)),
        ir.Assign(c, _distance(start, end)),
    )
    cc = times(c, c)
    skew = minus(a, b)
    chord = minus(plus(times(a, a), cc), times(b, b))
    steps: list[ir.Statement] = [
        ir.Assign(share, _over(chord, times(number(2.0), cc))),  # before b becomes k
        ir.Assign(b, _over(cc, minus(cc, times(skew, skew)))),
        ir.Assign(share, minus(number(0.5), times(b, share))),
    ]
    for axis in "xyz":
        s, v, e = (part(name, axis) for name in (start, via, end))
        steps.append(ir.Assign(part(middle, axis), plus(s, times(b, minus(v, s)), times(share, minus(e, s)))))
    steps.append(ir.Assign(a, _distance(start, middle)))
    aa = times(a, a)
    steps.append(ir.Assign(share, _over(aa, plus(times(number(2.0), cc), aa))))
    for axis in "xyz":
        s, m, e = (part(name, axis) for name in (start, middle, end))
        for goal, near, far in ((before, s, e), (behind, e, s)):
            out = times(share, minus(minus(plus(near, near), m), far))
            steps.append(ir.Assign(part(goal, axis), plus(m, out)))
    return measured, tuple(steps)


def _distance(one: str, other: str) -> ir.Expression:
    return function("distance", ir.Field(ir.Name(one), "trans"), ir.Field(ir.Name(other), "trans"))


def _over(value: ir.Expression, by: ir.Expression) -> ir.Expression:
    return ir.Binary("/", value, by)


__all__ = ["is_short", "split_points"]
