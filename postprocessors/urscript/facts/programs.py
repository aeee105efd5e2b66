"""The routines of a program: which a script can begin with, which are called and started; and all names."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.kinds import walk_for


def programs(program: ir.Program) -> list[ir.Routine]:
    """The routines that a script can start with: the entry by the rule of the command line, else every candidate."""
    routines = [routine for module in program.modules for routine in module.routines]
    wanted = program.entry or next((task.entry for task in program.tasks if task.kind == "motion"), "")
    for name in (wanted, "main"):
        found = [one for one in routines if name and one.name.lower() == name.lower() and _starts(one)]
        if found:
            return found[:1]
    busy = {task.entry.lower() for task in program.tasks}
    startable = [one for one in routines if _starts(one) and not _is_empty(one) and one.name.lower() not in busy]
    uncalled = [one for one in startable if one.name.lower() not in called_names(program, one)]
    named = [one for module in program.modules for one in module.routines if _like_its_file(module, one)]
    named = [one for one in named if any(one is other for other in startable)]
    for group in (named, [one for one in named if any(one is other for other in uncalled)], uncalled):
        if len(group) == 1:
            return group
    return uncalled or startable


def called_names(program: ir.Program, besides: ir.Routine | None = None) -> set[str]:
    """Routines that others call, start or are interrupted by, folded. `besides`: a routine whose own calls do not
    count."""
    routines = [routine for module in program.modules for routine in module.routines]
    return {name for routine in routines if routine is not besides for name in names_called_in(routine)}


def names_called_in(routine: ir.Routine) -> set[str]:
    """Routines that this one calls, starts or is interrupted by, folded."""
    names: set[str] = set()
    for node in walk(routine):
        match node:
            case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.ConnectInterrupt(routine=name):
                names.add(name.lower())
            case ir.TaskControl(task=name):
                names.add(name.lower())
    return names


def not_reached(program: ir.Program, others: list[ir.Routine]) -> list[ir.Routine]:
    """Those of these routines, which can be started, that nothing besides them leads to."""
    routines = [routine for module in program.modules for routine in module.routines]
    kept = [one for one in routines if not any(one is other for other in others)]
    named = {name for one in kept for name in names_called_in(one)}
    more = [one for one in others if one.name.lower() in named]
    return not_reached(program, [one for one in others if not any(one is found for found in more)]) if more else others


def _starts(routine: ir.Routine) -> bool:
    return routine.kind == "procedure" and all(parameter.optional for parameter in routine.parameters)


def _is_empty(routine: ir.Routine) -> bool:
    return all(isinstance(statement, ir.Nothing) for statement in routine.body)


def _like_its_file(module: ir.Module, routine: ir.Routine) -> bool:
    source = routine.origin.source or module.origin.source
    name = routine.name.lower()
    return name == module.name.lower() or (source is not None and name == source.name.lower())


def started(program: ir.Program) -> set[str]:
    """Routines that are started as tasks, folded."""
    return {
        node.task.lower()
        for node in walk_for({"TaskControl"}, program)
        if isinstance(node, ir.TaskControl) and node.op == "start"
    }


def names_of(program: ir.Program) -> set[str]:
    """Every name that stands in the program."""
    names: set[str] = set()
    for node in walk(program):
        match node:
            case ir.Name(id=name):
                names.add(name)
            case _:
                other = getattr(node, "name", None)
                if isinstance(other, str):
                    names.add(other)
    return names


def assigns(name: str, routine: ir.Routine) -> bool:
    """May the routine write its parameter?"""
    for node in walk(routine.body):
        match node:
            case ir.Assign(target=target):
                while isinstance(target, ir.Index | ir.Field):
                    target = target.base
                if isinstance(target, ir.Name) and target.id == name:
                    return True
            case ir.Do(arguments=arguments) if ir.Name(name) in arguments:
                return True
            case ir.For(counter=counter) if counter == name:
                return True
            case ir.CallRoutine(arguments=given) if any(one.value == ir.Name(name) for one in given):
                return True
    return False
