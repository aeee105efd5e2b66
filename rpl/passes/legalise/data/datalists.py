"""Assignments outside of routines (KRL data lists), for targets that know none: a routine that runs first makes them.

Values that a controller keeps in its data list between runs are set anew at each start of the program.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.heldtexts import named_by_texts
from rpl.passes.legalise.facts.usage import each_expression, each_statement
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
    entries, beside = moving_entries(program), _background(program)
    for at, module in enumerate(modules):
        if module.name in beside:
            continue
        routines = tuple(
            replace(routine, body=(*calls, *routine.body)) if routine.name.lower() in entries else routine
            for routine in module.routines
        )
        modules[at] = replace(module, routines=routines)
    return replace(program, modules=tuple(modules))


def never_called(program: ir.Program) -> set[str]:
    """Procedures without parameters that no other routine calls, nor a text that it names: any of them may be where
    a program starts."""
    calls = calls_of(program)
    found = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if routine.kind == "procedure" and not routine.parameters and routine.scope != "module"
    }
    found = {name for name in found if not any(name in named for caller, named in calls.items() if caller != name)}
    return found - named_by_texts(program) or found


def calls_of(program: ir.Program) -> dict[str, set[str]]:
    """For each routine (folded) those that it calls, connects to interrupts or gives to triggers."""
    found: dict[str, set[str]] = {}
    called: set[str] = set()

    def look(statement: ir.Statement) -> None:
        match statement:
            case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name) | ir.OnError(routine=str() as name):
                called.add(name.lower())
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
                called.add(name.lower())
        each_expression(statement, call)

    def call(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Call):
            called.add(expression.name.lower())

    for module in program.modules:
        for routine in module.routines:
            called = found.setdefault(routine.name.lower(), set())
            for body in bodies(routine):
                each_statement(body, look)
    return found


def reached(start: str, calls: dict[str, set[str]]) -> set[str]:
    """The routine and all that its calls lead to, folded."""
    found, open_names = {start}, [start]
    while open_names:
        new = calls.get(open_names.pop(), set()) - found
        found |= new
        open_names.extend(new)
    return found


def started_tasks(program: ir.Program) -> set[str]:
    """Routines that the program itself starts as tasks beside it, folded."""
    found: set[str] = set()

    def look(statement: ir.Statement) -> None:
        if isinstance(statement, ir.TaskControl) and statement.op == "start":
            found.add(statement.task.lower())

    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                each_statement(body, look)
    return found


def routines_beside(program: ir.Program) -> set[str]:
    """What background programs do, and all that they call, folded."""
    modules = _background(program)
    roots = {task.entry.lower() for task in program.tasks if task.kind != "motion" and not task.modules}
    roots |= {one.name.lower() for module in program.modules if module.name in modules for one in module.routines}
    calls = calls_of(program) if roots else {}
    return set().union(*(reached(root, calls) for root in roots))


def moving_entries(program: ir.Program) -> set[str]:
    """Where the task that moves the robot may start: the program's entry, and procedures that nothing calls, and that
    no other task runs."""
    beside, others = _background(program), routines_beside(program)
    foreground = replace(program, modules=tuple(one for one in program.modules if one.name not in beside))
    # A routine of a background module may have the name of one of the foreground (`main` of each of RAPID's tasks).
    others -= {one.name.lower() for module in program.modules if module.name in beside for one in module.routines}
    entry = {program.entry.lower()} if program.entry else set()
    return entry | never_called(foreground) - started_tasks(program) - others


def started_first(program: ir.Program) -> set[str]:
    """Where the program may be started, folded: what nothing calls and no task runs, but where there is only that."""
    roots = never_called(program)
    beside = started_tasks(program) | {task.entry.lower() for task in program.tasks if task.kind != "motion"}
    return roots - beside or roots


def _background(program: ir.Program) -> set[str]:
    """Modules of tasks that do not move the robot."""
    return {name for task in program.tasks if task.kind != "motion" for name in task.modules}
