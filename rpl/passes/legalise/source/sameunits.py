"""Values in other units that go into one unit and out of it again: the controller's own value stands there instead.

Languages with radians and metres read `q[0] + 0.1` of joints as degrees turned into radians, a sum, and degrees again.
The value itself and the other terms in degrees are the same number, and read better in what is written.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising


@legalising(sees=("Magnitude",))
def same_units(program: ir.Program, context: Context) -> ir.Program:
    """For all targets."""
    return replace(program, modules=tuple(rewrite(module, _changed) for module in program.modules))


def _changed(node: object) -> object:
    match node:
        case ir.Quantity(value=value, unit=unit) if _measured(value, unit):
            return _plain(value, unit)
    return node


def _measured(value: ir.Expression, unit: str) -> bool:
    """Is the value, or a term of a sum, the measure of something in this unit?"""
    match value:
        case ir.Magnitude(unit=own):
            return own == unit
        case ir.Unary(op="-", operand=operand):
            return _measured(operand, unit)
        case ir.Binary(op="+" | "-", left=left, right=right):
            return _measured(left, unit) or _measured(right, unit)
    return False


def _plain(value: ir.Expression, unit: str) -> ir.Expression:
    match value:
        case ir.Magnitude(value=inner, unit=own) if own == unit:
            return inner
        case ir.Unary(op="-", operand=operand):
            return replace(value, operand=_plain(operand, unit))
        case ir.Binary(op="+" | "-", left=left, right=right):
            return replace(value, left=_plain(left, unit), right=_plain(right, unit))
    return ir.Quantity(value, unit)


__all__ = ["same_units"]
