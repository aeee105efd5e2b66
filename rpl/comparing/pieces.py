"""A file cut into the pieces that a merge takes whole: each line, or the lines of one declaration or statement.

A piece keeps its bytes as text; its key leaves out what means nothing, so that a date or a number of a line is no edit.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rpl import ir, registry
from rpl.comparing.listing import listing
from rpl.depth import at_any_depth
from rpl.project import ReadProgram
from rpl.source import Origin, Source
from rpl.trivia import NOTHING, Trivia


@dataclass(frozen=True, slots=True)
class Piece:
    """Lines that belong together. `name`: what they declare, for a point or another datum, in small letters where the
    language folds them."""

    key: str
    text: str
    line: int
    name: str = ""


def pieces(source: Source | None, spans: dict[int, tuple[int, str]], trivia: Trivia) -> list[Piece]:
    """The pieces of a file; none of no file. spans: first line (from 0) -> last one, name."""
    if source is None:
        return []
    lines = source.text.splitlines(keepends=True)
    found, at = [], 0
    while at < len(lines):
        last, name = spans.get(at, (at, ""))
        text = "".join(lines[at : last + 1])
        found.append(Piece(_key(lines[at : last + 1], trivia), text, at + 1, name))
        at = max(at, last) + 1
    return found


def _key(lines: list[str], trivia: Trivia) -> str:
    if len(lines) == 1:
        attribute = trivia.attribute(lines[0])
        return f"\0{attribute}" if attribute else trivia.key(lines[0])
    return "\n".join(trivia.key(line) for line in lines)


def spans_of(read: ReadProgram) -> dict[str, dict[int, tuple[int, str]]]:
    """What stands together in each file: path -> first line (from 0) -> last line, name of what is declared there."""
    return at_any_depth(lambda: _spans(read))


def _spans(read: ReadProgram) -> dict[str, dict[int, tuple[int, str]]]:
    found: dict[str, dict[int, tuple[int, str]]] = {}
    for module in read.reduced.modules:
        rules = registry.dialect(module.dialect).rules()
        for origin, name in _places(module):
            source = origin.source
            if source is None or origin.end <= origin.start:
                continue
            first, last = source.position(origin.start)[0] - 1, source.position(origin.end - 1)[0] - 1
            if last > first or name:
                word = name if rules.case_sensitive else name.lower()
                found.setdefault(source.path, {}).setdefault(first, (last, word))
    return found


def _places(module: ir.Module) -> Iterator[tuple[Origin, str]]:
    """Declarations with their names, behind the statements: what a statement declares by the way is no declaration."""
    lists = [listing(routine, NOTHING) for routine in module.routines]
    for one in lists:
        for unit in one.units:
            if unit.run is None and not unit.mark:
                yield Origin(unit.source, unit.start, unit.end), ""
    statements = {(id(unit.source), unit.start) for one in lists for unit in one.units}
    for routine in (None, *module.routines):
        for declared in module.declarations if routine is None else routine.declarations:
            origin = declared.origin
            if (id(origin.source), origin.start) in statements:
                continue
            if routine is not None and origin.start == routine.origin.start:
                continue  # declared by the head of the routine
            match declared:
                case ir.Initialise():
                    yield origin, " ".join(origin.text.partition("=")[0].split())
                case ir.Unread():
                    yield origin, ""
                case _:
                    yield origin, declared.name
