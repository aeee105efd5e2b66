"""Programs that were files of one routine each as routines of one module, as RAPID's people keep those of a task.
Data of one name in several of them gets the routine's name in front, and so does what is called by a number alone.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.entries import background, moving_entries
from rpl.passes.legalise.facts.mentioned import mentioned
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE
from rpl.writing.names import renamed_as

_NUMBERED = re.compile(r"[A-Za-z]\d+")  # P2, C00003: told from others by its program alone


@legalising()
def joined_modules(program: ir.Program, context: Context) -> ir.Program:
    """Of the task that moves the robot; the module that it begins in comes first and keeps its name."""
    if not context.foreign or any(task.kind == "motion" for task in program.tasks):
        return program
    beside = background(program)
    found = [module for module in program.modules if module.name not in beside and _is_one_routine(module)]
    if len({module.routines[0].name.lower() for module in found}) < max(len(found), 2):
        return program
    entries = moving_entries(program)
    found.sort(key=lambda module: module.routines[0].name.lower() not in entries)
    names = Counter(name for module in program.modules for name in _names(module))
    parts = [_apart(module, names, context.taken) for module in found]
    first = parts[0]
    whole = replace(
        first,
        declarations=tuple(one for part in parts for one in part.declarations),
        routines=tuple(_remarked(routine, part, first) for part in parts for routine in part.routines),
    )
    gone = {id(one) for one in found[1:]}
    kept = [whole if module is found[0] else module for module in program.modules if id(module) not in gone]
    return replace(program, modules=tuple(kept))


def _is_one_routine(module: ir.Module) -> bool:
    """Has it one routine, and no data that the source shows to other modules?"""
    own = all(
        isinstance(one, ir.Variable) and (one.scope == "module" or one.origin is NOWHERE) for one in module.declarations
    )
    return len(module.routines) == 1 and own and not module.task


def _names(module: ir.Module) -> set[str]:
    """What the module declares and what it mentions, folded: there a name may be another module's."""
    declared = (one for one in (*module.declarations, *module.routines) if hasattr(one, "name"))
    return mentioned(ir.Program((module,))) | {one.name.lower() for one in declared}


def _data(module: ir.Module) -> list[ir.Variable]:
    return [one for one in module.declarations if isinstance(one, ir.Variable)]


def _apart(module: ir.Module, names: Mapping[str, int], taken: set[str]) -> ir.Module:
    """The module with names of its own for what others call alike. names: in how many modules each stands; taken: names
    in use, folded; the new ones are added."""
    routine, changes = module.routines[0].name, dict[str, str]()
    for one in (each for each in _data(module) if each.scope == "module"):
        if names[one.name.lower()] > 1 or _NUMBERED.fullmatch(one.name):
            changes[one.name] = found = _free(f"{routine}_{one.name}", taken)
            taken.add(found.lower())
    (done,) = renamed_as(ir.Program((module,)), changes).modules
    return done


def _free(name: str, taken: set[str]) -> str:
    number, found = 2, name
    while found.lower() in taken:
        number, found = number + 1, f"{name}_{number}"
    return found


def _remarked(routine: ir.Routine, part: ir.Module, first: ir.Module) -> ir.Routine:
    """The routine with what stood in front of its module."""
    remarks = part.origin.comments if part is not first else ()
    if not remarks:
        return routine
    return replace(routine, origin=replace(routine.origin, comments=(*remarks, *routine.origin.comments)))


__all__ = ["joined_modules"]
