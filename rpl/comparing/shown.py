"""What two projects differ in, as lines for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import PurePath

from rpl.comparing.changes import ADDED, CHANGED, REMOVED, Change, Differences, Spot
from rpl.showing import counted

_TITLES = {
    "file": "files",
    "routine": "routines",
    "point": "points",
    "frame": "frames",
    "tool": "tools",
    "load": "loads",
    "speed": "speeds, accelerations and corners",
    "io": "signals",
    "logic": "statements",
    "data": "data",
    "header": "headers",
    "text": "other lines",
    "comment": "comments",
}
_ONE = {
    "file": "file",
    "routine": "routine",
    "point": "point",
    "frame": "frame",
    "tool": "tool",
    "load": "load",
    "speed": "speed",
    "io": "signal statement",
    "logic": "statement",
    "data": "datum",
    "header": "header",
    "text": "other line",
    "comment": "comment",
}
_MANY = {"data": "data", "text": "other lines"}
_WIDEST = 100  # signs of a statement that are shown

# How a text is coloured and made harmless: (text, added | removed | changed | title | other) -> text.
Paint = Callable[[str, str], str]


@dataclass(frozen=True, slots=True)
class Shown:
    """How much is shown. `paint` colours a text for what it says."""

    paint: Paint
    comments: bool = True


def lines(found: Differences, shown: Shown) -> Iterator[str]:
    """Kind by kind, each change on a line or two, and a summary."""
    changes = [one for one in found.changes if shown.comments or one.kind != "comment"]
    for kind, title in _TITLES.items():
        some = [one for one in changes if one.kind == kind]
        if some:
            yield shown.paint(f"{title}:", "title")
            where = ""
            for one in some:
                if _where(one) != where:
                    where = _where(one)
                    if where:
                        yield f"  {shown.paint(where, 'other')}"
                yield from ("  " + ("  " if where else "") + line for line in _lines(one, shown.paint))
    yield shown.paint(summary(found, shown.comments), "title")


def summary(found: Differences, comments: bool = True) -> str:
    """One line: what differs how often."""
    counts = {kind: count for kind, count in found.counts.items() if comments or kind != "comment"}
    parts = [counted(count, _ONE[kind], _MANY.get(kind)) for kind, count in counts.items()]
    if not found.same:
        return f"differs: {', '.join(parts)}"
    more = [*parts, counted(found.meaningless, "place") + " written otherwise"] if found.meaningless else parts
    return "the same meaning" + (f"; {', '.join(more)}" if more else "")


def _where(change: Change) -> str:
    return change.routine if change.kind not in ("file", "routine") else ""


def _lines(change: Change, paint: Paint) -> Iterator[str]:
    sign = {ADDED: "+", REMOVED: "-", CHANGED: "~"}[change.what]
    words = ", ".join(change.words)
    places = _places(change)
    if change.name:
        yield paint(f"{sign} {change.name}{': ' if words else ''}{words}{places}", change.what)
        return
    if change.what != CHANGED:
        one = change.a or change.b
        yield paint(f"{sign} {_short(one)}{places}", change.what)
        return
    yield paint(f"{sign} {_short(change.a)}", change.what)
    yield paint(f"  → {_short(change.b)}{places}", change.what)
    if words:
        yield paint(f"    {words}", change.what)


def _short(place: Spot | None) -> str:
    text = place.text if place is not None else ""
    return text if len(text) <= _WIDEST else text[: _WIDEST - 1] + "…"


def _places(change: Change) -> str:
    """Where it stands: on both sides, the line alone where the file has one name on both."""
    a, b = change.a, change.b
    if a is None or b is None:
        one = a or b
        return f"  ({PurePath(one.file).name}:{one.line})" if one is not None else ""
    left, right = PurePath(a.file).name, PurePath(b.file).name
    if left == right:
        return f"  ({left}:{a.line})" if a.line == b.line else f"  ({left}:{a.line} → {b.line})"
    return f"  ({left}:{a.line} → {right}:{b.line})"
