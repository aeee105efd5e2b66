"""INFORM source text to pieces: one statement per line, `'` starts a comment line, `//` a remark behind an instruction.

Which lines are what follows the sections of a job (`//POS`, `//ARGINFO`, `//INST`): the descriptions of arguments are
layout, and a remark can only stand behind an instruction.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from rpl.reading.pieces import COMMENT, LAYOUT, STATEMENT, Piece
from rpl.source import Source

# What is taken out of a line's shape: numbers, texts, and the names of numbered variables and points.
_START = r"(?:(?<![A-Za-z0-9_$#.])|(?<=ARGF))"
SHAPE = re.compile(
    r"\A[ \t]*/.*|\A[ \t]*\*\S+|(?<=JUMP)[ \t]+\*\S+"
    r"|(?:JOB|LABEL):[ \t]*[^\s,()\[]+"
    r'|(?P<text>"[^"\n]*")'
    rf"|{_START}(?:(?P<name>L?(?:PX|BP|EX|BC|EC|RC|[BIDRSPC])\d+(?![\w$#]))"
    r"|(?P<real>\d+\.\d*|\.\d+)|(?P<int>\d+))",
    re.IGNORECASE,
)
SLOTS = {"real": ("REAL", "0.5"), "int": ("INT", "0"), "name": ("NAME", "B0"), "text": ("TEXT", '""')}

_LINE = re.compile(r"[^\r\n]+")
_CODE = re.compile(r'(?:[^/"]|/(?!/)|"[^"]*(?:"|$))*')
_BLANKS = " \t\f\ufeff\u00a0\x1a\x00"
_DISABLED = re.compile(r"COMM[ \t]+[A-Za-z]", re.IGNORECASE)


def code_of(text: str) -> str:
    """A statement's text without the remark behind it."""
    if text.lstrip().startswith("/"):
        return text.strip(_BLANKS)
    found = _CODE.match(text)
    return (found.group() if found else text).strip(_BLANKS)


def split(source: Source) -> Iterator[Piece]:
    """The pieces of a job file."""
    described = False  # within the free lines behind `///COMMENT` of //ARGINFO
    for match in _LINE.finditer(source.text):
        line, start = match.group(), match.start()
        body = line.strip(_BLANKS)
        if not body:
            if line.strip():
                yield Piece(LAYOUT, start, match.end(), "")
            continue
        at = start + line.index(body[0])
        end = at + len(body)
        if line[0] in "\ufeff\x1a\x00" or line[-1] in "\x1a\x00":
            at, end = start, match.end()
        if body[0] == "/":
            described = body.upper().startswith("///COMMENT")
            yield Piece(STATEMENT, at, end, body)
        elif described:
            yield Piece(LAYOUT, at, end, body)
        elif body[0] == "'":
            yield Piece(COMMENT, at, end, body[1:])
        elif _DISABLED.match(body):
            yield Piece(COMMENT, at, end, body)
        else:
            yield _instruction(body, at, end)


def _instruction(body: str, at: int, end: int) -> Piece:
    code = code_of(body)
    if len(code) == len(body):
        return Piece(STATEMENT, at, end, body)
    remark = body[body.index("//", len(code)) + 2 :]
    if not code:
        return Piece(COMMENT, at, end, remark)
    return Piece(STATEMENT, at, end, code, remark)
