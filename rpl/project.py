"""From paths to a program: files, folders and archives are expanded, recognised by content, and read together.

What is no robot program is refused politely: an error where the user named it, a note where a folder merely held it.
"""

from __future__ import annotations

import gzip
import tarfile
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path, PurePosixPath

from rpl import ir, registry
from rpl.depth import at_any_depth
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.errors import UsageError
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.hiddentypes import hidden_types
from rpl.passes.motionvalues import motion_values
from rpl.passes.typing import normalise
from rpl.reading.ledger import FileReport
from rpl.showing import counted, heading, line, table
from rpl.sidefiles import SideFile, side_file
from rpl.source import LARGEST_FILE, Origin, Source, source_from_bytes

NOT_A_PROGRAM = code(
    "not-a-program",
    Severity.ERROR,
    "this is not a robot program: {reason}",
    "name the language with --from if it is one",
)
SIDE_FILE = code("side-file", Severity.ERROR, "this is no robot program but {kind}", "{use}")
SKIPPED = code("skipped-file", Severity.INFO, "skipped, not a robot program: {reason}")
UNREADABLE_FILE = code("unreadable-file", Severity.ERROR, "cannot read this file: {reason}")
UNREADABLE_ARCHIVE = code("unreadable-archive", Severity.ERROR, "cannot open this archive: {reason}")

_SURE_ENOUGH = 30
_CERTAIN = 95
_ARCHIVES = (".zip", ".tar", ".tgz", ".tar.gz", ".tar.bz2", ".tar.xz")
_GZIP = b"\x1f\x8b"
_TEXT_CONTROLS = frozenset(b"\t\n\r\x0c\x1a")


@dataclass(frozen=True, slots=True)
class ReadProgram:
    """Everything read from the paths. `raw` as lowered, `program` in normal form; `dialects` in order of first use."""

    program: ir.Program
    raw: ir.Program
    sources: tuple[Source, ...]
    files: tuple[FileReport, ...]
    dialects: tuple[str, ...]

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
    for found in _expand(paths, collector):
        beside = side_file(found.source)
        if beside is not None:
            _told(beside, found, collector)
            continue
        name, reason = (dialect, "") if dialect else recognise(found.source)
        if name is None:
            at = Origin(found.source)
            collector.report(NOT_A_PROGRAM if found.named else SKIPPED, at, reason=reason)
            continue
        groups.setdefault(name, []).append(found.source)
    return _read_groups(groups, collector)


def read_sources(sources: Sequence[Source], dialect: str, diagnostics: Diagnostics) -> ReadProgram:
    """Read sources that are in memory (written text read back, an editor's buffer)."""
    return _read_groups({dialect: list(sources)}, diagnostics)


def _read_groups(groups: dict[str, list[Source]], diagnostics: Diagnostics) -> ReadProgram:
    with paused_cycle_collector():
        return at_any_depth(lambda: _read(groups, diagnostics), diagnostics)


def _read(groups: dict[str, list[Source]], diagnostics: Diagnostics) -> ReadProgram:
    raw = ir.Program(())
    files: list[FileReport] = []
    for name, sources in groups.items():
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


def _is_binary(source: Source) -> bool:
    if source.encoding.startswith("utf-16"):
        return False
    head = source.data[:65536]
    if b"\x00" in head:
        return True
    controls = sum(1 for byte in head if byte < 32 and byte not in _TEXT_CONTROLS)
    return controls * 50 > len(head)


def _first_nul(source: Source) -> str:
    """Where zero bytes begin that spoil what else is text: such a file was damaged and can be mended."""
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
        for file in sorted(path.rglob("*")):
            if file.is_file() and not any(part.startswith(".") for part in file.relative_to(path).parts):
                if file.name.lower().endswith(_ARCHIVES):
                    yield from _archive(file, diagnostics)
                else:
                    yield from _file(file, False, diagnostics)
        return
    if path.name.lower().endswith(_ARCHIVES):
        yield from _archive(path, diagnostics)
        return
    yield from _file(path, True, diagnostics)
    for name in registry.dialect_names():
        for companion in registry.dialect(name).companions(str(path)):
            if Path(companion).is_file():
                yield from _file(Path(companion), False, diagnostics)


def _file(path: Path, named: bool, diagnostics: Diagnostics) -> Iterator[_Found]:
    try:
        size = path.stat().st_size
        data = path.read_bytes() if size <= LARGEST_FILE else b""
    except OSError as error:
        at = Origin(source_from_bytes(str(path), b""))
        diagnostics.report(UNREADABLE_FILE, at, reason=error.strerror or type(error).__name__)
        return
    if size > LARGEST_FILE:
        at = Origin(source_from_bytes(str(path), b""))
        diagnostics.report(UNREADABLE_FILE, at, reason=f"larger than {LARGEST_FILE // 2**20} MiB")
        return
    yield _Found(source_from_bytes(str(path), _unpacked(data)), named)


def _unpacked(data: bytes) -> bytes:
    """A file that is packed by itself (gzip) is read as what is in it."""
    if not data.startswith(_GZIP):
        return data
    try:
        with gzip.GzipFile(fileobj=BytesIO(data)) as packed:
            inner = packed.read(LARGEST_FILE + 1)
    except (OSError, EOFError, zlib.error):
        return data
    return inner if len(inner) <= LARGEST_FILE else data


def _archive(path: Path, diagnostics: Diagnostics) -> Iterator[_Found]:
    """Members of a controller backup, in memory, in order of their names."""
    try:
        members = dict(_members(path))
    except (OSError, zipfile.BadZipFile, tarfile.TarError, EOFError, RuntimeError, NotImplementedError) as error:
        at = Origin(source_from_bytes(str(path), b""))
        diagnostics.report(UNREADABLE_ARCHIVE, at, reason=str(error) or type(error).__name__)
        return
    for name in sorted(members):
        yield _Found(source_from_bytes(f"{path}/{name}", members[name]), False)


def _members(path: Path) -> Iterator[tuple[str, bytes]]:
    data = path.read_bytes()
    if zipfile.is_zipfile(BytesIO(data)):
        with zipfile.ZipFile(BytesIO(data)) as archive:
            for info in archive.infolist():
                if not info.is_dir() and info.file_size <= LARGEST_FILE:
                    yield str(PurePosixPath(info.filename)), archive.read(info)
        return
    with tarfile.open(fileobj=BytesIO(data)) as tar:
        for member in tar.getmembers():
            stream = tar.extractfile(member) if member.isfile() and member.size <= LARGEST_FILE else None
            if stream is not None:
                yield str(PurePosixPath(member.name)), stream.read()
