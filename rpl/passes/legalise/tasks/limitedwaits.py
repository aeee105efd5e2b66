"""Functions that wait for a condition and no longer than a time, and say whether it came: what they look at.

Languages whose waits have no time limit (URScript) write such a function once and call it everywhere. It looks in each
pass of a loop, counts the passes, and gives a truth: true where the condition came, false where the time ran out.
"""

from __future__ import annotations

from collections.abc import Mapping

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.rewriting.editing import negation
from rpl.passes.legalise.settings.movesettings import plain

_LONGEST_LOOK = 0.1  # s


def looked_for(call: ir.Call, routines: Mapping[str, ir.Routine]) -> ir.Expression | None:
    """The condition that a call waits for, with its arguments in it; None when the routine is something else."""
    routine = routines.get(call.name.lower())
    if routine is None or len(call.arguments) != len(routine.parameters):
        return None
    body = [one for one in routine.body if not isinstance(one, ir.Nothing)]
    counters = {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}
    while body and isinstance(body[0], ir.Assign) and _is_name(body[0].target, counters):
        body.pop(0)
    match body:
        case [ir.While(condition=going, body=inner), ir.Return(value=ir.BoolLiteral(value=after))]:
            pass
        case _:
            return None
    found = negation(going) if after else None
    for one in inner:
        match one:
            case ir.Nothing():
                continue
            case ir.If(branches=((asked, (ir.Return(value=ir.BoolLiteral(value=given)),)),), otherwise=()):
                if given == after or (given and found is not None):
                    return None
                found = asked if given else found
            case ir.Assign(target=target) if _is_name(target, counters):
                continue
            case ir.Wait(time=time) if _short(time):
                continue
            case _:
                return None
    if found is None or _names(found) & counters or any(isinstance(node, ir.Call) for node in walk(found)):
        return None
    return _filled(found, routine, call)


def _filled(condition: ir.Expression, routine: ir.Routine, call: ir.Call) -> ir.Expression | None:
    given: dict[str, ir.Expression] = {}
    for parameter, argument in zip(routine.parameters, call.arguments, strict=True):
        if argument.value is None or argument.name is not None:
            return None
        given[parameter.name.lower()] = argument.value

    def change(node: object) -> object:
        match node:
            case ir.Name(id=name):
                return given.get(name.lower(), node)
            case ir.Binary("+", ir.IntLiteral(value=one), ir.IntLiteral(value=other)):  # the number of a signal
                return ir.IntLiteral(one + other)
            case ir.Binary("=", left, ir.BoolLiteral(True)):
                return left
        return node

    return rewrite(condition, change)


def _short(time: ir.Expression) -> bool:
    value = plain(time)
    return isinstance(value, ir.RealLiteral | ir.IntLiteral) and value.value <= _LONGEST_LOOK


def _is_name(target: ir.Expression, names: set[str]) -> bool:
    return isinstance(target, ir.Name) and target.id.lower() in names


def _names(condition: ir.Expression) -> set[str]:
    return {node.id.lower() for node in walk(condition) if isinstance(node, ir.Name)}


__all__ = ["looked_for"]
