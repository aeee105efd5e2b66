"""Where a program may be started, what its calls lead to, and what runs beside the task that moves the robot."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Set
from dataclasses import replace
from itertools import chain

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.passes.legalise.kept import of_program
from rpl.passes.legalise.kinds import gathering, kinds_within, walk_for

INITIALISE = "rpl_initialise"  # what a routine is called that gives data their first values
_NONE: Set[str] = frozenset()
_TASKS = frozenset(("TaskControl",))
_WORD = re.compile(r"\w+(?:\.\w+)*")


def never_called(program: ir.Program) -> set[str]:
    """Procedures without parameters that no other routine calls, nor a text that it names: any of them may be where
    a program starts."""
    return set(_never_called(program))


@of_program
def _never_called(program: ir.Program) -> frozenset[str]:
    calls = calls_of(program)
    found = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if routine.kind == "procedure" and not routine.parameters and routine.scope != "module"
    }
    found = {name for name in found if not any(name in named for caller, named in calls.items() if caller != name)}
    return frozenset(found - named_by_texts(program) or found)


@of_program
def calls_of(program: ir.Program) -> Mapping[str, Set[str]]:
    """For each routine (folded) those that it calls, connects to interrupts or gives to triggers, also in a statement
    that was refused."""
    found: dict[str, set[str]] = {}
    names = {routine.name.lower() for module in program.modules for routine in module.routines}
    for module in program.modules:
        for routine in module.routines:
            called = found.setdefault(routine.name.lower(), set())
            for statement in chain(*bodies(routine)):
                called |= _called(statement)
                called |= _words(statement) & names
    return found


@gathering("Call", "CallRoutine", "ConnectInterrupt", "OnError", "DeclareInterrupt", "Trigger")
def _called(statement: ir.Statement) -> Iterator[str]:
    match statement:
        case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name) | ir.OnError(routine=str() as name):
            yield name.lower()
        case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
            yield name.lower()
    if "Call" in kinds_within(statement):
        found: list[str] = []
        each_expression(statement, lambda one: found.append(one.name.lower()) if isinstance(one, ir.Call) else None)
        yield from found


@gathering("Opaque")
def _words(statement: ir.Statement) -> list[str]:
    """The words of a statement that was refused."""
    return _WORD.findall(statement.text.lower()) if isinstance(statement, ir.Opaque) else []


def reached(start: str, calls: Mapping[str, Set[str]]) -> set[str]:
    """The routine and all that its calls lead to, folded."""
    found, open_names = {start}, [start]
    while open_names:
        new = calls.get(open_names.pop(), _NONE) - found
        found |= new
        open_names.extend(new)
    return found


def started_tasks(program: ir.Program) -> set[str]:
    """Routines that the program itself starts as tasks beside it, folded."""
    nodes = walk_for(_TASKS, *program.modules)
    return {node.task.lower() for node in nodes if isinstance(node, ir.TaskControl) and node.op == "start"}


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
