"""All URScript sources of a project to modules: one per file, nested functions side by side with the others."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from . import nodes
from .expressions import Names, returns_joints
from .infer import Inference
from .instances import told_apart
from .kinds import type_of
from .pendant import as_script, is_saved_program
from .scopes import File, Function, Project, Symbol, collect, count_stores
from .splitter import split
from .statements import Statements, zero
from .syntax import Syntax, parser, unwrapped

# An integer register whose number is no plain number: `read_input_integer_register(first + 1)`.
_COUNTED = re.compile(r"\b(?:read_(?:in|out)|write_out)put_integer_register\s*\(\s*(?!\d+\s*[,)])")


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all sources of one project together."""
    syntax = Syntax(diagnostics)
    contents: list[tuple[Source, nodes.Block]] = []
    reports: list[FileReport] = []
    for given in sources:
        source = as_script(given, diagnostics) if is_saved_program(given) else given
        done = assemble(source, "urscript", split(source), parser(), syntax.lower, syntax.build, diagnostics)
        reports.append(done.report)
        contents.append((source, told_apart(tuple([unwrapped(item) for item in done.items]))))
    project = collect(contents)
    project.counts_registers = any(_COUNTED.search(source.text) for source, _ in contents)
    count_stores(project)
    inference = Inference(project)
    inference.run(diagnostics)
    modules = _modules(project, inference, diagnostics)
    programs = [file.program for file in project.files if file.program is not None]
    entry = programs[0].name if len(programs) == 1 else ""
    return ReadResult(ir.Program(modules, entry=entry), tuple(reports))


def _modules(project: Project, inference: Inference, diagnostics: Diagnostics) -> tuple[ir.Module, ...]:
    """A module for each file. Structs with the same members are one type in the whole project, named like the first
    global of this type and declared beside it."""
    taken = {symbol.name for symbol in project.symbols()} | {function.name for function in project.functions()}
    shared = Names(taken=set(taken))
    owned: dict[tuple[str, ...], int] = {}
    for at, file in enumerate(project.files):
        for symbol in file.globals.values():
            _known(shared, symbol)
        owned.update((key, at) for key in shared.records if key not in owned)
    modules: list[ir.Module] = []
    for at, file in enumerate(project.files):
        names = Names(shared.records, shared.record_kinds, taken | set(shared.records.values()))
        modules.append(_module(file, project, inference, names, diagnostics))
        owned.update((key, at) for key in shared.records if key not in owned)
    records = {
        key: ir.RecordDeclaration(
            shared.records[key],
            tuple((field, type_of(inner, shared.records)) for field, inner in kind.fields),
            "global",
        )
        for key, kind in shared.record_kinds.items()
    }
    return tuple(
        _declaring(module, [one for key, one in records.items() if owned[key] == at])
        for at, module in enumerate(modules)
    )


def _declaring(module: ir.Module, records: Sequence[ir.RecordDeclaration]) -> ir.Module:
    """The module with records behind the remarks that it begins with."""
    remarks = sum(isinstance(one, ir.Unread) for one in module.declarations)
    declarations = (*module.declarations[:remarks], *records, *module.declarations[remarks:])
    return replace(module, declarations=declarations)


def _module(file: File, project: Project, inference: Inference, names: Names, diagnostics: Diagnostics) -> ir.Module:
    routines = tuple([_routine(function, project, inference, names, diagnostics) for function in file.functions])
    variables = [
        _global(symbol, file, project, inference, names, diagnostics)
        for symbol in file.globals.values()
        if not symbol.only_handle
    ]
    routines = tuple([routine for routine in routines if not _only_data(routine, file)])
    remarks = tuple(ir.Unread("", origin=node.origin) for node in file.leading)
    attributes = (("start", f"{file.start}()"),) if file.start else ()
    return ir.Module(file.name, "urscript", (*remarks, *variables), routines, attributes, origin=Origin(file.source))


def _only_data(routine: ir.Routine, file: File) -> bool:
    """The statements of a file that gave its variables their values, and nothing else."""
    program = file.program
    if program is None or routine.name != program.name or not program.loose:
        return False
    if any(not isinstance(statement, ir.Nothing) for statement in routine.body):
        return False
    file.program = None
    return True


def _global(
    symbol: Symbol, file: File, project: Project, inference: Inference, names: Names, diagnostics: Diagnostics
) -> ir.Variable:
    """A global; what the program gives it once and for all stands in its declaration."""
    made = _variable(symbol, names, "global")
    if symbol.given is None or file.program is None:
        return made
    lowering = Statements(project, inference, file.program, names, diagnostics)
    value = lowering.stored(symbol.given.value, symbol.kind, symbol.is_joints)
    return replace(made, initial=value, origin=symbol.given.origin)


def _variable(symbol: Symbol, names: Names, scope: str) -> ir.Variable:
    type = ir.JointsType() if symbol.is_joints else type_of(symbol.kind, _known(names, symbol))
    return ir.Variable(symbol.spelled, type, scope=scope, origin=replace(symbol.origin, comments=()))


def _known(names: Names, symbol: Symbol) -> dict[tuple[str, ...], str]:
    kind = symbol.kind
    while kind is not None and kind.word == "list":
        kind = kind.element
    if kind is not None and kind.word == "struct":
        names.record(kind, f"{symbol.name}_struct")
        for _, inner in kind.fields:
            if inner is not None and inner.word == "struct":
                names.record(inner, f"{symbol.name}_part")
    return names.records


def _routine(
    function: Function, project: Project, inference: Inference, names: Names, diagnostics: Diagnostics
) -> ir.Routine:
    for symbol in (*function.parameters.values(), *function.locals.values(), *function.file.globals.values()):
        _known(names, symbol)
    lowering = Statements(project, inference, function, names, diagnostics)
    body = lowering.body()
    gives = function.gives
    statements = body.statements
    returns: ir.Type | None = None
    if gives:
        returns = ir.JointsType() if returns_joints(function) else lowering.type(function.returns)
        if _may_fall_off(statements):
            statements = (*statements, ir.Return(zero(function.returns), origin=function.node.end))
    parameters = tuple(
        ir.Parameter(symbol.spelled, ir.JointsType() if symbol.is_joints else lowering.type(symbol.kind))
        for symbol in function.parameters.values()
    )
    declared = tuple(
        _variable(symbol, names, "routine") for symbol in function.locals.values() if not symbol.only_handle
    )
    return ir.Routine(
        function.name,
        "function" if gives else "procedure",
        parameters,
        returns,
        (*declared, *body.helpers),
        statements,
        scope="global",
        origin=function.node.origin,
    )


def _may_fall_off(body: ir.Body) -> bool:
    """Can the end of the body be reached?"""
    last = next((s for s in reversed(body) if not isinstance(s, ir.Nothing)), None)
    match last:
        case ir.Return() | ir.Halt():
            return False
        case ir.If(branches=branches, otherwise=otherwise) if otherwise:
            return _may_fall_off(otherwise) or any(_may_fall_off(inner) for _, inner in branches)
        case ir.Loop(body=inner):
            return _leaves(inner)
    return True


def _leaves(body: ir.Body) -> bool:
    """Does a statement leave the loop that has this body?"""
    for statement in body:
        match statement:
            case ir.ExitLoop():
                return True
            case ir.If(branches=branches, otherwise=otherwise):
                if _leaves(otherwise) or any(_leaves(inner) for _, inner in branches):
                    return True
            case ir.Switch(cases=cases, default=default):
                if any(_leaves(case.body) for case in cases) or _leaves(default or ()):
                    return True
    return False
