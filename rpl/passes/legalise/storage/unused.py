"""Drop what nothing uses: parts of the source's prelude, generated records, data that would only take up numbers."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.parameters import ARGUMENTS
from rpl.passes.legalise.facts.mentioned import called_as, is_linked, is_system_data, mentioned
from rpl.passes.legalise.rewriting.support import SUPPORT
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE

IDLE = code("data-used-nowhere", Severity.INFO, "used nowhere in the program, so without a number: {names}")

NOT_USED = code(
    "controller-data-left-out",
    Severity.INFO,
    "{count} of the data of the source's controller in {name} are used nowhere in the program, and left out",
)


@legalising()
def drop_unused(program: ir.Program, context: Context) -> ir.Program:
    """The program without unused data, types and routines of linked preludes."""
    return without_unused(program, context)


def without_unused(program: ir.Program, context: Context, wanted: frozenset[str] = frozenset()) -> ir.Program:
    """The same. wanted: names, folded, of data that a later pass reads though nothing in the program does."""
    parts: list[ir.Declaration | ir.Routine] = []
    own = []
    for module in program.modules:
        mine = tuple(one for one in module.declarations if not _is_generated(one, module, context))
        routines = () if is_linked(module, context) else module.routines
        own.append(replace(module, declarations=mine, routines=routines))
        parts.extend(one for one in module.declarations if _is_generated(one, module, context))
        parts.extend(one for one in module.routines if is_linked(module, context))
    if not parts:
        return program
    used = mentioned(replace(program, modules=tuple(own)))
    used |= wanted | {called_as(program.entry), *(called_as(task.entry) for task in program.tasks)}
    kept: set[int] = set()
    size = -1
    while size != len(kept):
        size = len(kept)
        for one in parts:
            if id(one) not in kept and _declares(one) & used:
                kept.add(id(one))
                used |= mentioned(one)
    modules = []
    for module in program.modules:
        gone = {id(one) for one in parts} - kept
        _tell_left_out(module, gone, context)
        declarations = tuple(one for one in module.declarations if id(one) not in gone)
        routines = tuple(one for one in module.routines if id(one) not in gone)
        if declarations or routines or not (is_linked(module, context) or _is_support(module)):
            modules.append(replace(module, declarations=declarations, routines=routines))
    return replace(program, modules=tuple(modules))


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def drop_idle_data(program: ir.Program, context: Context) -> ir.Program:
    """The program without global data that nothing uses, for targets where it would take a number of its own. Whole
    records of tools and loads leave such parts when they are taken apart."""
    used = mentioned(program) | {ARGUMENTS.lower()}
    modules = []
    for module in program.modules:
        idle = [one for one in module.declarations if isinstance(one, ir.Variable) and one.name.lower() not in used]
        for origin in dict.fromkeys(one.origin for one in idle if one.origin is not NOWHERE):
            names = ", ".join(one.name for one in idle if one.origin == origin)
            context.diagnostics.report(IDLE, origin, names=names)
        gone = set(map(id, idle))
        modules.append(replace(module, declarations=tuple(d for d in module.declarations if id(d) not in gone)))
    return replace(program, modules=tuple(modules))


def _is_generated(one: ir.Declaration, module: ir.Module, context: Context) -> bool:
    """Part of a linked prelude, data that passes have brought along, or a record that stands for a built-in type. Names
    of signals stay, for programs use signals by their numbers too."""
    record = isinstance(one, ir.RecordDeclaration) and one.name.startswith("rpl_")
    if _is_support(module) and isinstance(one, ir.Variable):
        return True
    return record or (is_linked(module, context) and not isinstance(one, ir.SignalDeclaration))


def _is_support(module: ir.Module) -> bool:
    return module.name.lower().startswith(SUPPORT)


def _tell_left_out(module: ir.Module, gone: set[int], context: Context) -> None:
    """Say what of the controller's own data the program does not use; what every controller has is no news."""
    if not is_system_data(module, context):
        return
    prelude = registry.dialect(context.source).prelude()
    usual = {name for one in (prelude.declarations if prelude else ()) for name in _declares(one)}
    left = [one for one in module.declarations if isinstance(one, ir.Variable) and id(one) in gone]
    left = [one for one in left if one.name.lower() not in usual]
    if left:
        context.diagnostics.report(NOT_USED, left[0].origin, name=module.name, count=len(left))


def _declares(one: ir.Declaration | ir.Routine) -> set[str]:
    match one:
        case ir.EnumDeclaration(name=name, members=members):
            return {name.lower(), *(member.lower() for member in members)}
        case ir.Initialise(assign=ir.Assign(target=target)):
            base = target
            while isinstance(base, ir.Index | ir.Field):
                base = base.base
            return {base.id.lower()} if isinstance(base, ir.Name) else set()
        case ir.Unread():
            return set()
        case ir.Routine(name=name):
            return {called_as(name)}  # data may have the same name
    return {one.name.lower()}


__all__ = ["drop_idle_data", "drop_unused", "without_unused"]
