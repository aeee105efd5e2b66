"""Where the robot was when an interrupt came (KRL $POS_INT), for languages that do not keep it: the interrupt's routine
notes the place where it begins, before it brakes.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE

NOTED = code(
    "interrupt-place-noted",
    Severity.WARNING,
    "the target does not keep where the robot was when an interrupt came; {routine} notes the place when it begins,"
    " which is a little later",
)
# System variable -> what is read instead, the stem of the variable that keeps it.
_PLACES = {
    "interrupt_pose": ("actual_pose", "rpl_interrupted_at"),
    "interrupt_joints": ("actual_joints", "rpl_interrupted_joints"),
}


@legalising(sees=("system interrupt_pose", "system interrupt_joints"))
def interrupt_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such system variables, whose programs can have interrupts."""
    has = context.capabilities.system_variables
    asked = {
        node.name
        for node in walk_for({"System"}, program)
        if isinstance(node, ir.System) and node.name in _PLACES.keys() - has
    }
    handlers = _handlers(program)
    if not asked or not handlers:
        return program
    kept = {name: ir.Name(context.fresh(_PLACES[name][1])) for name in sorted(asked)}

    def change(node: object) -> object:
        return kept[node.name] if isinstance(node, ir.System) and node.name in kept else node

    def noted(routine: ir.Routine) -> ir.Routine:
        if routine.name.lower() not in handlers or not _asks(program, routine, asked):
            return rewrite(routine, change)
        if routine.body:
            first = next((one.origin for one in routine.body if one.origin is not NOWHERE), routine.origin)
            context.diagnostics.report(NOTED, first, routine=routine.name)
        notes = tuple(ir.Assign(place, ir.System(_PLACES[name][0])) for name, place in kept.items())
        return replace(routine, body=(*notes, *rewrite(routine, change).body))

    modules = [replace(one, routines=tuple(map(noted, one.routines))) for one in program.modules]
    first = modules[0]
    types: dict[str, ir.Type] = {
        "interrupt_pose": ir.TargetType(context.source),
        "interrupt_joints": ir.JointsType(),
    }
    data = tuple(ir.Variable(place.id, types[name], scope="global") for name, place in kept.items())
    home = ir.Module(context.fresh("rpl_interrupt"), first.dialect, data, task=first.task, public=True)
    return replace(program, modules=(*modules, home))


def _handlers(program: ir.Program) -> set[str]:
    """Routines that an interrupt calls, folded."""
    found: set[str] = set()
    for node in walk_for({"DeclareInterrupt", "ConnectInterrupt"}, *program.modules):
        match node:
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.ConnectInterrupt(routine=name):
                found.add(name.lower())
    return found


def _asks(program: ir.Program, routine: ir.Routine, asked: set[str]) -> bool:
    """Does the routine, what it calls, or the program behind it look at the place?"""
    below = called_below(program, {routine.name.lower()}) | {routine.name.lower()}
    readers = {
        one.name.lower()
        for module in program.modules
        for one in module.routines
        if any(isinstance(node, ir.System) and node.name in asked for node in walk(one))
    }
    return bool(readers & below) or not readers <= _reached_only(program)


def _reached_only(program: ir.Program) -> set[str]:
    """Routines of interrupts and what these call, folded."""
    return set(called_below(program, _handlers(program))) | _handlers(program)


__all__ = ["interrupt_places"]
