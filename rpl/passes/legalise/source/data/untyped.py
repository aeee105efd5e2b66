"""Routines without types, and handles that nothing uses.

A language whose parameters have no type (URScript) takes it from the calls. Of a routine that nothing calls the type of
a parameter may stay unknown; a target with types cannot declare it, and nothing would run it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.mentioned import mentioned
from rpl.passes.legalise.stages import legalising

NEVER_CALLED = code(
    "routine-never-called",
    Severity.WARNING,
    "{name} is called nowhere, and the type of {what} is known to no other language; it is left out",
    "call it once with an example of its values if the translation needs it",
)


@legalising()
def drop_untyped(program: ir.Program, context: Context) -> ir.Program:
    """The program without routines that nothing calls and whose data has a type of the source controller alone, and
    without handles of interrupts and path events that no statement mentions."""
    used = mentioned(program) | {program.entry.lower()} | {task.entry.lower() for task in program.tasks}
    modules = []
    for module in program.modules:
        kept = []
        for routine in module.routines:
            data: list[ir.Parameter | ir.Variable] = list(routine.parameters)
            data += [one for one in routine.declarations if isinstance(one, ir.Variable)]
            unknown = next((one.name for one in data if isinstance(one.type, ir.VendorType)), None)
            if unknown is None or routine.name.lower() in used:
                kept.append(routine)
            else:
                context.diagnostics.report(NEVER_CALLED, routine.origin, name=routine.name, what=unknown)
        kept = [replace(one, declarations=_without_handles(one.declarations, used, context)) for one in kept]
        declarations = _without_handles(module.declarations, used, context)
        modules.append(replace(module, declarations=declarations, routines=tuple(kept)))
    return replace(program, modules=tuple(modules))


def _without_handles(
    declarations: tuple[ir.Declaration, ...], used: set[str], context: Context
) -> tuple[ir.Declaration, ...]:
    """Without names of interrupts and path events that nothing uses and the target has no type for."""

    def idle(one: ir.Declaration) -> bool:
        if not isinstance(one, ir.Variable) or not isinstance(one.type, ir.InterruptType | ir.TriggerType):
            return False
        return one.type.__class__.__name__ not in context.capabilities.types and one.name.lower() not in used

    return tuple(one for one in declarations if not idle(one))


__all__ = ["drop_untyped"]
