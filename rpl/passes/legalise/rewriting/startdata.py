"""Starting values for targets that declare no data: assignments at the start of the program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import INITIALISE, moving_entries, never_called, started_tasks
from rpl.passes.legalise.facts.usage import base_name, doing
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.source import NOWHERE

# So many assignments may stand in the routine that starts; more go into a routine of their own.
_INLINE = 8


def assigned_at_start(
    program: ir.Program,
    context: Context,
    assigns: Sequence[ir.Statement],
    declarations: tuple[ir.Declaration, ...] = (),
) -> ir.Program:
    """The program whose entries make these assignments first, with the routines that a person may start alone and that
    use such data; `declarations` are data that only they use."""
    if not assigns:
        return program
    entries = entries_of(program) | _using(program, assigns)
    first: ir.Body = tuple(assigns)
    modules = program.modules
    if len(first) > _INLINE or len(entries) > 1 or declarations:
        name = context.fresh(INITIALISE)
        routine = ir.Routine(name, declarations=declarations, body=first, scope="global")
        home = ir.Module(context.fresh("rpl_data"), modules[0].dialect, (), (routine,))
        modules, first = (*modules, home), (ir.CallRoutine(name),)
    modules = tuple(
        replace(
            module,
            routines=tuple(
                replace(routine, body=(*first, *routine.body)) if routine.name.lower() in entries else routine
                for routine in module.routines
            ),
        )
        for module in modules
    )
    return replace(program, modules=modules)


def _using(program: ir.Program, assigns: Sequence[ir.Statement]) -> set[str]:
    """Routines beside `main` that may be started alone and use, also by what they call, data that is set here."""
    places = [base_name(one.target) for one in assigns if isinstance(one, ir.Assign)]
    data = {name for name in places if name is not None}
    own = {one.name.lower() for module in program.modules for one in module.routines if one.origin is not NOWHERE}
    alone = moving_entries(program) & own - entries_of(program) - named_by_texts(program)
    return (
        alone & doing(program, lambda node: isinstance(node, ir.Name) and node.id.lower() in data) if alone else set()
    )


def entries_of(program: ir.Program) -> set[str]:
    """Routines that the program may be started with, folded: what is declared, `main`, else what nothing calls."""
    declared = {task.entry.lower() for task in program.tasks if task.kind == "motion"}
    declared |= {program.entry.lower()} - {""}
    names = {routine.name.lower() for module in program.modules for routine in module.routines}
    if declared & names:
        return declared & names
    beside = {task.entry.lower() for task in program.tasks} | started_tasks(program)
    uncalled = never_called(program) - beside
    uncalled = uncalled - named_by_texts(program) or uncalled
    if "main" in uncalled:
        return {"main"}
    return uncalled or set(list(names)[:1])
