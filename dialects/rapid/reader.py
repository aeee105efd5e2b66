"""Read all sources of a RAPID project into modules and tasks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import bodies
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.pieces import Attribute, Item, ModulePart
from rpl.reading.runs import Cursor, Runs
from rpl.reading.templates import Templates
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from .blocks import Blocks, is_statement, part
from .dialogs import may_ask
from .functions import FUNCTIONS
from .instructions import INSTRUCTIONS
from .iosignals import attribute, is_configuration, ranges
from .parser import RapidParser
from .prelude import PREDEFINED_NAMES
from .project import Project, survey
from .recognise import encoded
from .splitter import split
from .statements import Statements
from .vendor import EFFECTS

ENCODED = code(
    "encoded-module",
    Severity.ERROR,
    "this is an encoded (binary) module, not program text",
    "save it decoded on the controller, or leave it out",
)
NO_MODULE = code("no-module", Severity.WARNING, "the text stands in no module; it is read as module {name}")

_TASK_FOLDER = re.compile(r"(?:^|[/\\])(TASK\d+)[/\\]", re.IGNORECASE)


@cache
def _parser() -> RapidParser:
    return RapidParser()


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """All sources of one project together."""
    configurations = [source for source in sources if is_configuration(source.text)]
    usable = [source for source in sources if not encoded(source.data) and source not in configurations]
    project = survey(usable, PREDEFINED_NAMES)
    parser = _parser()
    modules: list[ir.Module] = []
    reports: list[FileReport] = []
    for source in sources:
        if encoded(source.data):
            diagnostics.report(ENCODED, Origin(source, 0, 0))
            reports.append(FileReport(source.path, "rapid", 0, 0))
            continue
        if source in configurations:
            reports.append(FileReport(source.path, "rapid", 0, 0))
            continue
        found, report = _read_file(source, project, parser, diagnostics)
        modules.extend(found)
        reports.append(report)
    if modules:
        kept = tuple(attribute(one) for source in configurations for one in ranges(source.text))
        modules[0] = replace(modules[0], attributes=(*modules[0].attributes, *kept))
    program = ir.Program(tuple(modules), _tasks(modules))
    if any(may_ask(source.text) for source in usable):
        from .askingfunctions import with_dialogs  # brings the rewriting along, which reading has no other use for

        own = frozenset(project.routines.union(*project.local_routines.values()))
        program = with_dialogs(program, own, diagnostics)
    return ReadResult(program, tuple(reports))


def _read_file(
    source: Source, project: Project, parser: RapidParser, diagnostics: Diagnostics
) -> tuple[list[ir.Module], FileReport]:
    statements = Statements(project, source.path, diagnostics)
    blocks = Blocks(project, diagnostics)
    cursor = Cursor()
    runs = Runs(source, parser, statements.lower, cursor, diagnostics, signs_placed=False)
    pieces = split(source, parser, statement_names(project, source.path), cursor)
    plain = plain_names(project)
    alike = Templates(parser, statements.lower, diagnostics, lambda name: name.lower() in plain)
    assembly = assemble(source, "rapid", pieces, parser, statements.lower, blocks.build, diagnostics, runs, alike)
    task = _TASK_FOLDER.search(source.path)
    parts = _parts(assembly.items, source, diagnostics)
    modules = [
        ir.Module(
            found.name,
            "rapid",
            found.declarations,
            found.routines,
            _attributes(found.data),
            task.group(1).upper() if task else "",
            origin=found.origin,
        )
        for found in parts
    ]
    return modules, assembly.report


def statement_names(project: Project, path: str) -> frozenset[str]:
    """Names that begin a statement: installed instructions and the project's procedures as this file sees them."""
    own = project.routines | project.local_routines.get(path, set())
    return (frozenset(INSTRUCTIONS) | EFFECTS.keys() | own) - project.declared


