"""Where a program may be started, what its calls lead to, and what runs beside the task that moves the robot."""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.facts.heldtexts import named_by_texts
from rpl.passes.legalise.facts.usage import each_expression, each_statement

INITIALISE = "rpl_initialise"  # what a routine is called that gives data their first values
_WORD = re.compile(r"\w+(?:\.\w+)*")


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
    """For each routine (folded) those that it calls, connects to interrupts or gives to triggers, also in a statement
    that was refused."""
    found: dict[str, set[str]] = {}
    called: set[str] = set()
    names = {routine.name.lower() for module in program.modules for routine in module.routines}

    def look(statement: ir.Statement) -> None:
        match statement:
            case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name) | ir.OnError(routine=str() as name):
                called.add(name.lower())
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
                called.add(name.lower())
            case ir.Opaque(text=text):
                called.update(names.intersection(_WORD.findall(text.lower())))
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
    modules = background(program)
    roots = {task.entry.lower() for task in program.tasks if task.kind != "motion" and not task.modules}
    roots |= {one.name.lower() for module in program.modules if module.name in modules for one in module.routines}
    calls = calls_of(program) if roots else {}
    return set().union(*(reached(root, calls) for root in roots))


def moving_entries(program: ir.Program) -> set[str]:
    """Where the task that moves the robot may start: the program's entry, and procedures that nothing calls, and that
    no other task runs."""
    beside, others = background(program), routines_beside(program)
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


def background(program: ir.Program) -> set[str]:
    """Modules of tasks that do not move the robot."""
    return {name for task in program.tasks if task.kind != "motion" for name in task.modules}
