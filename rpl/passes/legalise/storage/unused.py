"""Drop what nothing uses: parts of the source's prelude, generated records, routines without types, and data that would
only take up numbers.

A language whose parameters have no type (URScript) takes it from the calls. Of a routine that nothing calls the type of
a parameter may stay unknown; a target with types cannot declare it, and nothing would run it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.parameters import ARGUMENTS
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.source import NOWHERE

NEVER_CALLED = code(
    "routine-never-called",
    Severity.WARNING,
    "{name} is called nowhere, and the type of {what} is known to no other language; it is left out",
    "call it once with an example of its values if the translation needs it",
)
IDLE = code("data-used-nowhere", Severity.INFO, "used nowhere in the program, so without a number: {names}")

_BUILT_IN = frozenset(("tool", "workobject", "load", "speed", "zone", "pose", "vector", "rotation", "joints", "axes"))


@legalising()
def drop_unused(program: ir.Program, context: Context) -> ir.Program:
    """The program without unused data, types and routines of linked preludes."""
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
    used = _names(replace(program, modules=tuple(own)))
    used |= {_called(program.entry), *(_called(task.entry) for task in program.tasks)}
    kept: set[int] = set()
    size = -1
    while size != len(kept):
        size = len(kept)
        for one in parts:
            if id(one) not in kept and _declares(one) & used:
                kept.add(id(one))
                used |= _names(one)
    modules = []
    for module in program.modules:
        gone = {id(one) for one in parts} - kept
        declarations = tuple(one for one in module.declarations if id(one) not in gone)
        routines = tuple(one for one in module.routines if id(one) not in gone)
        if declarations or routines or not is_linked(module, context):
            modules.append(replace(module, declarations=declarations, routines=routines))
    return replace(program, modules=tuple(modules))


@legalising()
def drop_untyped(program: ir.Program, context: Context) -> ir.Program:
    """The program without routines that nothing calls and whose data has a type of the source controller alone, and
    without handles of interrupts and path events that no statement mentions."""
    used = _names(program) | {program.entry.lower()} | {task.entry.lower() for task in program.tasks}
    modules = []
    for module in program.modules:
        kept = []
        for routine in module.routines:
            data: list[ir.Parameter | ir.Variable] = list(routine.parameters)
            data += [one for one in routine.declarations if isinstance(one, ir.Variable)]
            unknown = next((one.name for one in data if isinstance(one.type, ir.VendorType)), None)
            if unknown is None or routine.name.lower() in used:
                kept.append(routine)
            else:
                context.diagnostics.report(NEVER_CALLED, routine.origin, name=routine.name, what=unknown)
        kept = [replace(one, declarations=_without_handles(one.declarations, used, context)) for one in kept]
        declarations = _without_handles(module.declarations, used, context)
        modules.append(replace(module, declarations=declarations, routines=tuple(kept)))
    return replace(program, modules=tuple(modules))


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def drop_idle_data(program: ir.Program, context: Context) -> ir.Program:
    """The program without global data that nothing uses, for targets where it would take a number of its own. Whole
    records of tools and loads leave such parts when they are taken apart."""
    used = _names(program) | {ARGUMENTS.lower()}
    modules = []
    for module in program.modules:
        idle = [one for one in module.declarations if isinstance(one, ir.Variable) and one.name.lower() not in used]
        for origin in dict.fromkeys(one.origin for one in idle if one.origin is not NOWHERE):
            names = ", ".join(one.name for one in idle if one.origin == origin)
            context.diagnostics.report(IDLE, origin, names=names)
        gone = set(map(id, idle))
        modules.append(replace(module, declarations=tuple(d for d in module.declarations if id(d) not in gone)))
    return replace(program, modules=tuple(modules))


def _without_handles(
    declarations: tuple[ir.Declaration, ...], used: set[str], context: Context
) -> tuple[ir.Declaration, ...]:
    """Without names of interrupts and path events that nothing uses and the target has no type for."""

    def idle(one: ir.Declaration) -> bool:
        if not isinstance(one, ir.Variable) or not isinstance(one.type, ir.InterruptType | ir.TriggerType):
            return False
        return one.type.__class__.__name__ not in context.capabilities.types and one.name.lower() not in used

    return tuple(one for one in declarations if not idle(one))


def _is_generated(one: ir.Declaration, module: ir.Module, context: Context) -> bool:
    """Part of a linked prelude, or a record that stands for a built-in type."""
    record = isinstance(one, ir.RecordDeclaration) and one.name.startswith("rpl_")
    return record or is_linked(module, context)


def is_linked(module: ir.Module, context: Context) -> bool:
    """Is it the used part of the source's prelude?"""
    return module.name.lower().startswith(f"{context.source}_base")


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
            return {_called(name)}  # data may have the same name
    return {one.name.lower()}


def _called(name: str) -> str:
    """How a routine's name stands among the names in use."""
    return f"{name.lower()}()"


def _named_types(type: ir.Type | None) -> set[str]:
    """The name of a type of the program's own, of an array that of its elements."""
    while isinstance(type, ir.ArrayType):
        type = type.element
    return {type.name.lower()} if isinstance(type, ir.NamedType) else set()


def _names(node: ir.Program | ir.Declaration | ir.Routine) -> set[str]:
    """Every name that the node mentions, folded: of values, routines, types and members."""
    found: set[str] = set()

    def types(type: ir.Type | None) -> None:
        found.update(_named_types(type))

    def expression(one: ir.Expression) -> ir.Expression:
        match one:
            case ir.Call(name=name):
                found.update((name.lower(), _called(name)))
            case ir.Name(id=name) | ir.EnumLiteral(member=name):
                found.add(name.lower())
            case ir.Aggregate(type_name=word) if word and word not in _BUILT_IN:
                found.add(word.lower())
        return rewrite_parts(one, expression)

    def body(statements: ir.Body) -> ir.Body:
        for one in statements:
            match one:
                case ir.For(counter=name):
                    found.add(name.lower())
                case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name):
                    found.update((name.lower(), _called(name)))
                case ir.TaskControl(task=str() as name) | ir.OnError(routine=str() as name):
                    found.update((name.lower(), _called(name)))
            rewrite_parts(one, expression, body)
        return statements

    def declaration(one: ir.Declaration) -> None:
        match one:
            case ir.Variable(type=type) | ir.AliasDeclaration(type=type):
                types(type)
            case ir.RecordDeclaration(fields=fields):
                for _, type in fields:
                    types(type)

    def routine(one: ir.Routine) -> None:
        types(one.returns)
        for parameter in one.parameters:
            types(parameter.type)
        for inner in one.declarations:
            declaration(inner)

    match node:
        case ir.Program(modules=modules):
            for module in modules:
                for one in module.declarations:
                    declaration(one)
                for each in module.routines:
                    routine(each)
        case ir.Routine():
            routine(node)
        case _:
            declaration(node)
    rewrite_parts(node, expression, body)
    return found
