"""What a routine does with a location, with a parameter, and the numbers of its labels."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk


def filled(variable: ir.Variable, routine: ir.Routine) -> list[tuple[ir.Expression, ir.Type, ir.Expression]]:
    """A location that gets its components one by one begins as NULL."""
    name = ir.Name(variable.name)
    if not isinstance(variable.type, ir.PoseType | ir.TargetType):
        return []
    for node in walk(routine.body):
        match node:
            case ir.Assign(target=ir.Field(base=ir.Name(id=other))) if other.lower() == variable.name.lower():
                return [(name, variable.type, ir.System("null_frame"))]
    return []


def stores(routine: ir.Routine, name: str) -> bool:
    """May the routine change this parameter?"""
    key = name.lower()

    def is_it(place: object) -> bool:
        while isinstance(place, ir.Index | ir.Field):
            place = place.base
        return isinstance(place, ir.Name) and place.id.lower() == key

    for node in walk(routine.body):
        match node:
            case ir.Assign(target=target) if is_it(target):
                return True
            case ir.For(counter=counter) if counter.lower() == key:
                return True
            case ir.Dialog(answer=answer) if is_it(answer):
                return True
            case ir.Do(arguments=(first, *_)) if is_it(first):
                return True
            case ir.CallRoutine(arguments=arguments) if any(is_it(one.value) for one in arguments):
                return True
    return False


def labels_of(routine: ir.Routine) -> dict[str, str]:
    """A number for each label: its own where all are numbers, else 10, 20, ..."""
    names = [node.name.lower() for node in walk(routine.body) if isinstance(node, ir.Label)]
    if all(name.isdigit() for name in names):
        return {name: name for name in names}
    return {name: str(number * 10) for number, name in enumerate(dict.fromkeys(names), 1)}