def plain_names(project: Project) -> frozenset[str]:
    """Names of the project's data that no statement treats otherwise than any other one. (Those of the controller's
    data come again and again, so that what stands with them is kept with them.)"""
    told = project.types | project.signal_parameters | project.routines.union(*project.local_routines.values())
    return frozenset(
        project.declared - PREDEFINED_NAMES - told - INSTRUCTIONS.keys() - FUNCTIONS.keys() - EFFECTS.keys()
    )


def _attributes(data: object) -> tuple[tuple[str, str], ...]:
    """The attributes that a module brings with it; a promise of our own block building."""
    assert isinstance(data, tuple)
    return data


def _parts(items: tuple[Item, ...], source: Source, diagnostics: Diagnostics) -> list[ModulePart]:
    """The modules of a file. What stands outside of them goes to the module before it, or makes one of its own."""
    parts: list[ModulePart] = []
    loose: list[Item] = []
    header: list[tuple[str, str]] = []
    for item in items:
        if isinstance(item, ModulePart):
            parts.append(item)
        elif isinstance(item, Attribute):
            header.append((item.name, item.value))
        else:
            loose.append(item)
    if parts:
        first = parts[0]
        attributes = (*header, *_attributes(first.data))
        declarations, routines = list(first.declarations), list(first.routines)
        if loose:
            more = part(first.name, (), loose, first.origin, diagnostics)
            assert isinstance(more, ModulePart)  # loose items hold no modules
            declarations.extend(more.declarations)
            routines.extend(more.routines)
        parts[0] = ModulePart(first.name, tuple(declarations), tuple(routines), attributes, first.origin)
    elif loose:
        parts.append(_without_module(loose, tuple(header), source, diagnostics))
    return parts


def _without_module(
    loose: list[Item], header: tuple[tuple[str, str], ...], source: Source, diagnostics: Diagnostics
) -> ModulePart:
    """A fragment: statements outside of any routine become a routine named like the file."""
    origin = Origin(source, 0, 0)
    name = re.sub(r"\W", "_", source.name) or "module"
    diagnostics.report(NO_MODULE, origin, name=name)
    body = [item for item in loose if is_statement(item)]
    others: list[Item] = [item for item in loose if not is_statement(item)]
    if any(not isinstance(item, ir.Nothing | ir.Opaque) for item in body):
        others.append(ir.Routine(name, body=tuple(body), origin=origin))
    else:
        others.extend(body)
    made = part(name, header, others, origin, diagnostics)
    assert isinstance(made, ModulePart)  # loose items hold no modules
    return made


def _tasks(modules: list[ir.Module]) -> tuple[ir.Task, ...]:
    """One task per TASKn folder of a backup. A task without motion runs beside the others, or beside the modules that
    lie in no such folder (those of the task that is being programmed)."""
    alone = all(module.task for module in modules)
    names: dict[str, list[ir.Module]] = {}
    for module in modules:
        if module.task:
            names.setdefault(module.task, []).append(module)
    tasks = []
    for name, members in sorted(names.items()):
        routines = (routine for module in members for routine in module.routines)
        moves = (alone and len(names) == 1) or any(
            _has_motion(body) for routine in routines for body in bodies(routine)
        )
        kind = "motion" if moves else "background"
        listed = tuple(module.name for module in members)
        tasks.append(ir.Task(name, "main", kind, cyclic=not moves, modules=listed))
    return tuple(tasks)


def _has_motion(body: ir.Body) -> bool:
    for statement in body:
        match statement:
            case ir.Move() | ir.MoveExternal() | ir.Run():
                return True
            case ir.If(branches=branches, otherwise=otherwise):
                if any(_has_motion(inner) for _, inner in branches) or _has_motion(otherwise):
                    return True
            case ir.For(body=inner) | ir.While(body=inner):
                if _has_motion(inner):
                    return True
            case ir.Switch(cases=cases, default=default):
                if any(_has_motion(case.body) for case in cases) or _has_motion(default or ()):
                    return True
    return False
