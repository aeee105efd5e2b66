"""Places for what passes have made, so that whatever is reported of it names a line of the source.

A made statement stands where the one before it in its routine does. A routine that passes have brought along (a
function that the target lacks) stands where the source first needs it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE, Origin

_Calls = tuple[tuple[Origin, str], ...]  # from where, which routine (folded)


@legalising()
def place_made_statements(program: ir.Program, context: Context) -> ir.Program:
    """Give statements that passes have made the place of those beside them or of the first call of their routine.

    The place is a point of the source without text: the original of a made statement is not another's.
    """
    if all(one.origin.source for routine in _routines(program) for one in _statements(routine)):
        return program
    firsts = {
        id(routine): next((one for one in map(_place, _statements(routine)) if one.source), NOWHERE)
        for routine in _routines(program)
    }
    needed = _needed(program, firsts)

    def placed(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        near = firsts[id(routine)]
        near = near if near.source else needed.get(routine.name.lower(), NOWHERE)

        def change(statement: ir.Statement) -> ir.Body:
            nonlocal near
            if statement.origin.source:
                near = _place(statement)
            elif near.source:
                statement = replace(statement, origin=replace(near, comments=statement.origin.comments))
            return (inside(statement, on_body),)

        def on_body(body: ir.Body) -> ir.Body:
            return map_body(body, change)

        return edit_bodies(routine, on_body)

    return edit_each(program, placed)


def _needed(program: ir.Program, firsts: dict[int, Origin]) -> dict[str, Origin]:
    """Where the source first needs each routine that has no place of its own: the place of a call of it, or of the
    routine that calls it."""
    calls = {routine.name.lower(): _calls(routine) for routine in _routines(program)}
    found: dict[str, Origin] = {}
    open_names = [routine.name.lower() for routine in _routines(program) if firsts[id(routine)].source]
    own = set(open_names)
    for caller in open_names:  # grows while it is followed
        for place, name in calls[caller]:
            at = place if place.source else found.get(caller, NOWHERE)
            if name in calls and name not in own and name not in found and at.source:
                found[name] = at
                open_names.append(name)
    return found


def _calls(routine: ir.Routine) -> _Calls:
    found: list[tuple[Origin, str]] = []
    near = NOWHERE

    def call(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Call):
            found.append((near, expression.name.lower()))

    for statement in _statements(routine):
        near = _place(statement) if statement.origin.source else near
        match statement:
            case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name) | ir.OnError(routine=str() as name):
                found.append((near, name.lower()))
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
                found.append((near, name.lower()))
        each_expression(statement, call)
    return tuple(found)


def _routines(program: ir.Program) -> list[ir.Routine]:
    return [routine for module in program.modules for routine in module.routines]


def _statements(routine: ir.Routine) -> list[ir.Statement]:
    return [one for body in bodies(routine) for one in statements_in(body)]


def _place(statement: ir.Statement) -> Origin:
    origin = statement.origin
    return Origin(origin.source, origin.start, origin.start)
