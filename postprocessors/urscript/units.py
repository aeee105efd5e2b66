"""Values in the units of URScript: a factor that is one through a whole number is written as a quotient."""

from __future__ import annotations

from rpl import ir
from rpl.writing import numbers


def scaled(value: ir.Expression, factor: float) -> ir.Expression:
    """`value * factor`, worked out when it is written as a number."""
    return numbers.scaled(value, factor, _product)


def _product(value: ir.Expression, factor: float) -> ir.Expression:
    inverse = 1.0 / factor
    if factor < 1.0 and abs(inverse - round(inverse)) < 1e-9 * inverse:
        return ir.Binary("/", value, ir.RealLiteral(float(round(inverse))))
    return numbers.times(value, factor)


__all__ = ["scaled"]
