"""Zones beside which the tool turns: RAPID reduces a zone to the smallest of its sizes relative to the motion, and
other controllers do not. A corner that is to keep its size is written with an angle that does not reduce it.
"""

from __future__ import annotations

import math
from dataclasses import replace

from rpl import ir
from rpl.ir.columns import by_row, chosen
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.zones import NO_TURN, NO_WAY, Leg, Zone, with_zones
from rpl.passes.legalise.stages import legalising

_ROUNDING = 1e-6  # what rounding may add to a size, deg or thousandths


@legalising(unless=lambda context: "ZoneType" in rules_of(context.source).components)
def full_zones(program: ir.Program, context: Context) -> ir.Program:
    """Zones made of corners that have their size whatever the tool does keep it."""

    def change(zone: Zone, beside: list[Leg]) -> ir.Blend:
        value = zone.blend.zone
        old = dict(value.entries) if isinstance(value, ir.Aggregate) else {}
        if not isinstance(value, ir.Aggregate) or not {"path", "rotation", "rotation_path"} <= old.keys():
            return zone.blend
        needed = _needed(zone.path, tuple(leg.way for leg in beside), tuple(leg.turn for leg in beside))
        larger = _exceeds(needed, zone.rotation)
        new: dict[str | None, ir.Expression] = {
            "rotation": chosen(larger, ir.RealLiteral(_upwards(needed)), old["rotation"]),
            "rotation_path": chosen(larger, old["path"], old["rotation_path"]),
        }
        if all(new[name] is old[name] for name in new):
            return zone.blend
        entries = tuple((name, new.get(name, part)) for name, part in value.entries)
        return replace(zone.blend, zone=replace(value, entries=entries))

    return with_zones(program, change)


@by_row
def _needed(path: float, ways: tuple[float, ...], turns: tuple[float, ...]) -> float:
    """The angle by which the tool turns in the corner."""
    legs = zip(ways, turns, strict=True)
    return max((min(path / way, 0.5) * turn for way, turn in legs if way > NO_WAY and turn > NO_TURN), default=0.0)


@by_row
def _exceeds(angle: float, limit: float) -> float:
    return float(angle > limit + _ROUNDING)


@by_row
def _upwards(angle: float) -> float:
    return math.ceil(angle * 1000.0 - _ROUNDING) / 1000.0


__all__ = ["full_zones"]
