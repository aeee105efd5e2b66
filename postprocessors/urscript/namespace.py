"""A whole program in one name space, as a script has it: what starts, and names that no longer hide each other.

A script is one `def`: its variables are global, and the routines inside see them. Data of the same name in two modules,
and the program's own variables that hide data, get names of their own.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from rpl import ir
from rpl.ir.walk import rewrite

from .facts.programs import names_of
from .helpers import HELPERS

Node = TypeVar("Node")


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
