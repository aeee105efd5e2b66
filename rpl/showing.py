"""How results show themselves in an interactive session: one short line, and a small table in a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

MOST_ROWS = 50
MOST_LINES = 200


def counted(number: int, one: str, many: str | None = None) -> str:
    """`1 move`, `3 moves`."""
    return f"{number} {one if number == 1 else many or one + 's'}"


def line(kind: str, parts: Iterable[str]) -> str:
    """`<Kind: part, part>`, what `repr` gives; signs that would steer a terminal stand as escapes."""
    return printable(f"<{kind}: {', '.join(part for part in parts if part)}>")


def printable(text: str) -> str:
    """The text with signs that would steer a terminal as escapes, such as \\x1b."""
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else sign.encode("unicode_escape").decode("ascii") for sign in text)


def printable_lines(text: str) -> str:
    """The same of a text of several lines: line ends and tabs stay."""
    parts = (part.split("\t") for part in text.replace("\r\n", "\n").split("\n"))
    return "\n".join("\t".join(printable(one) for one in line) for line in parts)


def heading(kind: str, parts: Iterable[str]) -> str:
    """The same as the head of a notebook's output. Everything is escaped."""
    return f"<p><b>{escape(kind)}</b> {escape(', '.join(part for part in parts if part))}</p>"


def table(columns: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table of at most MOST_ROWS rows, saying how many are left out; nothing without rows."""
    if not rows:
        return ""
    head = "".join(f"<th>{escape(column)}</th>" for column in columns)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(value))}</td>" for value in row) + "</tr>" for row in rows[:MOST_ROWS]
    )
    left = len(rows) - MOST_ROWS
    more = f"<p>and {left} more</p>" if left > 0 else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def folded(title: str, text: str) -> str:
    """A text that opens on a click, at most MOST_LINES lines of it."""
    lines = text.splitlines()
    left = len(lines) - MOST_LINES
    shown = "\n".join([*lines[:MOST_LINES], *([f"({left} more lines)"] if left > 0 else [])])
    return f"<details><summary>{escape(title)}</summary><pre>{escape(shown)}</pre></details>"
