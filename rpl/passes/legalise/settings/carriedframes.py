"""Frames that a mechanism carries (a work object on a turn-table), for targets whose moves name no work objects.

Where the target can put its modal frame on a mechanism, it is set together with the mechanism's name; the others report
the loss by its name, and the program stops in front of the move: driven as if the table stood, it would go elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.settingwords import UNIT
from rpl.source import Origin

CARRIED_FRAME = code(
    "carried-frame-lost",
    Severity.LOSS,
    "the target has no frame on another mechanism; '{unit}' carries this one",
    "the program stops there; write the move by hand",
)
_BOTH = "carried frame"  # a frame and its mechanism as one value, while moves are compared

Component = Callable[[ir.Expression, str], ir.Expression]


def unit_of(frame: ir.Expression, component: Component) -> str | None:
    """The name of the mechanism that carries constant work object data; None where they stand in the room."""
    fixed, unit = component(frame, "fixed"), component(frame, "unit")
    if not isinstance(fixed, ir.BoolLiteral) or fixed.value or not isinstance(unit, ir.TextLiteral):
        return None
    held = component(frame, "held")
    if isinstance(held, ir.BoolLiteral) and held.value:
        return None
    return unit.value.strip() or None


def is_lost(unit: str | None, context: Context) -> bool:
    """Can the target not say so?"""
    return unit is not None and UNIT not in context.capabilities.system_variables


def both(frame: ir.Expression, unit: str | None, context: Context) -> ir.Expression:
    """Frame and mechanism as one setting."""
    if unit is None or is_lost(unit, context):
        return frame
    return ir.Call(_BOTH, (ir.Argument(frame), ir.Argument(ir.TextLiteral(unit))))


def assignments(value: ir.Expression, origin: Origin) -> list[ir.Statement] | None:
    """The statements that set frame and mechanism; None for an ordinary frame."""
    if not isinstance(value, ir.Call) or value.name != _BOTH:
        return None
    given = [argument.value for argument in value.arguments]
    names = ("base", UNIT)
    return [
        ir.Assign(ir.System(name), one, origin=origin)
        for name, one in zip(names, given, strict=True)
        if one is not None
    ]


__all__ = ["CARRIED_FRAME", "assignments", "both", "is_lost", "unit_of"]
