"""How large a corner is, as far as the program says it before it runs."""

from __future__ import annotations

from rpl import ir
from rpl.passes.fold import constant, constant_number
from rpl.passes.scope import Scope
from rpl.passes.values import Record


def written_size(blend: ir.Blend | None, scope: Scope) -> float | None:
    """The size of a corner as far as it is known before the run, mm; 0 for a stop, None for another measure."""
    match blend:
        case ir.BlendDistance(distance=distance) if distance is not None:
            return constant_number(distance, scope)
        case ir.BlendZone(distance=distance) if distance is not None:
            return constant_number(distance, scope)
        case ir.BlendZone(zone=zone):
            value = constant(zone, scope)
            if not isinstance(value, Record):
                return None
            path = value.part("path")
            return 0.0 if value.part("stop") else float(path) if isinstance(path, int | float) else None
        case None | ir.BlendStop():
            return 0.0
    return None
