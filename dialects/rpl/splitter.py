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
_NEXT = re.compile(r"[ \t\f]*(?:([^\W\d]\w*)|([\w\"`$#])|([\r\n]|$))?")
_LAST = re.compile(r"([^\W\d]\w*)$|[\w\")\]}`]$")
# Words that begin a line inside brackets only when the bracket before was never closed.
_BEGINNERS = words.RESERVED - frozenset(
    ("true", "false", "not", "bnot", "on", "off", "switch", "array", "signal", "vendor", "plain")
) | {"end"}
_ASSIGNMENT = re.compile(
    r"[ \t\f]*\$?(?:[^\W\d]\w*|`(?:[^`\\\n\r]|\\[^\n\r])*`)(?:\.[^\W\d]\w*|\[[^\]\n\r]*\])*[ \t]*="
)
# Words between operands: a line may end or begin with them.
_BETWEEN = frozenset(("and", "or", "xor", "then", "else", "not", "bnot", "div", "mod", "quo", "band", "bor", "bxor"))
_BETWEEN |= {"as", "to", "of", "from", "if", "switch"}
_LONGEST_WORD = 200
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
                code_end = remarks[-1][0] if remarks and remarks[-1][1] == match.start() else match.start()
                if depth == 0 or _begins_anew(text, start, code_end, at):
                    return _piece(text, start, match.start(), remarks, ended_by_line=True), at


def _begins_anew(text: str, start: int, end: int, at: int) -> bool:
    """Is a bracket that is open at the end of the line `start:end` a mistake, because a new statement begins at `at`?
    So it is at an empty line, before an assignment or a keyword of a statement, and where two operands would stand side
    by side."""
    match = _NEXT.match(text, at)
    if match is None or match[3] is not None or _ASSIGNMENT.match(text, at):
        return True
    word = (match[1] or "").lower()
    if word in _BEGINNERS:
        return True
    if (match[1] is None and match[2] is None) or word in _BETWEEN:
        return False
    last = _LAST.search(text[max(start, end - _LONGEST_WORD) : end].rstrip())
    return last is not None and (last[1] or "").lower() not in _BETWEEN


def _piece(
    text: str, start: int, end: int, remarks: list[tuple[int, int]], *, ended_by_line: bool, until: int = 0
) -> list[Piece]:
    """What stands in the span. `until`: the piece reaches to behind its `;`, which alone is the empty statement."""
    code = text[start:end]
    for a, b in remarks:
        code = code[: a - start] + " " * (b - a) + code[b - start :]
    stripped = code.strip(_BLANKS)
    # The piece covers a byte order mark or an end-of-file sign around its text, too.
    first = start + len(code) - len(code.lstrip())
    last = max(start + len(code.rstrip()), remarks[-1][1] if remarks else 0, until)
    if stripped:
        comment = " ".join(text[a + 2 : b].strip() for a, b in remarks) if remarks else None
        return [Piece(STATEMENT, first, last, stripped, comment)]
    if remarks:
        return [Piece(COMMENT, a, b, text[a + 2 : b].strip()) for a, b in remarks]
    if code.strip():
        return [Piece(STATEMENT, first, last, "NOTHING")]
    return [Piece(BLANK, start, end, "")] if ended_by_line else [Piece(STATEMENT, end, until, "NOTHING")]
