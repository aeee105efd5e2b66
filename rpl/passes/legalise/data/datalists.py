"""Assignments outside of routines (KRL data lists), for targets that know none: a routine that runs first makes them.

Values that a controller keeps in its data list between runs are set anew at each start of the program.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import background, moving_entries
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE

SET_AT_START = code(
    "data-set-at-start",
    Severity.INFO,
    "data that the source keeps in its data list is set by {name} at each start of the program",
)


@legalising(unless=lambda context: DataRule.LISTS in context.capabilities.data.rules)
def set_data_at_start(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose data cannot be set outside of routines."""
    modules: list[ir.Module] = []
    calls: list[ir.Statement] = []
    for module in program.modules:
        assigns = tuple(one.assign for one in module.declarations if isinstance(one, ir.Initialise))
        if not assigns:
            modules.append(module)
            continue
        name = context.fresh("rpl_initialise")  # beside its data, which may be local to the module
        context.diagnostics.report(SET_AT_START, NOWHERE, name=name)
        calls.append(ir.CallRoutine(name))
        kept = tuple(one for one in module.declarations if not isinstance(one, ir.Initialise))
        routine = ir.Routine(name, body=assigns, scope="global")
        modules.append(replace(module, declarations=kept, routines=(*module.routines, routine)))
    if not calls:
        return program
    entries, beside = moving_entries(program), background(program)
    for at, module in enumerate(modules):
        if module.name in beside:
            continue
        routines = tuple(
            replace(routine, body=(*calls, *routine.body)) if routine.name.lower() in entries else routine
            for routine in module.routines
        )
        modules[at] = replace(module, routines=routines)
    return replace(program, modules=tuple(modules))
