"""The page about a translation: the verdict, what needs somebody, source and result side by side, the checklist.

It is one file that opens from disk, loads nothing and can be printed; as Markdown it holds the same. Texts of programs
reach it escaped. The ticks of the checklist stay in the browser.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from html import escape
from importlib import resources
from pathlib import PurePath

from rpl.diagnostics import Diagnostic
from rpl.grouping import sentences, told
from rpl.project import ReadProgram
from rpl.report.checklist import Section, checklist
from rpl.report.readiness import Readiness
from rpl.source import Source
from rpl.translation import Translation
from rpl.writing.lineorigins import text_lines

# File and line of the source -> what the proof has measured there.
Measured = Mapping[tuple[str, int], Sequence[str]]
_MOST_NAMED = 3
# What Markdown takes for marks, and quotes.
_MARKS = frozenset("|`*_[]\\~\"'")


@dataclass(frozen=True, slots=True)
class Facts:
    """What is known of a translation. `proof`: lines of its proof; `measured`: deviations at lines of the source."""

    read: ReadProgram
    translation: Translation
    reports: Sequence[Diagnostic]
    ready: Readiness
    languages: tuple[str, str]
    robots: tuple[str, str] = ("", "")
    proof: Sequence[str] = ()
    measured: Measured | None = None
    followed: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Note:
    """A report at a line: its severity in a word, and what it says."""

    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a written file. `name`: the file, where several have lines beside one source."""

    name: str
    number: int
    text: str


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the source with what came of it."""

    number: int
    text: str
    written: tuple[Line, ...]
    notes: tuple[Note, ...]
    measured: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class File:
    """A file of the source, line by line."""

    path: str
    rows: tuple[Row, ...]


@dataclass(frozen=True, slots=True)
class Result:
    """A written file: its lines with the place in the source, empty where the line is of the writer's own making."""

    path: str
    lines: tuple[tuple[int, str, str], ...]


def page(facts: Facts, markdown: bool = False) -> str:
    """The whole page."""
    import jinja2

    folder = resources.files("rpl.report")
    name = "sheet.md.j2" if markdown else "sheet.html.j2"
    texts = {one: (folder / one).read_text("utf-8") for one in (name, "sheet.css", "sheet.js")}
    environment = jinja2.Environment(
        loader=jinja2.DictLoader(texts),
        autoescape=not markdown,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"cell": _cell, "words": _words}
    results, files, sections = _parts(facts)
    return environment.get_template(name).render(
        facts=facts,
        title=", ".join(dict.fromkeys(PurePath(source.path).name for source in facts.read.sources[:_MOST_NAMED])),
        told=list(told(facts.reports, followed=facts.followed)),
        files=files,
        results=results,
        sections=sections,
        identity=sha256("\n".join((*(file.path for file in files), *facts.languages)).encode()).hexdigest()[:16],
        measuring=facts.measured is not None,
        style=texts["sheet.css"],
        script=texts["sheet.js"],
    )


def _parts(facts: Facts) -> tuple[list[Result], list[File], tuple[Section, ...]]:
    origins = facts.translation.line_origins()
    results: list[Result] = []
    beside: dict[tuple[str, int], list[Line]] = {}
    for file in facts.translation.files:
        lines = []
        places = origins.get(file.path, ())
        for number, text in enumerate(text_lines(file), 1):
            origin = places[number - 1] if number <= len(places) else None
            known = origin is not None and origin.source is not None
            lines.append((number, text, f"{PurePath(origin.file).name}:{origin.line}" if origin and known else ""))
            if origin is not None and known:
                beside.setdefault((origin.file, origin.line), []).append(Line(file.path, number, text))
        results.append(Result(file.path, tuple(lines)))
    notes = _notes(facts)
    files = [
        File(source.path, tuple(_rows(source, beside, notes, facts.measured or {}))) for source in facts.read.sources
    ]
    written = {place: [line.text.strip() for line in lines] for place, lines in beside.items()}
    return results, files, checklist(facts.read, facts.translation, facts.reports, written)


def _notes(facts: Facts) -> dict[tuple[str, int], list[Note]]:
    """What the reports say at each line, the worst first."""
    found: dict[tuple[str, int], list[Diagnostic]] = {}
    for item in facts.reports:
        found.setdefault((item.origin.file, item.origin.line), []).append(item)
    return {
        place: [Note(kind.word, text) for kind, text in sentences(items, facts.followed)]
        for place, items in found.items()
    }


def _rows(
    source: Source,
    beside: Mapping[tuple[str, int], Sequence[Line]],
    notes: Mapping[tuple[str, int], Sequence[Note]],
    measured: Measured,
) -> Iterator[Row]:
    lines = source.text.replace("\r\n", "\n").replace("\r", "\n").removesuffix("\n").split("\n")
    for number, text in enumerate(lines, 1):
        at = source.path, number
        yield Row(number, text, tuple(beside.get(at, ())), tuple(notes.get(at, ())), tuple(measured.get(at, ())))


def _cell(lines: Iterable[str]) -> str:
    """Lines of code as one cell of a Markdown table."""
    return "<br>".join(f"<code>{_escaped(line)}</code>" for line in lines if line.strip())


def _words(text: str) -> str:
    """A text of people in Markdown; nothing in it is taken for a mark."""
    return _escaped(" ".join(text.split()))


def _escaped(text: str) -> str:
    """Signs that HTML or Markdown would take for something else as references, the indentation kept."""
    inner = text.lstrip()
    blanks = "&nbsp;" * len(text[: len(text) - len(inner)].expandtabs(8))
    return blanks + "".join(f"&#{ord(sign)};" if sign in _MARKS else sign for sign in escape(inner, quote=False))
