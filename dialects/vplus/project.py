"""All V+ files of a project to one program: a quick look first, then statement by statement, then types."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import PureWindowsPath

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.pieces import Item, ModulePart
from rpl.reading.shapes import ShapeParser
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from . import modes, truths
from .blocks import Builder, DataPart, ProgramPart
from .expressions import significant
from .functions import joints_of, transformation
from .inference import Symbol, Symbols, element_type, infer
from .later import outputs_later
from .quick import facts_of
from .reactions import come_once, told_apart
from .resets import resets_as_outputs
from .resolve import Resolver
from .settings import Settings
from .split import SHAPE, Outline, split
from .statements import Declared, Header

OUTSIDE = code(
    "vplus-outside-program", Severity.WARNING, "steps outside of .PROGRAM ... .END", "they are read as program {name}"
)
TWICE = code("vplus-program-twice", Severity.ERROR, "a second program named {name}; only the first one is kept")

_ZEROS = (ir.IntLiteral(0),) * 6


@cache
def _parser() -> ShapeParser:
    return ShapeParser("vplus.lark", SHAPE)


@dataclass(slots=True)
class _File:
    """What one file holds."""

    source: Source
    programs: list[tuple[str, ProgramPart, Origin]] = field(default_factory=list)
    data: list[DataPart] = field(default_factory=list)
    comments: list[ir.Declaration] = field(default_factory=list)


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all files of one project together."""
    lowering = Settings(facts_of(source.text for source in sources), diagnostics)
    build = Builder(diagnostics)
    files: list[_File] = []
    reports: list[FileReport] = []
    programs: dict[str, ProgramPart] = {}
    for source in sources:
        lowering.outline = Outline()
        pieces = split(source, lowering.outline)
        done = assemble(source, "vplus", pieces, _parser(), lowering.lower, build, diagnostics)
        reports.append(done.report)
        files.append(_sorted(source, done.items, programs, diagnostics))
    if lowering.rounds:
        _add_rounds(lowering, files[0], programs)
    symbols = infer(programs, [part for file in files for part in file.data], diagnostics)
    symbols.upper = bool(lowering.facts.upper)
    truths.mark(programs, [part for file in files for part in file.data], symbols)
    homes = _homes(files, symbols)
    kinds = {
        key: tuple(symbols.kind(key, name) for name, _ in part.header.parameters) for key, part in programs.items()
    }
    finish = _Finish(symbols, lowering, kinds, modes.by_value(programs, symbols))
    modules = tuple(finish.module(file, homes.get(position, [])) for position, file in enumerate(files))
    modules = resets_as_outputs(outputs_later(modules), diagnostics)
    return ReadResult(ir.Program(told_apart(come_once(modules))), tuple(reports))


def _add_rounds(lowering: Settings, file: _File, programs: dict[str, ProgramPart]) -> None:
    """Programs that execute another one several times, as EXECUTE asks for."""
    for key, wanted in lowering.rounds.items():
        part = programs.get(significant(wanted.program))
        if part is None or key in programs:
            continue
        name, given = lowering.name(wanted.name), part.header.parameters
        arguments = tuple(ir.Argument(ir.Name(parameter)) for parameter, _ in given)
        body: ir.Body = (ir.CallRoutine(part.header.name, arguments),)
        declared: tuple[Declared, ...] = ()
        if not any(isinstance(node, ir.Return | ir.Label | ir.OnError) for node in walk(part.body)):
            body, declared = part.body, part.declared  # the steps themselves: what ends the task finds it there
        if wanted.cycles < 0:
            body = (ir.While(ir.BoolLiteral(True), body),)
        else:
            declared = (*declared, Declared("auto", "real", (("round", ()),)))
            body = (ir.For("round", ir.IntLiteral(1), ir.IntLiteral(wanted.cycles), None, body),)
        origin = Origin(wanted.origin.source, wanted.origin.start, wanted.origin.end)
        programs[key] = ProgramPart(Header(name, given), declared, body)
        file.programs.append((key, programs[key], origin))


def _sorted(
    source: Source, items: tuple[Item, ...], programs: dict[str, ProgramPart], diagnostics: Diagnostics
) -> _File:
    """Put a file's top-level items where they belong."""
    file = _File(source)
    loose: list[ir.Statement] = []
    for item in items:
        match item:
            case ModulePart(data=ProgramPart() as part):
                key = significant(part.header.name)
                if key in programs:
                    diagnostics.report(TWICE, item.origin, name=part.header.name)
                    continue
                programs[key] = part
                file.programs.append((key, part, item.origin))
            case ModulePart(data=DataPart() as data):
                file.data.append(data)
            case ir.Nothing():
                file.comments.append(ir.Unread("", origin=item.origin))
            case _ if not isinstance(item, ModulePart | ir.Routine) and hasattr(item, "origin"):
                loose.append(item)  # type: ignore[arg-type]  # whatever else stands there is a statement
    if loose:
        name = _stem(source)
        diagnostics.report(OUTSIDE, loose[0].origin, name=name)
        part = ProgramPart(Header(name, ()), (), tuple(loose))
        programs[significant(name)] = part
        file.programs.append((significant(name), part, loose[0].origin))
    return file


