"""RPL's text cut into logical statements.

A line end or `;` ends a statement; inside brackets the line goes on. `--` starts a comment. A comment with an empty
line behind it stands for itself and becomes a statement of its own, so that it stays where it is.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from rpl.ir import words
from rpl.reading.pieces import BLANK, COMMENT, STATEMENT, Piece
from rpl.source import Source

# What RPL's numbers look like, and what else must not be taken apart when looking for them.
NUMBERS = re.compile(
    r'"(?:[^"\\\n\r]|\\[^\n\r])*"'
    r"|`(?:[^`\\\n\r]|\\[^\n\r])*`"
    r"|[^\W\d]\w*"
    r"|(?P<real>\d+\.\d+(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"|(?P<int>0[xX][0-9A-Fa-f]+|0[bB][01]+|\d+)"
)
_SIGN = re.compile(
    r'"(?:[^"\\\n\r]|\\[^\n\r])*"|`(?:[^`\\\n\r]|\\[^\n\r])*`|(?P<comment>--[^\n\r]*)|(?P<end>;)'
    r"|(?P<open>[(\[{])|(?P<close>[)\]}])|(?P<line>\r\n|\n|\r)"
)
_FIRST_WORD = re.compile(r"[ \t\f]*([A-Za-z]\w*)?[ \t\f]*([\r\n]|$)?")
# Words that begin a line inside brackets only when the bracket before was never closed.
_BEGINNERS = words.RESERVED - frozenset(
    ("true", "false", "not", "bnot", "on", "off", "switch", "array", "signal", "vendor", "plain")
) | {"end"}
_BLANKS = " \t\f\r\n\ufeff\x1a"


def split(source: Source) -> Iterator[Piece]:
    """The pieces of a source in order. Everything but white space is in one of them."""
    pending: Piece | None = None  # the comment that an empty line may turn into a statement of its own
    for piece in _pieces(source.text):
        if pending is not None and piece.kind == BLANK:
            yield Piece(STATEMENT, pending.end, pending.end, "NOTHING")
        pending = piece if piece.kind == COMMENT else None
        yield piece


def _pieces(text: str) -> Iterator[Piece]:
    at, length = 0, len(text)
    while at < length:
        pieces, at = _statement(text, at)
        yield from pieces


def _statement(text: str, start: int) -> tuple[list[Piece], int]:
    """One statement, comment or empty line from `start`, and where the next one begins."""
    at, depth = start, 0
    remarks: list[tuple[int, int]] = []
    while True:
        match = _SIGN.search(text, at)
        if match is None:
            return _piece(text, start, len(text), remarks, ended_by_line=True), len(text)
        at = match.end()
        match match.lastgroup:
            case "open":
                depth += 1
            case "close":
                depth = max(depth - 1, 0)
            case "comment":
                remarks.append(match.span())
            case "end" if depth == 0:
                return _piece(text, start, match.start(), remarks, ended_by_line=False, until=at), at
            case "line":
                if depth == 0 or _begins_anew(text, at):
                    return _piece(text, start, match.start(), remarks, ended_by_line=True), at


def _begins_anew(text: str, at: int) -> bool:
    match = _FIRST_WORD.match(text, at)
    if match is None or match[2] is not None:
        return match is not None and match[1] is None
    return match[1] is not None and match[1].lower() in _BEGINNERS


def _piece(
    text: str, start: int, end: int, remarks: list[tuple[int, int]], *, ended_by_line: bool, until: int = 0
) -> list[Piece]:
    """What stands in the span. `until`: the piece reaches to behind its `;`, which alone is the empty statement."""
    code = text[start:end]
    for a, b in remarks:
        code = code[: a - start] + " " * (b - a) + code[b - start :]
    stripped = code.strip(_BLANKS)
    if stripped:
        first = start + code.index(stripped[0])
        last = max(first + len(stripped), remarks[-1][1] if remarks else 0, until)
        comment = " ".join(text[a + 2 : b].strip() for a, b in remarks) if remarks else None
        return [Piece(STATEMENT, first, last, stripped, comment)]
    if remarks:
        return [Piece(COMMENT, a, b, text[a + 2 : b].strip()) for a, b in remarks]
    return [Piece(BLANK, start, end, "")] if ended_by_line else [Piece(STATEMENT, end, until, "NOTHING")]
