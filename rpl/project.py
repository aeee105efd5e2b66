"""From paths to a program: files, folders and archives are expanded, recognised by content, and read together.

What is no robot program is refused politely: an error where the user named it, a note where a folder merely held it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from rpl import archives, ir, registry
from rpl.depth import at_any_depth
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.errors import UsageError
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.expanded import expanded
from rpl.passes.hiddentypes import hidden_types
from rpl.passes.motionvalues import motion_values
from rpl.passes.typing import normalise
from rpl.reading.ledger import FileReport
from rpl.showing import counted, heading, line, table
from rpl.sidefiles import SideFile, side_file
from rpl.source import LARGEST_FILE, Origin, Source, read_bytes, source_from_bytes

NOT_A_PROGRAM = code(
    "not-a-program",
    Severity.ERROR,
    "this is not a robot program: {reason}",
    "name the language with --from if it is one",
)
SIDE_FILE = code("side-file", Severity.ERROR, "this is no robot program but {kind}", "{use}")
DAMAGED = code(
    "damaged-file", Severity.WARNING, "left out: {reason}", "what it should hold is missing from the program"
)
SKIPPED = code("skipped-file", Severity.INFO, "skipped, not a robot program: {reason}")
SET_ASIDE = code("file-set-aside", Severity.INFO, "set aside: {kind}")
WITHOUT_TEXT = code(
    "program-without-text",
    Severity.WARNING,
    "{kind}, and the text of the program is not beside it: nothing of it is read",
    "{advice}",
)
TOO_LONG = code(
    "number-too-long",
    Severity.ERROR,
    "a number of {digits} digits, and no controller has one: nothing of this file is read",
    "give the program without it",
)
ZEROS = code(
    "zero-bytes",
    Severity.ERROR,
    "no text, or a damaged one{reason}: nothing of this file is read",
    "write it as UTF-8, or fetch it again",
)
UNREADABLE_FILE = code("unreadable-file", Severity.ERROR, "cannot read this file: {reason}")
UNREADABLE_ARCHIVE = code("unreadable-archive", Severity.ERROR, "cannot open this archive: {reason}")

_SURE_ENOUGH = 30
_CERTAIN = 95
# Whole numbers of more decimal digits are not read (the limit of Python's conversion; in base 16 five sixths of it).
_LONGEST_NUMBER = 4300
_LONG_NUMBER = re.compile(rf"\d{{{_LONGEST_NUMBER + 1},}}|[\dA-Fa-f]{{{_LONGEST_NUMBER * 5 // 6},}}")
_TEXT_CONTROLS = frozenset(b"\t\n\r\x0c\x1a")


@dataclass(frozen=True, slots=True)
class ReadProgram:
    """Everything read from the paths. `reduced` in normal form, `lowered` before that, both with runs of moves as one
    node; `program` and `raw` are the same without runs. `dialects` in order of first use. beside: files of controllers
    that are no programs, each with its language."""

    reduced: ir.Program
    lowered: ir.Program
    sources: tuple[Source, ...]
    files: tuple[FileReport, ...]
    dialects: tuple[str, ...]
    beside: tuple[tuple[str, Source], ...] = ()
    _whole: dict[str, ir.Program] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def program(self) -> ir.Program:
        """The normal form, each move for itself (made when it is first asked for)."""
        return self._expanded("program", self.reduced)

    @property
    def raw(self) -> ir.Program:
        """What the readers gave, each move for itself (made when it is first asked for)."""
        return self._expanded("raw", self.lowered)

    def _expanded(self, name: str, program: ir.Program) -> ir.Program:
        if name not in self._whole:
            self._whole[name] = at_any_depth(lambda: expanded(program))
        return self._whole[name]

    def _parts(self) -> list[str]:
        statements = sum(report.statements for report in self.files)
        unread = sum(report.opaque for report in self.files)
        return [
            " and ".join(self.dialects),
            counted(len(self.files), "file"),
            counted(statements, "statement"),
            f"{unread} not readable" if unread else "",
        ]

    def __repr__(self) -> str:
        return line("ReadProgram", self._parts())

    def _repr_html_(self) -> str:
        rows = [(report.path, report.dialect, report.statements, report.opaque) for report in self.files]
        return heading("program", self._parts()) + table(("file", "language", "statements", "not readable"), rows)


@dataclass(frozen=True, slots=True)
class _Found:
    source: Source
    named: bool


@dataclass(frozen=True, slots=True)
class _SetAside:
    language: str
    source: Source
    what: registry.Aside


def read_program(
    paths: Sequence[str | Path | Source], dialect: str | None = None, diagnostics: Diagnostics | None = None
) -> ReadProgram:
    """Read files, folders and archives as one project; a Source stands for a file that has been read.

    `dialect` (its name or an alias) overrides the recognition by content. Raises UsageError when a path does not exist.
    Everything else is reported: a file that is no program never stops the others from being read.
    """
    collector = diagnostics if diagnostics is not None else Diagnostics()
    dialect = registry.dialect_called(dialect).name if dialect is not None else None
    groups: dict[str, list[Source]] = {}
    others: list[_SetAside] = []
    for found in _expand(paths, collector):
        beside = side_file(found.source)
        if beside is not None:
            _told(beside, found, collector)
            continue
        other = None if found.named else _set_aside(found.source)
        if other is not None:
            others.append(other)
            continue
        name, reason = (dialect, "") if dialect else recognise(found.source)
        if name is None:
            left_out = DAMAGED if _is_damaged(found.source) else SKIPPED
            collector.report(NOT_A_PROGRAM if found.named else left_out, Origin(found.source), reason=reason)
            continue
        groups.setdefault(name, []).append(found.source)
    _sort_out(others, groups, collector)
    kept = tuple((one.language, one.source) for one in others if not _is_binary(one.source))
    return replace(_read_groups(groups, collector), beside=kept)


def _set_aside(source: Source) -> _SetAside | None:
    """What a controller keeps beside programs, if a language knows the file."""
    told = ((name, registry.dialect(name).aside(source)) for name in registry.dialect_names())
    return next((_SetAside(name, source, what) for name, what in told if what is not None), None)


def _sort_out(others: Sequence[_SetAside], groups: dict[str, list[Source]], diagnostics: Diagnostics) -> None:
    """A program that is there in two forms is read once, as text; one that is there in another form only is read from
    it, or said to be missing."""
    there = {source.path.lower() for sources in groups.values() for source in sources}
    for one in others:
        what = one.what
        if not what.text_at or what.text_at.lower() in there:
            diagnostics.report(SET_ASIDE, Origin(one.source), kind=what.kind)
        elif what.readable:
            groups.setdefault(one.language, []).append(one.source)
        else:
            diagnostics.report(WITHOUT_TEXT, Origin(one.source), kind=what.kind, advice=what.advice)


def read_sources(sources: Sequence[Source], dialect: str, diagnostics: Diagnostics) -> ReadProgram:
    """Read sources that are in memory (written text read back, an editor's buffer)."""
    return _read_groups({dialect: list(sources)}, diagnostics)


def _read_groups(groups: dict[str, list[Source]], diagnostics: Diagnostics) -> ReadProgram:
    with paused_cycle_collector():
        return at_any_depth(lambda: _read(groups, diagnostics), diagnostics)


def _read(groups: dict[str, list[Source]], diagnostics: Diagnostics) -> ReadProgram:
    raw = ir.Program(())
    files: list[FileReport] = []
    for name, given in groups.items():
        refused = [_refused(source, diagnostics) for source in given]
        sources = [source for source, left in zip(given, refused, strict=True) if not left]
        files.extend(FileReport(one.path, name, 1, 1) for one, left in zip(given, refused, strict=True) if left)
        result = registry.dialect(name).read(sources, diagnostics)
        part = result.program
        raw = replace(
            raw,
            modules=raw.modules + part.modules,
            tasks=raw.tasks + part.tasks,
            entry=raw.entry or part.entry,
        )
        files.extend(result.files)
    program = normalise(raw, diagnostics, as_read=True)
    hidden_types(program, diagnostics)
    motion_values(program, diagnostics)
    every = tuple(source for sources in groups.values() for source in sources)
    return ReadProgram(program, raw, every, tuple(files), tuple(groups))


def check_loading(read: ReadProgram, diagnostics: Diagnostics) -> None:
    """Warn of what the controllers of the program's languages refuse to load, whatever our readers make of it."""
    spoken = {report.path: report.dialect for report in read.files}
    for name in read.dialects:
        rules = registry.dialect(name).loading
        if rules is not None:
            rules().check([source for source in read.sources if spoken.get(source.path) == name], diagnostics)


def _refused(source: Source, diagnostics: Diagnostics) -> bool:
    """Has it zero bytes, or a number that nobody can read? For that only lines longer than it are looked at."""
    if "\x00" in source.text:
        diagnostics.report(ZEROS, Origin(source, source.text.index("\x00")), reason=_first_nul(source))
        return True
    starts = source.line_starts()
    for start, end in pairwise((*starts, len(source.text))):
        if end - start <= _LONGEST_NUMBER * 5 // 6:
            continue
        found = _LONG_NUMBER.search(source.text, start, end)
        if found is not None:
            diagnostics.report(TOO_LONG, Origin(source, *found.span()), digits=len(found[0]))
            return True
    return False


def recognise(source: Source) -> tuple[str | None, str]:
    """The dialect whose recogniser is surest of the content, or None with the reason."""
    if not source.data.strip():
        return None, "the file is empty"
    if _is_binary(source):
        return None, f"it is binary, encoded or compressed{_first_nul(source)}"
    suffix = Path(source.path).suffix.lower()
    best, best_score = None, 0
    for name in registry.dialect_names():
        dialect = registry.dialect(name)
        score = dialect.recognise(source.path, source.text)
        if score and suffix in dialect.extensions:
            score += 1  # the extension only decides between equals
        if score > best_score:
            best, best_score = name, score
        if best_score >= _CERTAIN:
            break
    if best is None or best_score < _SURE_ENOUGH:
        return None, "its content matches no language"
    return best, ""


def _told(beside: SideFile, found: _Found, diagnostics: Diagnostics) -> None:
    """A file beside the programs: an error where it was given as one, no word where it belongs to the folder."""
    if found.named:
        diagnostics.report(SIDE_FILE, Origin(found.source), kind=beside.kind, use=beside.use)
    elif not beside.own:
        diagnostics.report(SKIPPED, Origin(found.source), reason=f"it is {beside.kind}")


def _is_damaged(source: Source) -> bool:
    """Is it a program by its name that holds none: empty, or with zero bytes in its text?"""
    suffix = Path(source.path).suffix.lower()
    named = any(suffix in registry.dialect(name).extensions for name in registry.dialect_names())
    return named and (not source.data.strip() or bool(_first_nul(source)))


def _is_binary(source: Source) -> bool:
    if source.encoding.startswith("utf-16"):
        return False
    if b"\x00" in source.data:
        return True
    head = source.data[:65536]
    controls = sum(1 for byte in head if byte < 32 and byte not in _TEXT_CONTROLS)
    return controls * 50 > len(head)


def _first_nul(source: Source) -> str:
    """Where zero bytes begin that spoil what else is text: such a file was damaged and can be mended."""
    head = source.data[2:22]
    if len(head) >= 6 and (not any(head[::2]) or not any(head[1::2])) and any(head):
        return " (it looks like UTF-16 without the mark at its beginning)"
    at = source.data.find(b"\x00")
    if at < 0 or any(byte < 32 and byte not in _TEXT_CONTROLS for byte in source.data[:at]):
        return ""
    return f" (zero bytes, the first one in line {source.data.count(10, 0, at) + 1})"


def _expand(paths: Sequence[str | Path | Source], diagnostics: Diagnostics) -> Iterator[_Found]:
    seen: set[str] = set()
    for given in paths:
        if isinstance(given, Source):
            yield _Found(given, True)
            continue
        path = Path(given)
        if not path.exists():
            raise UsageError(f"no such file or folder: {path}")
        for found in _expand_one(path, diagnostics):
            key = found.source.path
            if key not in seen:
                seen.add(key)
                yield found


def _expand_one(path: Path, diagnostics: Diagnostics) -> Iterator[_Found]:
    if path.is_dir():
        for file in _files_in(path, diagnostics):
            if file.name.lower().endswith(archives.SUFFIXES):
                yield from _archive(file, diagnostics)
            else:
                yield from _file(file, False, diagnostics)
        return
    if path.name.lower().endswith(archives.SUFFIXES):
        yield from _archive(path, diagnostics)
        return
    yield from _file(path, True, diagnostics)
    for name in registry.dialect_names():
        for companion in registry.dialect(name).companions(str(path)):
            if Path(companion).is_file():
                yield from _file(Path(companion), False, diagnostics)


def _files_in(folder: Path, diagnostics: Diagnostics) -> list[Path]:
    """Every file below a folder but hidden ones; folders that cannot be looked into are reported."""

    def unreadable(error: OSError) -> None:
        at = Origin(source_from_bytes(str(error.filename), b""))
        diagnostics.report(UNREADABLE_FILE, at, reason=error.strerror or type(error).__name__)

    found: list[Path] = []
    for home, folders, names in os.walk(folder, onerror=unreadable):
        folders[:] = [name for name in folders if not name.startswith(".")]
        found += [Path(home, name) for name in names if not name.startswith(".")]
    return sorted(found)


def _bytes_of(path: Path, diagnostics: Diagnostics) -> bytes | None:
    """The file's bytes; None when it cannot be read, which is reported."""
    try:
        return read_bytes(path, LARGEST_FILE)
    except OSError as error:
        at = Origin(source_from_bytes(str(path), b""))
        diagnostics.report(UNREADABLE_FILE, at, reason=error.strerror or type(error).__name__)
        return None


def _file(path: Path, named: bool, diagnostics: Diagnostics) -> Iterator[_Found]:
    data = _bytes_of(path, diagnostics)
    if data is None:
        return
    yield from _unpacked(str(path), data, named, diagnostics)


def _unpacked(path: str, data: bytes, named: bool, diagnostics: Diagnostics) -> Iterator[_Found]:
    """A file that is packed by itself counts as what it holds."""
    try:
        yield _Found(source_from_bytes(path, archives.unpacked(data, LARGEST_FILE)), named)
    except ValueError as error:
        diagnostics.report(UNREADABLE_FILE, Origin(source_from_bytes(path, b"")), reason=str(error))


def _archive(path: Path, diagnostics: Diagnostics) -> Iterator[_Found]:
    """Members of a controller backup, in memory, in order of their names."""
    data = _bytes_of(path, diagnostics)
    for member in archives.members(data) if data is not None else ():
        if member.data is not None and archives.is_archive(member.name, member.data):
            at = Origin(source_from_bytes(f"{path}/{member.name}", b""))
            diagnostics.report(DAMAGED, at, reason="it is an archive in an archive")
        elif member.data is not None:
            yield from _unpacked(f"{path}/{member.name}", member.data, False, diagnostics)
        elif member.name:
            at = Origin(source_from_bytes(f"{path}/{member.name}", b""))
            diagnostics.report(UNREADABLE_FILE, at, reason=member.reason)
        else:
            diagnostics.report(UNREADABLE_ARCHIVE, Origin(source_from_bytes(str(path), b"")), reason=member.reason)
