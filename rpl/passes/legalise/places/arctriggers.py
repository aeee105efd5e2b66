"""Actions on the way of an arc that is written in parts: each goes to the part on which its place is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.passes.fold import Unchanged, constant_number
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.scope import Scope


def placeable(trigger: ir.Trigger, scope: Scope, unchanged: Unchanged) -> bool:
    """Is it known on which part its place is: at an end of the arc, or a constant way from it and no time beside?"""
    delay = 0.0 if trigger.delay is None else constant_number(plain(trigger.delay), scope, unchanged)
    return _way(trigger, scope, unchanged) is not None and (delay == 0.0 or _way(trigger, scope, unchanged) == 0.0)


def _way(trigger: ir.Trigger, scope: Scope, unchanged: Unchanged) -> float | None:
    if trigger.distance is None:
        return 0.0
    return constant_number(plain(trigger.distance), scope, unchanged)


def shared_out(
    triggers: Sequence[ir.Statement], parts: Sequence[ir.Statement], length: float, scope: Scope, unchanged: Unchanged
) -> ir.Body:
    """The parts (of the same length; `length`: of the whole arc, mm) with the triggers in front of theirs."""
    each = length / len(parts)
    given: list[list[ir.Statement]] = [[] for _ in parts]
    for one in triggers:
        if not isinstance(one, ir.Trigger):
            given[0].append(one)
            continue
        way = _way(one, scope, unchanged) or 0.0
        at_start = one.reference == "start"
        back = int(abs(way) / each) if (way > 0.0) == at_start else 0
        back = min(back, len(parts) - 1)
        rest = way - back * each if at_start else way + back * each
        moved = one if one.distance is None or not back else replace(one, distance=ir.RealLiteral(round(rest, 6)))
        given[back if at_start else len(parts) - 1 - back].append(moved)
    return tuple(one for before, part in zip(given, parts, strict=True) for one in (*before, part))


__all__ = ["placeable", "shared_out"]
