"""Data that several tasks share by its name (RAPID PERS), for targets whose tasks all see the same data and routines.

Each such variable is declared once, in a module that belongs to no task; the declarations in the tasks go. The value of
the first one is kept, as all of them name one value; the types it needs go with it. What tasks have of their own under
one name gets names of its own (ownnames).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Background
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.source.data.ownnames import own_names
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Fold, rules_of

_TYPES = (ir.RecordDeclaration, ir.EnumDeclaration, ir.AliasDeclaration)


@legalising(unless=lambda context: context.capabilities.tasks.background is Background.SEPARATE)
def shared_task_data(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without tasks that have data of their own, and programs of several tasks."""
    if len({module.task for module in program.modules}) < 2:
        return program
    fold = Fold(rules_of(context.source).case_sensitive)
    tasks: dict[str, set[str]] = {}
    first: dict[str, ir.Variable] = {}
    for module in program.modules:
        for one in module.declarations:
            if _is_shared(one):
                tasks.setdefault(fold(one.name), set()).add(module.task)
                first.setdefault(fold(one.name), one)
    common = {name: one for name, one in first.items() if len(tasks[name]) > 1}

    def goes(one: ir.Declaration) -> bool:
        return _is_shared(one) and fold(one.name) in common and one.type == common[fold(one.name)].type

    program = own_names(program, context, goes)
    if not common:
        return program
    types = _types_of(common.values(), program, fold)
    modules = tuple(
        replace(module, declarations=tuple(one for one in module.declarations if not goes(one) and one not in types))
        for module in program.modules
    )
    declarations = (*types, *common.values())
    home = ir.Module(context.fresh("rpl_tasks"), modules[0].dialect, declarations, public=True)
    return replace(program, modules=(*modules, home))


def _types_of(shared: Iterable[ir.Variable], program: ir.Program, fold: Fold) -> tuple[ir.Declaration, ...]:
    """The types of the program that these variables need, each behind those that it needs itself."""
    types = {fold(one.name): one for each in program.modules for one in each.declarations if isinstance(one, _TYPES)}
    found: list[ir.Declaration] = []

    def look(part: object) -> None:
        for node in walk(part):
            if isinstance(node, ir.NamedType) and (one := types.pop(fold(node.name), None)) is not None:
                look(one)
                found.append(one)

    for variable in shared:
        look(variable)
    return tuple(found)


def _is_shared(one: ir.Declaration) -> TypeGuard[ir.Variable]:
    return isinstance(one, ir.Variable) and one.storage == "persistent" and one.scope == "global"


__all__ = ["shared_task_data"]
