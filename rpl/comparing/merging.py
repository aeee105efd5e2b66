"""Three versions of a program merged: touch-ups from the floor and edits from the office come together.

The pieces are those of the meaning (a point, a statement, a line of a header); the text of each is taken as it stands,
so that nothing is written anew. What was merged is read back: where that finds an error which no version had, the merge
is not taken for done.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from rpl import registry
from rpl.comparing.changes import Change
from rpl.comparing.pieces import Piece, pieces, spans_of
from rpl.comparing.projects import differences
from rpl.comparing.threeway import Clash, Part, brought_together
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.project import ReadProgram, read_program
from rpl.source import Source, source_from_bytes
from rpl.trivia import NOTHING, Trivia

OURS, THEIRS, SAME, MERGED, CONFLICT, REMOVED = "ours", "theirs", "same", "merged", "conflict", "removed"
_MARKS = "<<<<<<<", "=======", ">>>>>>>"


@dataclass(frozen=True, slots=True)
class Conflict:
    """What both sides changed otherwise: the line of the merged text that it begins at, and what it is, in words."""

    line: int
    words: str


@dataclass(frozen=True, slots=True)
class MergedFile:
    """One file. outcome: same, ours or theirs (only that side changed it, or both alike), merged, conflict, removed.
    data: None where it is removed."""

    path: str
    outcome: str
    data: bytes | None
    conflicts: tuple[Conflict, ...] = ()


@dataclass(frozen=True, slots=True)
class Merged:
    """All files by their names; `errors`: what reading the merged files reports and no version had."""

    files: tuple[MergedFile, ...]
    errors: tuple[Diagnostic, ...] = ()

    @property
    def clean(self) -> bool:
        """Is nothing left to decide?"""
        return not self.errors and not any(one.conflicts or one.outcome == CONFLICT for one in self.files)

    def as_json(self) -> dict[str, object]:
        """The same for machines."""
        return {
            "clean": self.clean,
            "files": [
                {
                    "file": one.path,
                    "outcome": one.outcome,
                    "conflicts": [{"line": each.line, "words": each.words} for each in one.conflicts],
                }
                for one in self.files
            ],
            "errors": [one.as_json() for one in self.errors],
        }


Files = Mapping[str, bytes]


def merged(base: Files, ours: Files, theirs: Files, dialect: str | None = None) -> Merged:
    """The files of three versions, each by its name in the project, merged."""
    return _Merging(_Version.of(base, dialect), _Version.of(ours, dialect), _Version.of(theirs, dialect), dialect).all()


@dataclass(frozen=True, slots=True)
class _Version:
    """One version: its files, what was read of them, and what stands together in each."""

    files: dict[str, Source]
    read: ReadProgram
    errors: frozenset[str]
    spans: dict[str, dict[int, tuple[int, str]]]

    @staticmethod
    def of(files: Files, dialect: str | None) -> _Version:
        sources = {path: source_from_bytes(path, data) for path, data in files.items()}
        diagnostics = Diagnostics()
        read = read_program([one for one in sources.values() if one.data.strip()], dialect, diagnostics)
        return _Version(sources, read, _errors(diagnostics), spans_of(read))


def _errors(diagnostics: Diagnostics) -> frozenset[str]:
    return frozenset(_said(one) for one in diagnostics if one.severity >= Severity.ERROR)


def _said(one: Diagnostic) -> str:
    return f"{one.code.name} {one.message}"


@dataclass(slots=True)
class _Merging:
    base: _Version
    ours: _Version
    theirs: _Version
    dialect: str | None
    changes: dict[str, dict[str, Change]] = field(default_factory=dict)

    def all(self) -> Merged:
        names = dict.fromkeys((*self.ours.files, *self.base.files, *self.theirs.files))
        files = tuple(self.file(name) for name in names)
        if any(one.conflicts or one.outcome == CONFLICT for one in files):
            return Merged(files)
        outcomes = {one.outcome for one in files}
        if outcomes <= {SAME, OURS} or outcomes <= {SAME, THEIRS}:
            return Merged(files)  # one of the versions as it is
        known = self.ours.errors | self.theirs.errors | self.base.errors
        diagnostics = Diagnostics()
        sources = [source_from_bytes(one.path, one.data) for one in files if one.data is not None and one.data.strip()]
        read_program(sources, self.dialect, diagnostics)
        new = [one for one in diagnostics if one.severity >= Severity.ERROR and _said(one) not in known]
        return Merged(files, tuple(new))

    def file(self, name: str) -> MergedFile:
        was, mine, other = (side.files.get(name) for side in (self.base, self.ours, self.theirs))
        data = [one.data if one is not None else None for one in (was, mine, other)]
        if data[1] == data[2] or data[0] == data[2]:
            outcome = SAME if data[0] == data[1] else OURS
            return MergedFile(name, REMOVED if data[1] is None else outcome, data[1])
        if data[0] == data[1]:
            return MergedFile(name, REMOVED if data[2] is None else THEIRS, data[2])
        if mine is None or other is None:
            gone = "ours removed it, theirs changed it" if mine is None else "theirs removed it, ours changed it"
            return MergedFile(name, CONFLICT, data[1] if other is None else data[2], (Conflict(1, f"{name}: {gone}"),))
        if "\0" in mine.text or "\0" in other.text:
            return MergedFile(name, CONFLICT, data[1], (Conflict(1, f"{name}: no text, and both sides changed it"),))
        return self.text(name, was, mine, other)

    def text(self, name: str, was: Source | None, mine: Source, other: Source) -> MergedFile:
        trivia = self.trivia(name)
        cut = [
            pieces(source, side.spans.get(name, {}), trivia)
            for source, side in ((was, self.base), (mine, self.ours), (other, self.theirs))
        ]
        parts = brought_together(*cut)
        keys = [[one.key for one in side] for side in cut]
        if keys[1] == keys[2] or keys[0] == keys[2]:
            return MergedFile(name, OURS, mine.data)
        if keys[0] == keys[1]:
            return MergedFile(name, THEIRS, other.data)
        text, conflicts = self.written(name, parts, _line_end(mine.text))
        text = trivia.tidied(text)
        try:
            data = text.encode(mine.encoding)
        except UnicodeEncodeError:
            reason = f"{name}: theirs has signs that {mine.encoding}, the encoding of ours, has not"
            return MergedFile(name, CONFLICT, mine.data, (Conflict(1, reason),))
        return MergedFile(name, CONFLICT if conflicts else MERGED, data, conflicts)

    def trivia(self, name: str) -> Trivia:
        for side in (self.ours, self.theirs, self.base):
            for report in side.read.files:
                if report.path == name:
                    return registry.dialect(report.dialect).trivia
        return NOTHING

    def written(self, name: str, parts: Sequence[Part], end: str) -> tuple[str, tuple[Conflict, ...]]:
        """The merged text, with marks as Git writes them where both sides changed something otherwise."""
        done: list[str] = []
        conflicts: list[Conflict] = []
        line = 1
        for part in parts:
            if isinstance(part, Clash):
                conflicts.append(Conflict(line, self.told(name, part)))
                text = _marked(part, end)
            else:
                text = _ended(part.text, end)
            done.append(text)
            line += text.count("\n") or text.count("\r")
        return "".join(done), tuple(conflicts)

    def told(self, name: str, clash: Clash) -> str:
        """What both sides changed, by its meaning where they changed one thing with a name."""
        names = dict.fromkeys(one.name for side in (clash.base, clash.ours, clash.theirs) for one in side if one.name)
        here, there = self.by_name(OURS), self.by_name(THEIRS)
        both = [one for one in names if one in here and one in there]
        if both:
            return "; ".join(f"{here[one].name}: ours {_told(here[one])}, theirs {_told(there[one])}" for one in both)
        return f"ours {_quoted(clash.ours)}, theirs {_quoted(clash.theirs)}"

    def by_name(self, side: str) -> dict[str, Change]:
        """What that side changed, by the name of what it is (in small letters)."""
        if side not in self.changes:
            found = differences(self.base.read, (self.ours if side == OURS else self.theirs).read)
            self.changes[side] = {one.name.lower(): one for one in found.changes if one.name}
        return self.changes[side]


def _told(change: Change) -> str:
    return ", ".join(change.words) or change.what


def _quoted(side: tuple[Piece, ...]) -> str:
    if not side:
        return "removed it"
    text = " ".join(" ".join(one.text for one in side).split())
    return f"`{text if len(text) <= 60 else text[:59] + '…'}`"


def _line_end(text: str) -> str:
    at = text.find("\n")
    if at < 0:
        return "\r" if "\r" in text else "\n"
    return "\r\n" if text[at - 1 : at] == "\r" else "\n"


def _ended(text: str, end: str) -> str:
    """The text with the line ends of the file that it comes to."""
    if end == "\n" and "\r" not in text:
        return text
    plain = text.replace("\r\n", "\n").replace("\r", "\n")
    return plain if end == "\n" else plain.replace("\n", end)


def _marked(clash: Clash, end: str) -> str:
    begin, between, close = _MARKS
    ours, theirs = (_closed("".join(_ended(one.text, end) for one in side), end) for side in (clash.ours, clash.theirs))
    return f"{begin} ours{end}{ours}{between}{end}{theirs}{close} theirs{end}"


def _closed(text: str, end: str) -> str:
    return text if not text or text.endswith(end) else text + end
