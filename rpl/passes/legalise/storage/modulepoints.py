"""Taught points as data of the module: a person looks for them in the data list (KRL), above the routines (RAPID) or in
the section of locations (V+), and can teach them anew there. They come as constants of routines from controllers that
keep their points in each program. Where all modules share their names, points of one name get that of their comment or
that of their routine in front.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.capabilities import ModulePoints
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.storage.points import is_point

__all__ = ["points_of_modules"]

_SIGNS = re.compile(r"[^A-Za-z0-9]+")


@legalising(unless=lambda context: context.capabilities.storage.module_points is ModulePoints.NO)
def points_of_modules(program: ir.Program, context: Context) -> ir.Program:
    """Only where nothing else of that name could be meant, unless it can have another one."""
    kind = context.capabilities.storage.module_points
    everywhere = Counter(name for module in program.modules for name in _names(module))
    shared = {name for module in program.modules for name in _shared(module)}
    if kind is ModulePoints.GLOBAL:
        program = _apart(program, everywhere, context)
        everywhere = Counter(name for module in program.modules for name in _names(module))
    modules = []
    for module in program.modules:
        own = Counter(_names(module))
        meant = everywhere if kind is ModulePoints.GLOBAL else own + Counter(shared)
        storage = "persistent" if kind is ModulePoints.LIST else "constant"
        modules.append(_lifted(module, {name for name, times in meant.items() if times == 1}, storage))
    return replace(program, modules=tuple(modules))


def _apart(program: ir.Program, everywhere: Counter[str], context: Context) -> ir.Program:
    """The program with other names for points of routines that share theirs."""
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            named = {
                one.name.lower(): context.fresh(_word(one.label) or f"{routine.name}_{one.name}")
                for one in routine.declarations
                if _is_taught(one) and everywhere[one.name.lower()] > 1
            }
            routines.append(rewrite(routine, partial(_renamed, named=named)) if named else routine)
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


def _word(label: str) -> str:
    """A comment as a name; empty where it is none."""
    word = _SIGNS.sub("_", label.strip()).strip("_").lower()
    return word if word[:1].isalpha() else ""


def _renamed(node: object, named: Mapping[str, str]) -> object:
    match node:
        case ir.Name(id=name) if name.lower() in named:
            return replace(node, id=named[name.lower()])
        case ir.Variable(name=name) if name.lower() in named:
            return replace(node, name=named[name.lower()])
    return node


def _names(module: ir.Module) -> Iterator[str]:
    """Names of the module and of its routines, folded, as often as they are declared."""
    for declaration in module.declarations:
        name = getattr(declaration, "name", None)
        if isinstance(name, str):
            yield name.lower()
    for routine in module.routines:
        yield routine.name.lower()
        yield from (parameter.name.lower() for parameter in routine.parameters)
        yield from (d.name.lower() for d in routine.declarations if isinstance(d, ir.Variable))


def _shared(module: ir.Module) -> Iterator[str]:
    for declaration in module.declarations:
        if isinstance(declaration, ir.Variable) and declaration.scope != "module":
            yield declaration.name.lower()
    for routine in module.routines:
        if routine.scope == "global":
            yield routine.name.lower()


def _lifted(module: ir.Module, alone: set[str], storage: str) -> ir.Module:
    points: list[ir.Variable] = []
    routines = []
    for routine in module.routines:
        mine = [d for d in routine.declarations if _is_taught(d) and d.name.lower() in alone]
        points.extend(replace(point, scope="module", storage=storage) for point in mine)
        left = tuple(d for d in routine.declarations if not any(d is point for point in mine))
        routines.append(replace(routine, declarations=left) if mine else routine)
    if not points:
        return module
    return replace(module, declarations=(*module.declarations, *points), routines=tuple(routines))


def _is_taught(declaration: ir.Declaration) -> TypeGuard[ir.Variable]:
    """A constant position of a routine, written out."""
    return (
        isinstance(declaration, ir.Variable)
        and declaration.storage == "constant"
        and isinstance(declaration.type, ir.TargetType | ir.JointsType | ir.PoseType)
        and is_point(declaration.initial)
    )
