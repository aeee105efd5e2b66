"""Parameters that a routine does not look at, for targets whose calls have few arguments: routines with more of them
than a call may have lose those that nothing reads.

Records become a parameter for each component, and a routine often looks at two or three of these. An argument that
does something when it is worked out (a call) stays, and its parameter with it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from typing import TypeVar

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

_Call = ir.Call | ir.CallRoutine
_Item = TypeVar("_Item")


@legalising(unless=lambda context: not context.capabilities.routines.most_arguments)
def drop_unread_parameters(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with a limit on the arguments of a call."""
    most = context.capabilities.routines.most_arguments
    routines = [routine for module in program.modules for routine in module.routines]
    if all(len(routine.parameters) <= most for routine in routines):
        return program
    count = Counter(routine.name.lower() for routine in routines)
    nodes = list(walk_for({"Call", "CallRoutine", "TaskControl"}, *program.modules))
    if any(isinstance(node, ir.CallRoutine) and node.dynamic is not None for node in nodes):
        return program
    started = {node.task.lower() for node in nodes if isinstance(node, ir.TaskControl)}
    calls: dict[str, list[_Call]] = {}
    for node in nodes:
        if isinstance(node, _Call):
            calls.setdefault(node.name.lower(), []).append(node)
    dropped: dict[str, frozenset[int]] = {}
    for routine in routines:
        name = routine.name.lower()
        if len(routine.parameters) > most and count[name] == 1 and name not in started:
            places = _unread(routine, calls.get(name, []))
            if places:
                dropped[name] = places
    if not dropped:
        return program

    def shortened(node: object) -> object:
        match node:
            case ir.Call(name=name) | ir.CallRoutine(name=name) if name.lower() in dropped:
                kept = tuple(_without(node.arguments, dropped[name.lower()]))
                return replace(node, arguments=kept)
            case ir.Routine(name=name) if name.lower() in dropped:
                kept_parameters = tuple(_without(node.parameters, dropped[name.lower()]))
                return replace(node, parameters=kept_parameters)
        return node

    return rewrite(program, shortened)


def _without(items: Iterable[_Item], places: frozenset[int]) -> Iterable[_Item]:
    return (item for place, item in enumerate(items) if place not in places)


def _unread(routine: ir.Routine, calls: list[_Call]) -> frozenset[int]:
    """The places of parameters that can go."""
    seen = {node.id.lower() for node in walk(routine) if isinstance(node, ir.Name)}
    seen |= {node.counter.lower() for node in walk(routine) if isinstance(node, ir.For)}
    if any(isinstance(node, ir.Vendor | ir.VendorValue) for node in walk(routine)):
        return frozenset()
    if any(argument.name is not None for call in calls for argument in call.arguments):
        return frozenset()
    return frozenset(
        place
        for place, parameter in enumerate(routine.parameters)
        if parameter.name.lower() not in seen and not parameter.switch and all(_is_idle(call, place) for call in calls)
    )


def _is_idle(call: _Call, place: int) -> bool:
    """Does working out the argument at this place change nothing?"""
    value = call.arguments[place].value if place < len(call.arguments) else None
    return value is None or not any(isinstance(node, ir.Call | ir.Builtin | ir.VendorValue) for node in walk(value))


__all__ = ["drop_unread_parameters"]
