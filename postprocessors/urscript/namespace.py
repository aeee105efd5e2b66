"""A whole program in one name space, as a script has it: what starts, and names that no longer hide each other.

A script is one `def`: its variables are global, and the routines inside see them. Data of the same name in two modules,
and the program's own variables that hide data, get names of their own.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from rpl import ir
from rpl.ir.walk import rewrite, walk

from .helpers import HELPERS

Node = TypeVar("Node")


def programs(program: ir.Program) -> list[ir.Routine]:
    """The routines that a script can start with: the entry by the rule of the command line, else every candidate."""
    routines = [routine for module in program.modules for routine in module.routines]
    wanted = program.entry or next((task.entry for task in program.tasks if task.kind == "motion"), "")
    for name in (wanted, "main"):
        found = [one for one in routines if name and one.name.lower() == name.lower() and _starts(one)]
        if found:
            return found[:1]
    busy = {task.entry.lower() for task in program.tasks}
    startable = [one for one in routines if _starts(one) and not _is_empty(one) and one.name.lower() not in busy]
    uncalled = [one for one in startable if one.name.lower() not in called_names(program, one)]
    named = [one for module in program.modules for one in module.routines if _like_its_file(module, one)]
    named = [one for one in named if any(one is other for other in startable)]
    for group in (named, [one for one in named if any(one is other for other in uncalled)], uncalled):
        if len(group) == 1:
            return group
    return uncalled or startable


def called_names(program: ir.Program, besides: ir.Routine | None = None) -> set[str]:
    """Routines that others call, start or are interrupted by, folded. `besides`: a routine whose own calls do not
    count."""
    routines = [routine for module in program.modules for routine in module.routines]
    return {name for routine in routines if routine is not besides for name in names_called_in(routine)}


def names_called_in(routine: ir.Routine) -> set[str]:
    """Routines that this one calls, starts or is interrupted by, folded."""
    names: set[str] = set()
    for node in walk(routine):
        match node:
            case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.ConnectInterrupt(routine=name):
                names.add(name.lower())
            case ir.TaskControl(task=name):
                names.add(name.lower())
    return names


def not_reached(program: ir.Program, others: list[ir.Routine]) -> list[ir.Routine]:
    """Those of these routines, which can be started, that nothing besides them leads to."""
    routines = [routine for module in program.modules for routine in module.routines]
    kept = [one for one in routines if not any(one is other for other in others)]
    named = {name for one in kept for name in names_called_in(one)}
    more = [one for one in others if one.name.lower() in named]
    return not_reached(program, [one for one in others if not any(one is found for found in more)]) if more else others


def _starts(routine: ir.Routine) -> bool:
    return routine.kind == "procedure" and all(parameter.optional for parameter in routine.parameters)


def _is_empty(routine: ir.Routine) -> bool:
    return all(isinstance(statement, ir.Nothing) for statement in routine.body)


def _like_its_file(module: ir.Module, routine: ir.Routine) -> bool:
    source = routine.origin.source or module.origin.source
    name = routine.name.lower()
    return name == module.name.lower() or (source is not None and name == source.name.lower())


# ---- names


def names_of(program: ir.Program) -> set[str]:
    """Every name that stands in the program."""
    names: set[str] = set()
    for node in walk(program):
        match node:
            case ir.Name(id=name):
                names.add(name)
            case _:
                other = getattr(node, "name", None)
                if isinstance(other, str):
                    names.add(other)
    return names


def one_namespace(program: ir.Program, start: ir.Routine | None) -> tuple[ir.Program, ir.Routine | None]:
    """The program with names that differ wherever they mean different things at the level of the script, the functions
    that the writer brings along included, and the routine that it starts with."""
    taken = names_of(program)
    own = {name for module in program.modules for name in _declared(module)}
    brought = {name: _free(name, taken) for name in sorted(own & HELPERS.texts.keys())}
    seen: set[str] = set()
    modules: list[ir.Module] = []
    first: ir.Routine | None = None
    for module in program.modules:
        changes = dict(brought)
        for name in _declared(module):
            if name in seen:
                changes[name] = _free(name, taken)
            seen.add(changes.get(name, name))
        at = next((i for i, one in enumerate(module.routines) if one is start), None)
        done = renamed(module, changes)
        modules.append(done)
        if at is not None:
            first = done.routines[at]
    if first is not None:
        hidden = {one.name for one in first.declarations if isinstance(one, ir.Variable)}
        hiding = {name: _free(name, taken) for name in sorted(hidden & seen)}
        if hiding:
            old, first = first, renamed(first, hiding)
            modules = [
                replace(module, routines=tuple(first if one is old else one for one in module.routines))
                for module in modules
            ]
    return replace(program, modules=tuple(modules)), first


def _declared(module: ir.Module) -> list[str]:
    """What a module brings to the script's level."""
    data = [one.name for one in module.declarations if isinstance(one, ir.Variable | ir.SignalDeclaration)]
    return list(dict.fromkeys((*data, *(routine.name for routine in module.routines))))


def _free(name: str, taken: set[str]) -> str:
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    taken.add(f"{name}_{number}")
    return f"{name}_{number}"


def renamed(node: Node, changes: dict[str, str]) -> Node:
    """The node with names exchanged, also those of parameters and variables of routines inside."""
    if not changes:
        return node

    def change(one: object) -> object:
        match one:
            case ir.Name(id=name) if name in changes:
                return replace(one, id=changes[name])
            case ir.For(counter=name) if name in changes:
                return replace(one, counter=changes[name])
            case ir.TaskControl(task=name) if name in changes:
                return replace(one, task=changes[name])
            case (
                ir.Variable(name=name)
                | ir.SignalDeclaration(name=name)
                | ir.Parameter(name=name)
                | ir.Routine(name=name)
                | ir.Call(name=name)
                | ir.CallRoutine(name=name)
            ) if name in changes:
                return replace(one, name=changes[name])
            case ir.Signal(name=str() as name) | ir.Argument(name=str() as name) if name in changes:
                return replace(one, name=changes[name])
        return one

    return rewrite(node, change)
