"""Timers that are read in whole units (KRL's milliseconds) beside a written number: how long they ran is compared.

`timer > 2000 ms` rounds nothing in what is written; the answer is at most half a unit of time away. Where the whole
number goes anywhere else it stays one. It stands in front of what looks for waits with a time limit.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import rewrite_for
from rpl.passes.legalise.stages import legalising

_ORDER = frozenset(("<", "<=", ">", ">="))
_TIMES = frozenset(("timer", "time"))
_ACTS_ON = frozenset(("Magnitude",))


@legalising(unless=lambda context: context.capabilities.carries_rules, sees=_ACTS_ON)
def whole_times(program: ir.Program, context: Context) -> ir.Program:
    """For all targets but the one that says everything as it is."""
    return rewrite_for(_ACTS_ON, program, _changed)


def _changed(node: object) -> object:
    match node:
        case ir.Binary(op=op, left=left, right=right) if op in _ORDER:
            one, other = _time(left, right), _time(right, left)
            return node if one is left and other is right else replace(node, left=one, right=other)
    return node


def _time(value: ir.Expression, other: ir.Expression) -> ir.Expression:
    match value, other:
        case (
            ir.Convert(how="round_half_away", operand=ir.Magnitude(value=ir.System(name=name)) as time),
            ir.IntLiteral() | ir.RealLiteral() | ir.Unary(operand=ir.IntLiteral() | ir.RealLiteral()),
        ) if name in _TIMES:
            return time
        case _, ir.Convert(how="real", operand=inner):
            return _time(value, inner)
        case ir.Convert(how="real", operand=inner), _:
            found = _time(inner, other)
            return value if found is inner else found
    return value


__all__ = ["whole_times"]
