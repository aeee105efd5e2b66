"""Names that several tasks use for something of their own (each RAPID task has a `main`, and often an `n` or a `Near`
of its own), for targets whose tasks all see the same routines and data.

The task that moves the robot keeps its names, then the others in their order; what a later one declares under a name
that is taken gets a new name, everywhere in that task's modules. A type that is declared alike again is the same type
and goes. A task's first routine takes the name of its module where it can: there it is the name of the program.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Fold, rules_of

_TYPES = (ir.RecordDeclaration, ir.EnumDeclaration, ir.AliasDeclaration)
_NAMED = (ir.Variable, *_TYPES)
_Declared = ir.Declaration | ir.Routine | ir.Module


def own_names(program: ir.Program, context: Context, shared: Callable[[ir.Declaration], bool]) -> ir.Program:
    """The program with one meaning for each name. `shared`: declarations that mean one thing in all tasks."""
    fold = Fold(rules_of(context.source).case_sensitive)
    tasks = sorted({module.task for module in program.modules}, key=lambda name: (_rank(program, name), name))
    everything = (one for module in program.modules for one in module.declarations)
    taken: dict[str, _Declared] = {fold(one.name): one for one in everything if isinstance(one, _NAMED) and shared(one)}
    modules = {id(module): module for module in program.modules}
    entries: dict[str, str] = {}
    for task in tasks:
        members = [module for module in program.modules if module.task == task]
        mine = _declared(members, fold, shared)
        same = {key for key, one in mine.items() if isinstance(one, _TYPES) and taken.get(key) == one}
        called = {
            key: context.fresh(f"{one.name}_{task}")
            for key, one in mine.items()
            if isinstance(one, ir.Module) and isinstance(taken.get(key), ir.Module)
        }
        again = [one for key, one in mine.items() if key in taken and key not in same and key not in called]
        entry = fold(next((one.entry for one in program.tasks if one.name == task), ""))
        new: dict[str, str] = {}
        for one in again:
            assert isinstance(one, (*_NAMED, ir.Routine))
            first = _first_name(program, members, called, entry, fold) if fold(one.name) == entry else None
            new[fold(one.name)] = first or context.fresh(f"{one.name}_{task.lower()}")
        for module in members:
            modules[id(module)] = _Renaming(new, fold).module(module, same, called)
        taken.update({fold(new.get(key, key)): one for key, one in mine.items()})
        entries[task] = new.get(entry, entry)
    renamed = tuple(_task(task, program, modules, entries) for task in program.tasks)
    return replace(program, modules=tuple(modules[id(one)] for one in program.modules), tasks=renamed)


@legalising(unless=lambda context: RoutineRule.LOCAL in context.capabilities.routines.rules)
def names_of_local_routines(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose routines are all global: a routine that only its module sees gets a name of its own where
    another module has one of that name, too (`init` of two modules)."""
    fold = Fold(rules_of(context.source).case_sensitive)
    everything = [routine for module in program.modules for routine in module.routines]
    taken = {fold(one.name) for one in everything if one.scope != "module"}
    taken |= {fold(one.entry) for one in program.tasks} | {fold(program.entry)}
    modules = []
    for module in program.modules:
        own = [one for one in module.routines if one.scope == "module"]
        new = {
            fold(one.name): context.fresh(f"{one.name}_{module.name}".lower())
            for one in own
            if fold(one.name) in taken and sum(fold(other.name) == fold(one.name) for other in everything) > 1
        }
        taken |= {fold(one.name) for one in own}
        modules.append(_Renaming(new, fold).module(module, set(), {}))
    return replace(program, modules=tuple(modules))


def _task(task: ir.Task, program: ir.Program, modules: dict[int, ir.Module], entries: dict[str, str]) -> ir.Task:
    """The task under the new names of its modules and its first routine."""
    members = tuple(modules[id(one)].name for one in program.modules if one.task == task.name)
    return replace(task, entry=entries[task.name], modules=members) if members else task


def _rank(program: ir.Program, task: str) -> int:
    """Modules of no task keep their names first, then those of a task that moves the robot."""
    if not task:
        return 0
    return 1 if any(one.name == task and one.kind == "motion" for one in program.tasks) else 2


def _key(module: ir.Module, fold: Fold) -> str:
    """Modules have a name space of their own: no declaration has a blank in its name."""
    return f" {fold(module.name)}"


def _declared(members: list[ir.Module], fold: Fold, shared: Callable[[ir.Declaration], bool]) -> dict[str, _Declared]:
    """What the modules of one task declare for themselves, by its name; the modules too."""
    found: dict[str, _Declared] = {}
    for module in members:
        for one in module.declarations:
            if isinstance(one, _NAMED) and not shared(one):
                found.setdefault(fold(one.name), one)
        for routine in module.routines:
            found.setdefault(fold(routine.name), routine)
    for module in members:
        found.setdefault(_key(module, fold), module)
    return found


def _first_name(
    program: ir.Program, members: list[ir.Module], called: dict[str, str], entry: str, fold: Fold
) -> str | None:
    """The name, maybe new, of the module with the task's first routine, where no routine has it."""
    routines = {fold(routine.name) for module in program.modules for routine in module.routines}
    for module in members:
        if any(fold(routine.name) == entry for routine in module.routines):
            name = called.get(_key(module, fold), module.name)
            return None if fold(name) in routines else name
    return None


class _Renaming:
    """New names in the modules of one task. What a routine declares for itself hides the name in it."""

    def __init__(self, new: dict[str, str], fold: Fold) -> None:
        self.new, self.fold = new, fold

    def module(self, module: ir.Module, gone: set[str], called: dict[str, str]) -> ir.Module:
        name = called.get(_key(module, self.fold), module.name)
        if not self.new and not gone and name == module.name:
            return module
        kept = [one for one in module.declarations if not (isinstance(one, _TYPES) and self.fold(one.name) in gone)]
        declarations = tuple(rewrite(one, self.changing(frozenset())) for one in kept)
        routines = tuple(self.routine(one) for one in module.routines)
        return replace(module, name=name, declarations=declarations, routines=routines)

    def routine(self, routine: ir.Routine) -> ir.Routine:
        hidden = {self.fold(one.name) for one in routine.parameters}
        hidden |= {self.fold(one.name) for one in routine.declarations if isinstance(one, ir.Variable)}
        return rewrite(routine, self.changing(frozenset(hidden)))

    def changing(self, hidden: frozenset[str]) -> Callable[[object], object]:
        def of(name: str) -> str:
            return self.new.get(self.fold(name), name)

        def value(name: str) -> str:
            return name if self.fold(name) in hidden else of(name)

        def change(node: object) -> object:
            match node:
                case ir.Name(id=name):
                    return replace(node, id=value(name))
                case ir.For(counter=name):
                    return replace(node, counter=value(name))
                case ir.Variable(name=name):
                    return replace(node, name=value(name))
                case ir.Routine(name=name) | ir.CallRoutine(name=name) | ir.Call(name=name) | ir.NamedType(name=name):
                    return replace(node, name=of(name))
                case ir.RecordDeclaration(name=name) | ir.EnumDeclaration(name=name) | ir.AliasDeclaration(name=name):
                    return replace(node, name=of(name))
                case ir.ConnectInterrupt(routine=str() as name) | ir.OnError(routine=str() as name):
                    return replace(node, routine=of(name))
                case ir.Aggregate(type_name=str() as name):
                    return replace(node, type_name=of(name))
            return node

        return change


__all__ = ["names_of_local_routines", "own_names"]
