"""A time before the end of a straight move as the way left then, where the target counts such a time otherwise."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.saidaccelerations import number_of
from rpl.passes.legalise.rewriting.formulas import function, minus, number, plain, times

_USUAL_MM_S2 = 5000.0  # path acceleration where the target's rules name none


def by_way(trigger: ir.Trigger, move: ir.Move, fast: ir.Expression, context: Context) -> ir.Trigger:
    """The early action by its distance from the end, `fast` being the speed in mm/s: the move brakes evenly from its
    speed where it stops there, or goes on with it into a corner or to a place farther from the end."""
    seconds = -(_number_with_sign(trigger.delay) or 0.0)
    rate, known = _path_acceleration(move, context), number_of(fast)
    before = ir.RealLiteral(0.0) if trigger.distance is None else plain(trigger.distance)
    distance = _number_with_sign(before)
    brakes = isinstance(move.blend, ir.BlendStop | None) and distance == 0.0
    way: ir.Expression
    if known is not None:
        reached = min(known, rate * seconds) if brakes else known
        length = reached * seconds - (reached * reached / (2.0 * rate) if brakes else 0.0)
        if distance is not None:
            return replace(trigger, delay=None, distance=number(float(f"{distance - length:.9g}")))
        way = number(float(f"{length:.9g}"))
    elif brakes:
        reaches = function("min", fast, number(rate * seconds))
        way = times(reaches, minus(number(seconds), ir.Binary("/", reaches, number(2.0 * rate))))
    else:
        way = times(fast, number(seconds))
    if distance == 0.0:
        return replace(trigger, delay=None, distance=ir.Unary("-", way))
    return replace(trigger, delay=None, distance=minus(before, way))


def _path_acceleration(move: ir.Move, context: Context) -> float:
    """In mm/s2, what the move says or the target's controller usually has."""
    speed = move.speed
    own = number_of(speed.path_acceleration) if speed is not None else None
    rate = own or float(rules_of(context.target).system_defaults.get("path_acceleration", _USUAL_MM_S2))
    percent = None if move.acceleration is None else number_of(move.acceleration)
    return rate if not percent else rate * percent / 100.0


def _number_with_sign(value: ir.Expression | None) -> float | None:
    """A number that is written there, in base units, with its sign."""
    match value:
        case ir.Unary(op="-", operand=operand):
            inner = _number_with_sign(operand)
            return None if inner is None else -inner
        case ir.Quantity(value=inner_value, unit=unit):
            inner = _number_with_sign(inner_value)
            return None if inner is None else inner * ir.UNITS[unit]
    return number_of(value)


__all__ = ["by_way"]
