"""A whole program in one name space: V+ shares programs and variables among all files, without regard to case.

Data and programs of the same name in two modules get names of their own; so do variables whose sign alone differs.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.writing.target import WriteContext

from .. import tables
from ..facts.names import names_of

Node = TypeVar("Node")


def one_namespace(program: ir.Program, context: WriteContext) -> ir.Program:
    """The program with names that differ wherever they mean different things for all programs."""
    taken = names_of(program)
    seen: set[str] = set()
    modules = []
    for module in program.modules:
        changes: dict[str, str] = {}
        data = [one.name for one in module.declarations if isinstance(one, ir.Variable | ir.SignalDeclaration)]
        for name in dict.fromkeys(one.lower() for one in (*data, *(routine.name for routine in module.routines))):
            if name in seen:
                changes[name] = _free(name, taken)
            seen.add(changes.get(name, name))
        modules.append(_renamed(module, changes))
    return replace(program, modules=tuple(modules))


def _free(name: str, taken: set[str]) -> str:
    sign = name[:1] if name[:1] in "$#%" else ""
    plain, number = name[len(sign) :], 2
    while True:
        tail = f".{number}"
        found = plain[: tables.LONGEST_NAME - len(tail)] + tail
        if found not in taken:
            taken.add(found)
            return sign + found
        number += 1


def _renamed(module: ir.Module, changes: dict[str, str]) -> ir.Module:
    """The module with names exchanged, apart from the routines' own."""
    if not changes:
        return module
    routines = []
    for routine in module.routines:
        own = {one.name.lower() for one in (*routine.declarations, *routine.parameters) if hasattr(one, "name")}
        inner = {name: new for name, new in changes.items() if name not in own}
        routines.append(_exchanged(routine, inner))
    declarations = tuple(_exchanged(one, changes) for one in module.declarations)
    return replace(module, declarations=declarations, routines=tuple(routines))


def _exchanged(node: Node, changes: dict[str, str]) -> Node:
    def new(name: str | None) -> str | None:
        return changes.get(name.lower()) if name is not None else None

    def change(one: object) -> object:
        match one:
            case ir.Name(id=name) if (found := new(name)) is not None:
                return replace(one, id=found)
            case ir.For(counter=name) if (found := new(name)) is not None:
                return replace(one, counter=found)
            case ir.TaskControl(task=name) if (found := new(name)) is not None:
                return replace(one, task=found)
            case ir.Builtin(function="task_runs", arguments=(ir.TextLiteral(value=name),)):
                found = new(name)
                return one if found is None else replace(one, arguments=(ir.TextLiteral(found),))
            case ir.OnError(routine=name) if (found := new(name)) is not None:
                return replace(one, routine=found)
            case (
                ir.Variable(name=name)
                | ir.SignalDeclaration(name=name)
                | ir.Routine(name=name)
                | ir.CallRoutine(name=name)
                | ir.Signal(name=name)
            ) if (found := new(name)) is not None:
                return replace(one, name=found)
        return one

    return rewrite(node, change)
