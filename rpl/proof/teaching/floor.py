"""What was taught on the floor since a program was written: its points, tools and frames stay when it is written anew.

The files of an earlier translation lie in their folder as the controller gave them back. What differs there from what
that translation had written (its map has the values) was touched up by somebody, and its text goes into the new files
in place of the new one. Without such a record nobody can tell who changed a value, and the floor's counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.errors import UsageError
from rpl.passes import rigid
from rpl.project import ReadProgram, read_program, read_sources
from rpl.proof.teaching.data import NUMBER, Datum, taught_data
from rpl.proof.teaching.pairs import key_of
from rpl.source import Origin, source_from_bytes
from rpl.writing.target import OutputFile

KEPT = code(
    "kept-taught",
    Severity.INFO,
    "{name} was taught anew in {file} ({how}), and that value stays",
    several="{count} data were taught anew, and these values stay: [{name} ({how})]",
)
BOTH = code(
    "taught-twice",
    Severity.WARNING,
    "{name} was taught anew in {file}, and the source has another value too; the one of {file} stays",
    "look which of them is right",
)
LOST = code(
    "taught-not-kept",
    Severity.WARNING,
    "{name} was taught anew in {file} ({how}), and its line there does not fit here: the new value is written",
    "teach it once more, or write the value by hand",
)
_SAME = 1e-4  # mm, deg or unit: more than what the writers round away


@dataclass(frozen=True, slots=True)
class Floor:
    """files: with what was taught anew; values: of all taught data as the translation itself has them, by key."""

    files: tuple[OutputFile, ...]
    values: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class _Change:
    """A datum that was taught anew. both: the source has another value than before as well."""

    key: str
    ours: Datum
    theirs: Datum
    both: bool

    @property
    def span(self) -> tuple[int, int]:
        return self.ours.owner.origin.start, self.ours.owner.origin.end

    @property
    def text(self) -> str | None:
        """The statement as it lies there."""
        there = self.theirs.owner.origin
        return None if there.source is None else there.source.text[there.start : there.end]


def with_floor(
    files: Sequence[OutputFile], target: str, folder: Path, recorded: Mapping[str, str], diagnostics: Diagnostics
) -> Floor:
    """The written files with what is taught otherwise in `folder`. recorded: the values that the earlier translation
    wrote (Floor.values of it); empty: they are not known. Raises UsageError when what lies in the folder cannot be
    read."""
    ours = _by_key(_read_back(files, target))
    values = {key: _text(datum) for key, datum in ours.items()}
    if not folder.exists():
        return Floor(tuple(files), values)
    theirs = _by_key(_lying_in(folder, target))
    found: list[_Change] = []
    for key, datum in ours.items():
        there = theirs.get(key)
        if there is None or _same(_numbers(datum), _numbers(there)):
            continue
        before = recorded.get(key)
        if before is not None and _same(_read(before), _numbers(there)):
            continue  # nobody has touched it: the source has another value now
        found.append(_Change(key, datum, there, before is not None and not _same(_read(before), _numbers(datum))))
    changed, kept = _written(files, target, ours, found)
    for one in found:
        what = LOST if one.key not in kept else BOTH if one.both else KEPT
        how, place = _apart(one.ours, one.theirs), one.theirs.place.file
        diagnostics.report(what, one.ours.owner.origin, name=one.ours.name, file=place, how=how)
    return Floor(changed, values)


def _written(
    files: Sequence[OutputFile], target: str, ours: Mapping[str, Datum], changes: Sequence[_Change]
) -> tuple[tuple[OutputFile, ...], set[str]]:
    """The files with these changes, and which of them are there when the files are read: a change that comes out
    otherwise, or that changes anything else, is left out."""
    left = {one.key: one for one in changes if one.text is not None}
    while left:
        done = tuple(_changed(one, left.values()) for one in files)
        now = _by_key(_read_back(done, target))
        wanted = {key: _numbers(left[key].theirs if key in left else datum) for key, datum in ours.items()}
        wrong = {key for key, value in wanted.items() if key not in now or not _same(value, _numbers(now[key]))}
        if not wrong and now.keys() == ours.keys():
            return done, set(left)
        left = {key: one for key, one in left.items() if key not in wrong} if wrong & left.keys() else {}
    return tuple(files), set()


def _read_back(files: Iterable[OutputFile], target: str) -> ReadProgram:
    return read_sources([source_from_bytes(one.path, one.data) for one in files], target, Diagnostics())


def _lying_in(folder: Path, target: str) -> ReadProgram:
    told = Diagnostics()
    found = read_program([folder], target, told)
    errors = told.of(Severity.ERROR)
    if errors:
        raise UsageError(
            f"{folder}: what lies there cannot be read, so nobody knows what was taught: {errors[0].as_text()}"
        )
    return found


def _by_key(read: ReadProgram) -> dict[str, Datum]:
    """Places, joints, tools and frames; numbers are what programs count with."""
    return {key_of(one): one for one in taught_data(read.program) if one.kind != NUMBER and _stands(one.owner.origin)}


def _stands(origin: Origin) -> bool:
    return origin.source is not None and origin.end > origin.start


def _numbers(datum: Datum) -> tuple[float, ...]:
    """mm and the nine numbers of the rotation, or joints in degrees: what can be compared without signs that mean the
    same."""
    match datum.value:
        case rigid.Pose() as pose:
            return tuple(float(one) for row in pose.matrix[:3] for one in row)
        case tuple() as joints:
            return joints
        case number:
            return (number,)


def _text(datum: Datum) -> str:
    return " ".join(f"{one:.7g}" for one in _numbers(datum))


def _read(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(one) for one in text.split())
    except ValueError:
        return ()


def _same(one: Iterable[float], other: Iterable[float]) -> bool:
    first, second = tuple(one), tuple(other)
    return len(first) == len(second) and all(
        abs(a - b) <= _SAME * max(1.0, abs(a)) for a, b in zip(first, second, strict=True)
    )


def _apart(one: Datum, other: Datum) -> str:
    match one.value, other.value:
        case rigid.Pose() as a, rigid.Pose() as b:
            way = a.inverse.then(b)
            return f"{way.position.length:.3g} mm, {way.rotation.angle:.3g} deg away"
        case tuple() as a, tuple() as b if len(a) == len(b):
            return f"joints up to {max(abs(p - q) for p, q in zip(a, b, strict=True)):.3g} deg away"
    return "of another kind"


def _changed(file: OutputFile, changes: Iterable[_Change]) -> OutputFile:
    """The file with the texts of these data, as far as they stand in it. Data of one statement have one text."""
    spans = {one.span: one.text for one in changes if one.ours.owner.origin.file == file.path}
    if not spans:
        return file
    source = source_from_bytes(file.path, file.data)
    text = source.text
    for (start, end), other in sorted(spans.items(), reverse=True):
        text = f"{text[:start]}{other}{text[end:]}"
    return OutputFile(file.path, text.encode(source.encoding))


__all__ = ["Floor", "with_floor"]