def _stem(source: Source) -> str:
    stem = re.sub(r"[^\w.]", "_", PureWindowsPath(source.path).stem)
    return stem if stem[:1].isalpha() else f"file_{stem}"


def _homes(files: list[_File], symbols: Symbols) -> dict[int, list[tuple[str, str]]]:
    """Which file's module declares each global name: the one that gives it a first value, else the first that uses
    it."""
    place: dict[str, int] = {}
    for position, file in enumerate(files):
        for section in file.data:
            for datum, _ in section.values:
                place.setdefault(significant(datum.name), position)
    homes: dict[int, list[tuple[str, str]]] = {}
    paths = {file.source.path: position for position, file in enumerate(files)}
    for (program, key), entry in symbols.entries.items():
        if not program:
            at = place.get(key, paths.get(entry.origin.file, 0))
            homes.setdefault(at, []).append((key, entry.name))
    return homes


@dataclass(slots=True)
class _Finish:
    """Makes modules of files when all types are known."""

    symbols: Symbols
    lowering: Settings
    kinds: dict[str, tuple[str, ...]]
    values: frozenset[Symbol]  # parameters that are passed by value

    def module(self, file: _File, names: list[tuple[str, str]]) -> ir.Module:
        """One file as a module: global variables, then its programs."""
        first = {
            significant(datum.name): _initial(section.section, datum.name, datum.values)
            for section in file.data
            for datum, _ in section.values
            if not datum.indices
        }
        lines = {
            significant(datum.name): part.origin
            for section in file.data
            for datum, part in section.values
            if not datum.indices
        }
        declared: list[ir.Declaration] = list(file.comments)
        for key, name in names:
            origin = lines.get(key) or self.symbols.entries["", key].origin
            at = Origin(origin.source, origin.start, origin.end)
            type = self.symbols.type("", name)
            off = ir.BoolLiteral(False) if isinstance(type, ir.BoolType) else ir.IntLiteral(0)
            started = off if key in self.lowering.events else None
            declared.append(ir.Variable(name, type, first.get(key) or started, "persistent", "global", origin=at))
        for section in file.data:
            for datum, part in section.values:
                if datum.indices:
                    place = ir.Index(ir.Name(datum.name), tuple(ir.IntLiteral(index) for index in datum.indices))
                    assign = ir.Assign(place, _initial(section.section, datum.name, datum.values), origin=part.origin)
                    declared.append(ir.Initialise(assign, origin=part.origin))
        routines = tuple(self.routine(key, part, origin) for key, part, origin in file.programs)
        return ir.Module(_stem(file.source), "vplus", tuple(declared), routines, origin=Origin(file.source))

    def routine(self, key: str, part: ProgramPart, origin: Origin) -> ir.Routine:
        """A program with its parameters and its own variables."""
        parameters = []
        for name, count in part.header.parameters:
            type = element_type(self.symbols.kind(key, name))
            if count:
                type = ir.ArrayType(type, (None,) * count, base=0)
            mode = "value" if (key, significant(name)) in self.values else "reference"
            parameters.append(ir.Parameter(name, type, mode))
        taken = {significant(name) for name, _ in part.header.parameters}
        at = Origin(origin.source, origin.start, origin.end)
        declared = []
        for declaration in part.declared:
            for name, _ in declaration.names:
                if declaration.kind == "global" or significant(name) in taken:
                    continue
                taken.add(significant(name))
                storage = "persistent" if declaration.kind == "local" else "variable"
                declared.append(ir.Variable(name, self.symbols.type(key, name), None, storage, "routine", origin=at))
        body = Resolver(self.symbols, key, self.kinds).body(part.body)
        return ir.Routine(
            self.lowering.names.of(part.header.name, origin),
            parameters=tuple(parameters),
            declarations=tuple(declared),
            body=body,
            scope="global",
            origin=origin,
        )


def _initial(section: str, name: str, values: tuple[ir.Expression, ...]) -> ir.Expression:
    """The value of a line in a data section."""
    if section != ".LOCATIONS":
        return values[0]
    return transformation(values) if name[0] != "#" else joints_of([*values, *_ZEROS][:6])


__all__ = ["read"]
