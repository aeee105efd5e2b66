"""The code of a program file to pieces: one statement a line, `//` begins a comment outside of texts.

The XML around the code, and all of the other files, is layout: what it says is read elsewhere (`facts`, `data`).
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterator

from rpl.reading.pieces import AROUND, COMMENT, STATEMENT, Piece
from rpl.source import Source

from .facts import Header

_LINE = re.compile(r"[^\r\n]+")
_CODE = re.compile(r'(?:[^/"]|"(?:[^"\\\r\n]|\\.)*(?:"|$)|/(?!/))*')
_BLANKS = " \t\f\ufeff\u00a0"


def code_of(text: str) -> str:
    """A line's text without the comment behind it."""
    found = _CODE.match(text)
    return (found[0] if found else text).strip(_BLANKS)


def split(source: Source, headers: tuple[Header, ...]) -> Iterator[Piece]:
    """The pieces of a file."""
    at = 0
    for header in headers:
        yield from _around(source, at, header.start)
        for match in _LINE.finditer(source.text, header.start, header.end):
            yield from _line(match[0], match.start(), header.plain)
        at = header.end
    yield from _around(source, at, len(source.text))


def _around(source: Source, start: int, end: int) -> Iterator[Piece]:
    if source.text[start:end].strip(_BLANKS + "\r\n"):
        yield Piece(AROUND, start, end, "")


def _line(line: str, start: int, plain: bool) -> Iterator[Piece]:
    body = line.strip(_BLANKS)
    if not body:
        return
    at = start + line.index(body[0])
    end = at + len(body)
    text = body if plain else html.unescape(body)
    found = _CODE.match(text)
    length = found.end() if found else len(text)
    code, comment = text[:length].rstrip(_BLANKS), text[length + 2 :] if length < len(text) else None
    if not code:
        yield Piece(COMMENT, at, end, comment or "")
    else:
        yield Piece(STATEMENT, at, end, code, comment)
