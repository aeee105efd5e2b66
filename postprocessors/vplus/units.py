"""Values in the units of V+: quantities, and values in base units, as plain numbers."""

from __future__ import annotations

from rpl import ir


def in_unit(value: ir.Expression, unit: str) -> ir.Expression:
    """A quantity, or a value in base units, in another unit."""
    match value:
        case ir.Quantity(value=inner, unit=own):
            return inner if own == unit else scaled(inner, ir.UNITS[own] / ir.UNITS[unit])
    return scaled(value, 1.0 / ir.UNITS[unit])


def scaled(value: ir.Expression, factor: float) -> ir.Expression:
    """`value * factor`, worked out when it is written as a number."""
    if abs(factor - 1.0) < 1e-14:
        return value
    match value:
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return ir.RealLiteral(float(f"{number * factor:.12g}"))
        case ir.Unary(op="-", operand=ir.RealLiteral() | ir.IntLiteral() as one):
            return ir.Unary("-", scaled(one, factor))
        case ir.Convert(how="real", operand=operand):
            return scaled(operand, factor)
        case ir.Binary(op="*", left=left, right=ir.RealLiteral() | ir.IntLiteral() as one):
            return scaled(left, one.value * factor)
    return ir.Binary("*", value, ir.RealLiteral(float(f"{factor:.12g}")))


__all__ = ["in_unit", "scaled"]
