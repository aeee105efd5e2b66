"""Formulas of the IR in short: numbers, sums and products, functions, products of poses, components."""

from __future__ import annotations

from rpl import ir


def number(value: float) -> ir.Expression:
    return ir.RealLiteral(float(value))


def call(name: str, *arguments: ir.Expression) -> ir.Call:
    """A call with positional arguments."""
    return ir.Call(name, tuple(ir.Argument(value) for value in arguments))


def plus(*terms: ir.Expression) -> ir.Expression:
    return _chain("+", terms)


def minus(left: ir.Expression, right: ir.Expression) -> ir.Expression:
    return ir.Binary("-", left, right)


def times(*factors: ir.Expression) -> ir.Expression:
    return _chain("*", factors)


def composed(*poses: ir.Expression) -> ir.Expression:
    """The product of poses from left to right."""
    return _chain(":", poses)


def function(name: str, *arguments: ir.Expression) -> ir.Builtin:
    return ir.Builtin(name, arguments)


def part(base: str, name: str) -> ir.Field:
    return ir.Field(ir.Name(base), name)


def _chain(op: str, parts: tuple[ir.Expression, ...]) -> ir.Expression:
    done = parts[0]
    for one in parts[1:]:
        done = ir.Binary(op, done, one)
    return done


def plain(value: ir.Expression) -> ir.Expression:
    """A quantity as a number in base units."""
    match value:
        case ir.Quantity(value=inner, unit=unit):
            factor = ir.UNITS[unit]
            match inner:
                case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
                    return ir.RealLiteral(float(f"{number * factor:.12g}"), origin=inner.origin)
            return inner if factor == 1.0 else ir.Binary("*", inner, ir.RealLiteral(factor))
        case ir.IntLiteral(value=number):
            return ir.RealLiteral(float(number), origin=value.origin)
    return value
