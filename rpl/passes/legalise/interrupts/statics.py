"""Variables of a routine that keep their values from call to call, as data of its module, for targets whose routines
have only variables that begin anew."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.capabilities import Local
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Fold


@legalising(unless=lambda context: Local.STATICS in context.capabilities.routines.locals)
def static_variables(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such variables. One keeps its name where no other data has it."""
    scopes = ProgramScope(program)
    used = Counter(name for module in program.modules for name in _names(module))
    modules = []
    for module in program.modules:
        fold = scopes.module(module).fold
        lifted: list[ir.Variable] = []
        routines = tuple(_without(routine, used, fold, context, lifted) for routine in module.routines)
        declarations = (*module.declarations, *lifted)
        modules.append(replace(module, declarations=declarations, routines=routines) if lifted else module)
    return replace(program, modules=tuple(modules))


def _names(module: ir.Module) -> list[str]:
    found = [one.name.lower() for one in module.declarations if isinstance(one, ir.Variable)]
    for routine in module.routines:
        found.append(routine.name.lower())
        found.extend(parameter.name.lower() for parameter in routine.parameters)
        found.extend(one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable))
    return found


def _without(
    routine: ir.Routine, used: Counter[str], fold: Fold, context: Context, lifted: list[ir.Variable]
) -> ir.Routine:
    """The routine without its lasting variables, which go to `lifted` under their new names."""
    names: dict[str, str] = {}
    kept: list[ir.Declaration] = []
    for one in routine.declarations:
        if not isinstance(one, ir.Variable) or one.storage != "persistent":
            kept.append(one)
            continue
        alone = used[one.name.lower()] == 1
        names[fold(one.name)] = one.name if alone else context.fresh(f"{routine.name}_{one.name}")
        lifted.append(replace(one, name=names[fold(one.name)], scope="module"))
    if not names:
        return routine

    def renamed(node: object) -> object:
        if isinstance(node, ir.Name) and fold(node.id) in names:
            return replace(node, id=names[fold(node.id)])
        if isinstance(node, ir.For) and fold(node.counter) in names:
            return replace(node, counter=names[fold(node.counter)])
        return node

    return rewrite(replace(routine, declarations=tuple(kept)), renamed)
