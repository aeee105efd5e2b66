"""KRL source text to pieces: one statement per line, `;` starts a comment anywhere but inside a text.

Fold lines and the parameter data of inline forms live in comments; they are kept whole, as trivia. `&` lines are
statements of the file header.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from rpl.reading.pieces import COMMENT, LAYOUT, STATEMENT, Piece
from rpl.reading.runs import Cursor
from rpl.source import Source

# What is taken out of a statement's shape. Names that contain digits (XP12, PPDAT3) and texts vary from line to line
# like numbers do; names in front of a bracket are calls and stay, because they decide what the statement means.
# Whatever is not matched stays in the shape: names without digits need no match.
SHAPE = re.compile(
    r"\A[ \t]*(?:&|(?i:EXT|EXTP|EXTERNAL|EXTERNALP|EXTFCT|EXTFCTP|EXTERNALFCT|EXTERNALFCTP|IMPORT|CHANNEL)\b"
    r"|(?i:STOP|CONFIRM|ASYPTP|ASYCONT|ASYSTOP|ASYCANCEL)[ \t]+(?![=\[(.])).*"
    r'|(?P<text>"[^"\n]*")'
    r"|'[^'\n]*'|#[ \t]*[A-Za-z_$][\w$]*"
    r"|(?<![\w$])(?:(?P<name>(?!(?i:E6(?:POS|AXIS)|[AE]\d|ORI\d)\b)[A-Za-z_]++\d[\w$]*+(?!\s*\())"
    r"|(?P<real>(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"|(?P<int>\d+))"
)
SLOTS = {"real": ("REAL", "0.5"), "int": ("INT", "0"), "name": ("NAME", "n0"), "text": ("TEXT", '""')}

_LINE = re.compile(r"[^\r\n]+")
_CODE = re.compile(r'(?:[^;"]|"[^"]*(?:"|$))*')
# What the editor keeps for itself: folds, and what the dialogs of inline forms (KSS 8) hold.
_EDITORS = ("FOLD", "ENDFOLD", "PARAMS ILFPROVIDER=")
_MARKS = re.compile("[\ufeff\x1a\x00]")
_BLANKS = " \t\f\ufeff\u00a0\x1a\x00"


def code_of(text: str) -> str:
    """A statement's text without the comment behind it."""
    found = _CODE.match(text)
    return (found.group() if found else text).strip(_BLANKS)


def split(source: Source, cursor: Cursor | None = None) -> Iterator[Piece]:
    """The pieces of a KRL file; behind each piece it goes on at the cursor where that has been set further on."""
    cursor = cursor or Cursor()
    while (match := _LINE.search(source.text, cursor.at)) is not None:
        line, start = match.group(), match.start()
        cursor.at = match.end()
        body = line.strip(_BLANKS)
        if not body:
            if line.strip():
                yield Piece(LAYOUT, start, match.end(), "")
            continue
        at = start + line.index(body[0])
        end = at + len(body)
        if _MARKS.search(line):  # a byte order mark, the end sign of old editors: part of the line they stand on
            at, end = start, match.end()
        if body[0] == ";":
            said = body[1:].lstrip().upper()
            kind = LAYOUT if said.startswith(_EDITORS) else COMMENT
            yield Piece(kind, at, end, body[1:])
        elif ";" in body and body[0] != "&":
            code = _CODE.match(body)
            length = code.end() if code else len(body)
            comment = body[length + 1 :] if length < len(body) else None
            yield Piece(STATEMENT, at, end, body[:length].rstrip(_BLANKS), comment)
        else:
            yield Piece(STATEMENT, at, end, body)
