"""Values in the units of V+: quantities, and values in base units, as plain numbers."""

from __future__ import annotations

from rpl import ir
from rpl.writing import numbers


def in_unit(value: ir.Expression, unit: str) -> ir.Expression:
    """A quantity, or a value in base units, in another unit."""
    match value:
        case ir.Quantity(value=inner, unit=own):
            return inner if own == unit else scaled(inner, ir.UNITS[own] / ir.UNITS[unit])
    return scaled(value, 1.0 / ir.UNITS[unit])


def scaled(value: ir.Expression, factor: float) -> ir.Expression:
    """`value * factor`; factors that are written out become one."""
    return numbers.scaled(value, factor, _product)


def _product(value: ir.Expression, factor: float) -> ir.Expression:
    match value:
        case ir.Binary(op="*", left=left, right=ir.RealLiteral() | ir.IntLiteral() as one):
            return scaled(left, one.value * factor)
    return numbers.times(value, factor)


__all__ = ["in_unit", "scaled"]
