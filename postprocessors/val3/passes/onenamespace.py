"""Data of several modules in one application, whose programs all see all its data: two of one name are told apart.

What other modules can see keeps its name, else the first module's does; the others' get a number behind it. Taught
points are data of the application, which the pendant shows and teaches anew: those of a routine too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.writing.target import WriteContext

from ..facts.names import names_of
from ..tables import LONGEST_NAME, RESERVED

_NUMBERS = (ir.IntLiteral, ir.RealLiteral)


def one_namespace(program: ir.Program, context: WriteContext) -> ir.Program:
    """The program with one datum for each name of its modules' data."""
    data = [_data(module) for module in program.modules]
    homes: dict[str, int] = {}
    for seen in (True, False):
        for at, declared in enumerate(data):
            for name, shared in declared.items():
                if shared is seen:
                    homes.setdefault(name, at)
    again = [[name for name in declared if homes[name] != at] for at, declared in enumerate(data)]
    if not any(again):
        return program
    taken = names_of(program) | RESERVED
    modules = []
    for module, names in zip(program.modules, again, strict=True):
        modules.append(_renamed(module, {name: _free(name, taken) for name in names}))
    return replace(program, modules=tuple(modules))


def points_in_data(program: ir.Program, context: WriteContext) -> ir.Program:
    """The program with the taught points of its routines as data; of two of one name the later one has its routine's
    name behind it."""
    own = [one.name for m in program.modules for r in m.routines for one in r.declarations if _is_taught(one)]
    if not own:
        return program
    taken = names_of(program, locals=False) | RESERVED
    shadowed = {one.name for m in program.modules for r in m.routines for one in r.parameters}
    shadowed |= {one.name for m in program.modules for r in m.routines for one in r.declarations
                 if isinstance(one, ir.Variable) and not _is_taught(one)}  # fmt: skip
    taken |= shadowed
    modules = []
    for module in program.modules:
        points: list[ir.Variable] = []
        routines = []
        for routine in module.routines:
            new: dict[str, str] = {}
            for one in routine.declarations:
                if _is_taught(one):
                    wish = one.name if one.name not in taken else f"{one.name}_{routine.name}"[:LONGEST_NAME]
                    new[one.name] = wish if wish not in taken else _free(wish, taken)
                    taken.add(new[one.name])
                    points.append(replace(one, name=new[one.name], scope="module"))
            left = tuple(one for one in routine.declarations if not _is_taught(one))
            changed = {old: name for old, name in new.items() if old != name}
            routines.append(rewrite(replace(routine, declarations=left), _exchanging(changed)))
        declarations = (*module.declarations, *points)
        modules.append(replace(module, declarations=declarations, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


def _is_taught(declaration: object) -> TypeGuard[ir.Variable]:
    """A constant place or posture of a routine, written out in numbers."""
    match declaration:
        case ir.Variable(storage="constant", type=ir.TargetType() | ir.JointsType(), initial=ir.Aggregate(entries)):
            return all(isinstance(one, _NUMBERS) for _, one in entries)
    return False


def _data(module: ir.Module) -> dict[str, bool]:
    """The module's data by name; do other modules see it?"""
    return {one.name: one.scope != "module" for one in module.declarations if isinstance(one, ir.Variable)}


def _free(name: str, taken: set[str]) -> str:
    number = 2
    while (found := f"{name[: LONGEST_NAME - len(str(number)) - 1]}_{number}") in taken:
        number += 1
    taken.add(found)
    return found


def _renamed(module: ir.Module, new: Mapping[str, str]) -> ir.Module:
    """The module with other names for its data. What a routine declares for itself hides them in it."""
    if not new:
        return module
    routines = []
    for routine in module.routines:
        own = {one.name for one in routine.parameters}
        own.update(one.name for one in routine.declarations if isinstance(one, ir.Variable))
        routines.append(rewrite(routine, _exchanging({old: name for old, name in new.items() if old not in own})))
    declarations = tuple(rewrite(one, _exchanging(new)) for one in module.declarations)
    return replace(module, declarations=declarations, routines=tuple(routines))


def _exchanging(new: Mapping[str, str]) -> Callable[[object], object]:
    def change(node: object) -> object:
        match node:
            case ir.Name(id=name) if name in new:
                return replace(node, id=new[name])
            case ir.For(counter=name) if name in new:
                return replace(node, counter=new[name])
            case ir.Variable(name=name) if name in new:
                return replace(node, name=new[name])
        return node

    return change
