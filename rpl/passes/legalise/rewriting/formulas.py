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
