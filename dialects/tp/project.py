"""All TP files of a project to modules: each listing is a module with one program, the registers a module of their own.

Listings are read in three looks: headers and positions of all of them, what their statements use of the registers, and
then the statements themselves.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.pieces import STATEMENT, ModulePart, Piece
from rpl.reading.shapes import ShapeParser, StatementError
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from . import tables
from .blocks import Builder, Listing
from .dumps import Dump, is_dump, read_dump
from .expressions import Place
from .frames import check_frames
from .header import Header, read_header
from .motion import Motion
from .positions import Position, parse_position
from .registers import MODULE, Facts, conclude, declarations, survey
from .split import MACRO, SHAPE, split, without_notes
from .words import is_german

TWICE = code("tp-program-twice", Severity.WARNING, "program {name} stands in two files; the first one is called")
CUT_OFF = code(
    "tp-cut-off",
    Severity.INFO,
    "the listing has no /END: it may have been cut off",
    "compare it with the program on the controller",
)
NO_NAME = code("tp-no-program-name", Severity.WARNING, "the listing does not name its program; it is read as {name}")

_LABEL = re.compile(r"LBL\s*\[\s*(\d+)\s*\]\s*\Z", re.IGNORECASE)


@cache
def _parser() -> ShapeParser:
    return ShapeParser("tp.lark", SHAPE)


@dataclass(frozen=True, slots=True)
class _File:
    """One listing before its statements are read."""

    source: Source
    header: Header
    name: str
    pieces: tuple[Piece, ...]
    positions: dict[int, Position]
    taught: dict[int, Position]
    labels: tuple[int, ...]


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all files of one project together."""
    facts, dump = Facts(), Dump()
    reports: dict[str, FileReport] = {}
    files: list[_File] = []
    names: set[str] = set()
    for source in sources:
        if is_dump(source.text) and "/PROG" not in source.text:
            reports[source.path] = FileReport(source.path, "tp", read_dump(source, dump, diagnostics), 0)
        else:
            files.append(_opened(source, names, diagnostics))
    _look_over(files, facts, dump, diagnostics)
    modules = []
    for file in files:
        part, reports[file.source.path] = _read_listing(file, facts, dump, diagnostics)
        modules.extend(part)
    declared = declarations(facts, dump)
    if declared:
        modules.insert(0, ir.Module(MODULE, "tp", declared))
    return ReadResult(ir.Program(tuple(modules)), tuple(reports[source.path] for source in sources))


def _opened(source: Source, names: set[str], diagnostics: Diagnostics) -> _File:
    header = read_header(source.text.partition("/MN")[0])
    name = routine_name(header.name or source.name)
    if not header.name:
        diagnostics.report(NO_NAME, Origin(source), name=name)
    if not re.search(r"^\s*/END\b", source.text, re.MULTILINE | re.IGNORECASE):
        diagnostics.report(CUT_OFF, Origin(source, max(len(source.text) - 1, 0), len(source.text)))
    if name.upper() in names:
        diagnostics.report(TWICE, Origin(source), name=name)
    names.add(name.upper())
    pieces = tuple(split(source))
    positions: dict[int, Position] = {}
    taught: dict[int, Position] = {}
    for piece in pieces:
        if piece.kind == STATEMENT and piece.text == "/P":
            try:
                position = parse_position(source.text[piece.start : piece.end])
            except StatementError:
                continue  # reported when it is lowered
            positions.setdefault(position.number, position)
            taught[piece.start] = position
    labels = tuple(int(found[1]) for piece in pieces if (found := _LABEL.match(piece.text)))
    return _File(source, header, name, pieces, positions, taught, labels)


def routine_name(name: str) -> str:
    """A program's name as a name of the IR: system programs such as `-BCKED9-` have signs that no name has."""
    cleaned = re.sub(r"\W", "_", name)
    return cleaned if cleaned and not cleaned[0].isdigit() else f"_{cleaned}"


def _look_over(files: list[_File], facts: Facts, dump: Dump, diagnostics: Diagnostics) -> None:
    interrupt = 1
    for file in files:
        facts.programs.setdefault(file.name.upper(), file.header.kind)
        if file.header.kind.lower() == "macro" and file.header.comment.strip():
            facts.macros.setdefault(" ".join(file.header.comment.lower().split()), file.name)
        if file.header.kind.lower().startswith("cond"):
            count = sum(1 for piece in file.pieces if piece.text[:5].upper() == "WHEN ")
            facts.monitors[file.name.upper()] = (interrupt, count)
            interrupt += count
    files[:] = [replace(file, pieces=tuple(_macro_call(piece, facts) for piece in file.pieces)) for file in files]
    for file in files:
        kinds = {number: position.kind for number, position in file.positions.items()}
        survey(facts, file.name, file.pieces, kinds, file.source)
    conclude(facts, dump, diagnostics)


def _macro_call(piece: Piece, facts: Facts) -> Piece:
    """An instruction that is the name of a macro of the project (`Open hand 1`, `Lamp(3,R[2])`) is a call."""
    if piece.kind != STATEMENT or not piece.text.startswith(MACRO):
        return piece
    plain, _ = without_notes(piece.text[len(MACRO) :].strip())
    name, _, given = plain.partition("(")
    key = " ".join(name.lower().split())
    program = facts.macros.get(key) or tables.STANDARD_MACROS.get(key)
    if program is None or program.upper() not in facts.programs or not re.match(r"[A-Za-z_\u0080-\uffff]", program):
        return piece
    return replace(piece, text=f"CALL {program}({given}" if given else f"CALL {program}")


def _read_listing(
    file: _File, facts: Facts, dump: Dump, diagnostics: Diagnostics
) -> tuple[list[ir.Module], FileReport]:
    lowering = Motion(facts, diagnostics)
    kinds = {number: position.kind for number, position in file.positions.items()}
    lowering.place = Place(file.name, kinds, file.labels, file.taught, is_german(file.source.text))
    lowering.modal, lowering.offsets = {}, {}
    builder = Builder(diagnostics, file.name, lowering.modal)
    done = assemble(file.source, "tp", iter(file.pieces), _parser(), lowering.lower, builder, diagnostics)
    modules = []
    for item in done.items:
        if isinstance(item, ModulePart) and isinstance(item.data, Listing):
            modules.append(_module(item, item.data.header, file, facts))
    check_frames(modules, file.positions, facts, dump, diagnostics)
    return modules, done.report


def _module(part: ModulePart, header: Header, file: _File, facts: Facts) -> ir.Module:
    kinds = facts.arguments.get(file.name.upper(), {})
    parameters = tuple(
        ir.Parameter(f"AR{number}", ir.StringType() if kinds.get(number) == "t" else tables.NUMBER)
        for number in range(1, max(kinds, default=0) + 1)
    )
    first, *more = part.routines
    first = ir.Routine(
        first.name, "procedure", parameters, None, first.declarations, first.body, scope="global", origin=first.origin
    )
    attributes = (("PROG", header.name or file.name), *header.attributes)
    return ir.Module(file.name, "tp", (), (first, *more), attributes, origin=part.origin)
