"""Variables that begin with their first value at each start of the program: KRL keeps them in data lists, where the
last value stays, so the program sets them when it starts.

Values that the source keeps too (persistent data) stay as the last run left them, and so does what the program sets
before it looks at it. The value in the list is written as well: it is what the data begins with.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import INITIALISE
from rpl.passes.legalise.facts.liveness import Names
from rpl.passes.legalise.facts.usage import base_name, usage_of
from rpl.passes.legalise.facts.values.firstreads import read_first
from rpl.passes.legalise.rewriting.startdata import entries_of
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE

# So many assignments may stand in the routine that starts; more go into a routine of their own.
_INLINE = 8


@legalising()
def begun_anew(program: ir.Program, context: Context) -> ir.Program:
    """Variables of data lists that the program assigns and may read before that. A task that
    does not move the robot sets its own."""
    entries = entries_of(program)
    background = {name for task in program.tasks if task.kind != "motion" for name in task.modules}
    beside = [one.name for module in program.modules if module.name in background for one in module.routines]
    assigned = _assigned(program)
    begins = read_first(program, assigned, entries, beside) if assigned else assigned
    modules: list[ir.Module] = []
    first: list[ir.Statement] = []
    for module in program.modules:
        own = () if module.name in background else _assignments(module, begins)
        if own and (len(own) > _INLINE or not (_seen_everywhere(module, own) or entries <= _holds(module))):
            name = context.fresh(INITIALISE)
            routine = ir.Routine(name, body=own, scope="global")
            module = replace(module, routines=(*module.routines, routine))
            first.append(ir.CallRoutine(name))
        else:
            first.extend(own)
        modules.append(module)
    if not first:
        return program
    for at, module in enumerate(modules):
        if module.name not in background:
            routines = tuple(
                replace(routine, body=(*first, *routine.body)) if routine.name.lower() in entries else routine
                for routine in module.routines
            )
            modules[at] = replace(module, routines=routines)
    return replace(program, modules=tuple(modules))


def _assigned(program: ir.Program) -> Names:
    """Variables of modules (folded) that statements assign, or that calls may change."""
    modules = tuple(replace(module, declarations=()) for module in program.modules)
    data = (one for module in program.modules for one in module.declarations if isinstance(one, ir.Variable))
    named = {one.name.lower() for one in data if one.storage == "variable"}
    return frozenset(named & usage_of(replace(program, modules=modules)).assigned)


def _holds(module: ir.Module) -> set[str]:
    return {routine.name.lower() for routine in module.routines}


def _seen_everywhere(module: ir.Module, assigns: ir.Body) -> bool:
    """Can routines of other modules set these data of the module?"""
    places = {base_name(one.target) for one in assigns if isinstance(one, ir.Assign)}
    return all(
        one.scope in ("task", "global")
        for one in module.declarations
        if isinstance(one, ir.Variable) and one.name.lower() in places
    )


def _assignments(module: ir.Module, begins: Names) -> ir.Body:
    """What gives those of the module's variables their first values."""
    here = {
        one.name.lower() for one in module.declarations if isinstance(one, ir.Variable) and one.storage == "variable"
    }
    made: list[ir.Statement] = []
    for one in module.declarations:
        match one:
            case ir.Variable(name=name, initial=initial) if initial is not None and name.lower() in begins & here:
                made.append(ir.Assign(ir.Name(name), initial))
            case ir.Initialise(assign=assign) if (base_name(assign.target) or "").lower() in begins & here:
                made.append(replace(assign, origin=NOWHERE))
    return tuple(made)


__all__ = ["begun_anew"]
