"""Zones beside which the tool turns, from a controller that reduces them (RAPID zonedata) for those that do not.

A controller with zones reduces them to the smallest of their sizes relative to the motion: where the tool turns far on
a short way, the corner is smaller than the zone says. Elsewhere a corner has its size whatever the tool does. So a
reduced zone is written with the size that it has. Only what stands in constants can be told.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.zones import NO_WAY, Leg, Zone, with_zones
from rpl.passes.legalise.stages import legalising

REDUCED = code(
    "zone-reduced",
    Severity.INFO,
    "the tool turns so far beside this point that the controller reduces the zone of {path:g} mm to {size:g} mm; it is"
    " written so",
)
EXTENDED = code(
    "zone-of-tool-lost",
    Severity.INFO,
    "the tool begins to turn {extended:g} mm before this point and the path is left {path:g} mm before it: the target"
    " does both at once",
)
# Smaller turns (degrees) beside a zone make no difference worth telling.
_TOLD_TURN = 1.0


@legalising(
    unless=lambda context: (
        "ZoneType" in context.capabilities.types or "ZoneType" not in rules_of(context.source).components
    )
)
def reduced_zones(program: ir.Program, context: Context) -> ir.Program:
    """For targets without zones: zones have the size to which the source's controller reduces them."""
    told: set[str] = set()

    def change(zone: Zone, beside: list[Leg]) -> ir.Blend:
        limits = [limit for leg in beside for limit in leg.limits(zone)]
        size = min(limits, default=zone.path)
        if size < zone.path - 1e-6:
            size = float(f"{size:.6g}")
            context.diagnostics.report(REDUCED, zone.move.origin, path=zone.path, size=size)
            return replace(zone.blend, distance=ir.RealLiteral(size))
        larger = size > zone.path + 1e-6 and not told
        if larger and any(leg.turn > _TOLD_TURN for leg in beside if leg.way > NO_WAY):
            told.add("extended")
            context.diagnostics.report(EXTENDED, zone.move.origin, extended=float(f"{size:.6g}"), path=zone.path)
        return zone.blend

    return with_zones(program, change)


__all__ = ["reduced_zones"]
