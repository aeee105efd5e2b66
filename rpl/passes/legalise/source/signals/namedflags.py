"""Flags that have a name and no number (a semaphore, a marker of the controller): variables of all tasks everywhere."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising


@legalising(sees=("signal flag",))
def named_flags(program: ir.Program, context: Context) -> ir.Program:
    """Flags by a name as truth values."""
    names: dict[str, str] = {}
    for node in walk(*(routine for module in program.modules for routine in module.routines)):
        match node:
            case ir.Signal(kind="flag", name=str() as name) if name.lower() not in names:
                names[name.lower()] = context.fresh(name)
    if not names:
        return program

    def placed(node: object) -> object:
        match node:
            case ir.Signal(kind="flag", name=str() as name):
                return ir.Name(names[name.lower()], origin=node.origin)
        return node

    modules = [replace(one, routines=tuple(rewrite(each, placed) for each in one.routines)) for one in program.modules]
    data = tuple(ir.Variable(name, ir.BoolType(), storage="persistent", scope="global") for name in names.values())
    for place, module in enumerate(modules):
        if module.public and not module.routines:
            modules[place] = replace(module, declarations=(*module.declarations, *data))
            return replace(program, modules=tuple(modules))
    first = modules[0]
    home = ir.Module(context.fresh("flags"), first.dialect, data, task=first.task, public=True)
    return replace(program, modules=(*modules, home))


__all__ = ["named_flags"]
