"""Data that several tasks share by its name (RAPID PERS), for targets whose tasks all see the same data and routines.

Each such variable is declared once, in a module that belongs to no task; the declarations in the tasks go. The value of
the first one is kept, as all of them name one value. Where several tasks begin with a routine of the same name, that of
the robot's task keeps it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.scope import Fold, rules_of


def shared_task_data(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without tasks that have data of their own, and programs of several tasks."""
    capabilities = context.capabilities
    if capabilities.background_tasks == "separate" or len({module.task for module in program.modules}) < 2:
        return program
    fold = Fold(rules_of(context.source).case_sensitive)
    program = _entries_by_name(program, context, fold)
    tasks: dict[str, set[str]] = {}
    first: dict[str, ir.Variable] = {}
    for module in program.modules:
        for one in module.declarations:
            if _is_shared(one):
                tasks.setdefault(fold(one.name), set()).add(module.task)
                first.setdefault(fold(one.name), one)
    common = {name: one for name, one in first.items() if len(tasks[name]) > 1}
    if not common:
        return program

    def stays(one: ir.Declaration) -> bool:
        return not _is_shared(one) or fold(one.name) not in common or one.type != common[fold(one.name)].type

    modules = tuple(
        replace(module, declarations=tuple(one for one in module.declarations if stays(one)))
        for module in program.modules
    )
    home = ir.Module(context.fresh("rpl_tasks"), modules[0].dialect, tuple(common.values()), public=True)
    return replace(program, modules=(*modules, home))


def _entries_by_name(program: ir.Program, context: Context, fold: Fold) -> ir.Program:
    """The program in which the first routine of every task has a name of its own: the robot's task keeps its names."""
    taken: set[str] = set()
    for task in sorted(program.tasks, key=lambda one: one.kind != "motion"):
        old, members = fold(task.entry), frozenset(task.modules)
        if old not in taken or not members:
            taken.add(old)
            continue
        new = _name_of(program, members, old, fold) or context.fresh(f"{task.name}_{task.entry}".lower())

        def renamed(node: object, old: str = old, new: str = new) -> object:
            if isinstance(node, ir.Routine | ir.CallRoutine | ir.Call) and fold(node.name) == old:
                return replace(node, name=new)
            return node

        modules = tuple(rewrite(one, renamed) if one.name in members else one for one in program.modules)
        tasks = tuple(replace(one, entry=new) if one is task else one for one in program.tasks)
        program = replace(program, modules=modules, tasks=tasks)
    return program


def _name_of(program: ir.Program, members: frozenset[str], entry: str, fold: Fold) -> str | None:
    """The name of the module with the task's first routine, where no routine has it: it is the task's program."""
    routines = {fold(routine.name) for module in program.modules for routine in module.routines}
    for module in program.modules:
        if module.name in members and any(fold(routine.name) == entry for routine in module.routines):
            return None if fold(module.name) in routines else module.name
    return None


def _is_shared(one: ir.Declaration) -> TypeGuard[ir.Variable]:
    return isinstance(one, ir.Variable) and one.storage == "persistent" and one.scope == "global"


__all__ = ["shared_task_data"]
