"""Formulas of numbers as people write them: factors are worked out, what is below zero is subtracted."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir

Product = Callable[[ir.Expression, float], ir.Expression]


def times(value: ir.Expression, factor: float) -> ir.Expression:
    """The product that nothing is known of."""
    return ir.Binary("*", value, ir.RealLiteral(float(f"{factor:.12g}")))


def scaled(value: ir.Expression, factor: float, product: Product = times) -> ir.Expression:
    """`value * factor`, worked out when the value is written as a number, with 12 digits. product: how the target says
    it of anything else."""
    if abs(factor - 1.0) < 1e-14:
        return value
    match value:
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return ir.RealLiteral(float(f"{number * factor:.12g}"))
        case ir.Unary(op="-", operand=ir.RealLiteral() | ir.IntLiteral() as literal):
            return ir.Unary("-", scaled(literal, factor))
        case ir.Convert(how="real", operand=operand):
            return scaled(operand, factor, product)
    return product(value, factor)


def added(value: ir.Expression, more: ir.Expression) -> ir.Expression:
    """`value + more`; what is below zero is subtracted."""
    match more:
        case ir.Unary(op="-", operand=less):
            return ir.Binary("-", value, less)
        case ir.IntLiteral(value=number) if number < 0:
            return ir.Binary("-", value, ir.IntLiteral(-number))
        case ir.RealLiteral(value=number) if number < 0:
            return ir.Binary("-", value, ir.RealLiteral(-number))
    return ir.Binary("+", value, more)


__all__ = ["added", "scaled", "times"]
