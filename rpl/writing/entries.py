"""Names that a controller asks for in a program: of the routine it starts with, and modules that share no name.

RAPID starts a task with `main`, and refuses a module that is called like a routine or datum of the program (RAPID
reference manual, modules; 0 of 372 public modules are).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import AS_MODULE
from rpl.passes.legalise.facts.entries import background, moving_entries
from rpl.writing.namemap import NameMap
from rpl.writing.names import renamed_routine
from rpl.writing.target import NameRules

_ENDING = "Module"


def name_entry(
    program: ir.Program, first: str | None, rules: NameRules, taken: frozenset[str] = frozenset()
) -> tuple[ir.Program, dict[str, str]]:
    """The program whose routine `first` has the name that the controller starts, and old name -> that name. taken:
    names on the robot that will run it."""
    if not asks_for_name(rules):
        return program, {}
    changed: dict[str, str] = {}
    routines = {one.name.lower() for module in _foreground(program) for one in module.routines}
    there = {name.lower() for name in taken}
    if first is not None and first.lower() in routines and rules.entry not in routines | there:
        changed = {first: rules.entry}
        program = renamed_routine(program, first, rules.entry)
    return _with_own_modules(program, rules, there), changed


def asks_for_name(rules: NameRules) -> bool:
    """Does the controller start a routine of one fixed name?"""
    return rules.entry not in ("", AS_MODULE)


def unpinned(earlier: NameMap, rules: NameRules) -> NameMap:
    """The map without the name that the controller asks for: who has it is found anew, and its module may be called
    like the source's routine."""
    names = {old: new for old, new in earlier.names.items() if not asks_for_name(rules) or new.lower() != rules.entry}
    return earlier if len(names) == len(earlier.names) else replace(earlier, names=names)


def first_routine(program: ir.Program) -> str | None:
    """The routine of the source that a run starts with: the program's entry, else the only one that is called like its
    module, else the only one that nothing calls. None: it cannot be told."""
    starting = moving_entries(program)
    found = [
        (module, one)
        for module in _foreground(program)
        for one in module.routines
        if one.name.lower() in starting and one.kind == "procedure" and not one.parameters and not _is_empty(one)
    ]
    if program.entry:
        found = [(module, one) for module, one in found if one.name.lower() == program.entry.lower()]
    if len(found) != 1:
        found = [(module, one) for module, one in found if one.name.lower() == module.name.lower()]
    return found[0][1].name if len(found) == 1 else None


def _foreground(program: ir.Program) -> list[ir.Module]:
    beside = background(program)
    return [module for module in program.modules if module.name not in beside]


def _is_empty(routine: ir.Routine) -> bool:
    """Does it only hold remarks, as the first routine of a KRL file with helpers does?"""
    return all(isinstance(one, ir.Nothing) for one in routine.body)


def _with_own_modules(program: ir.Program, rules: NameRules, there: set[str]) -> ir.Program:
    """The program with modules called like nothing in it."""
    taken = {
        one.name.lower()
        for module in program.modules
        for one in (*module.routines, *module.declarations)
        if not isinstance(one, ir.Initialise | ir.Unread | ir.ExternalDeclaration)
    }
    held = there | {module.name.lower() for module in program.modules}
    changed: dict[str, str] = {}
    for module in program.modules:
        name = module.name
        if name.lower() in taken and name not in changed:
            stem, number = name[: rules.longest - len(_ENDING) - 2], 1
            new = f"{stem}{_ENDING}"
            while new.lower() in taken | held:
                number += 1
                new = f"{stem}{_ENDING}{number}"
            held.add(new.lower())
            changed[name] = new
    if not changed:
        return program
    return replace(
        program,
        modules=tuple(replace(one, name=changed.get(one.name, one.name)) for one in program.modules),
        tasks=tuple(
            replace(one, modules=tuple(changed.get(name, name) for name in one.modules)) for one in program.tasks
        ),
    )
