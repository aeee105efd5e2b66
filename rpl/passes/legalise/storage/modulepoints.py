"""Taught points as data of the module: a person looks for them in the data list (KRL), above the routines (RAPID) or in
the section of locations (V+), and can teach them anew there. They come as constants of routines from controllers that
keep their points in each program.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.passes.capabilities import ModulePoints
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.storage.points import is_point

__all__ = ["points_of_modules"]


@legalising(unless=lambda context: context.capabilities.storage.module_points is ModulePoints.NO)
def points_of_modules(program: ir.Program, context: Context) -> ir.Program:
    """Only where nothing else of that name could be meant."""
    kind = context.capabilities.storage.module_points
    everywhere = Counter(name for module in program.modules for name in _names(module))
    shared = {name for module in program.modules for name in _shared(module)}
    modules = []
    for module in program.modules:
        own = Counter(_names(module))
        meant = everywhere if kind is ModulePoints.GLOBAL else own + Counter(shared)
        storage = "persistent" if kind is ModulePoints.LIST else "constant"
        modules.append(_lifted(module, {name for name, times in meant.items() if times == 1}, storage))
    return replace(program, modules=tuple(modules))


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
