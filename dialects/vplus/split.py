"""V+ source text to pieces: one step per line, an optional number in front of it, `;` starts a comment.

Every block of V+ ends with the same word END, so the splitter keeps account of the words that open blocks: `Outline`
tells for each line that divides or ends a block which line opened it. A step that cannot be read then never shifts the
ends of the blocks around it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl.reading.pieces import COMMENT, LAYOUT, STATEMENT, Piece
from rpl.source import Source

# What is taken out of a statement's shape: free-standing numbers only. Names contain points and digits.
SHAPE = re.compile(
    r'"[^"\r\n]*"'
    r"|'."
    r"|\^[BbHh]?[0-9A-Fa-f]+"
    r"|/[A-Za-z][0-9]*(?:\.[0-9]+)?"
    r"|[$#%]?[A-Za-z_][\w.]*"
    r"|(?P<real>(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"|(?P<int>\d+)"
)
_LINE = re.compile(r"[^\r\n]+")
_CODE = re.compile(r"""(?:[^;"']|"[^"]*(?:"|$)|'.?)*""")
_BLANKS = " \t\f\ufeff\u00a0\x1a\x00"
_MARKS = re.compile("[\ufeff\x1a\x00]")
_LABEL = re.compile(r"(\d+)(?=\s|$)")
_FIRST_WORD = re.compile(r"\.?[A-Za-z_][\w.]*")
_VALUE_LINE = re.compile(r"""VALUE\b(?:[^:"']|"[^"]*"|'.)*:""", re.IGNORECASE)
_SECTIONS = frozenset((".LOCATIONS", ".REALS", ".DOUBLES", ".STRINGS"))
OPENERS = frozenset(("IF", "CASE", "FOR", "WHILE", "DO"))
_NOTED = OPENERS | _SECTIONS | {".PROGRAM", ".END", "ELSE", "VALUE", "ANY", "END", "UNTIL"}
_SIGNS = re.compile("[;\"']")


@dataclass(slots=True)
class Outline:
    """Which block each line belongs to. `kinds`: start of an opening line -> the word for its block; `owner`: start of
    a dividing or ending line -> the word for the block it divides or ends."""

    kinds: dict[int, str] = field(default_factory=dict)
    owner: dict[int, str] = field(default_factory=dict)
    open: list[tuple[str, str]] = field(default_factory=list)  # opening word, block kind
    section: str = ""

    def note(self, text: str, start: int, line: int) -> None:
        """Take note of one statement."""
        found = _FIRST_WORD.match(text)
        word = found.group().upper() if found else ""
        if word not in _NOTED:
            return
        if re.match(r"\s*(?:=(?!=)|\[)", text[len(word) :]):
            return  # a variable called like a word of the language
        if word == ".PROGRAM":
            self.open.clear()
        elif word == ".END":
            self.open.clear()
            self.section = ""
        elif word in _SECTIONS:
            self.section = word
        elif word in OPENERS and _opens(word, text):
            kind = f"{word} (line {line})"
            self.kinds[start] = kind
            self.open.append((word, kind))
        elif word == "ELSE":
            self._divides(start, "IF")
        elif word in ("VALUE", "ANY"):
            self._divides(start, "CASE")
        elif word == "END":
            self._ends(start, lambda opener: opener != "DO")
        elif word == "UNTIL":
            self._ends(start, lambda opener: opener == "DO")

    def _divides(self, start: int, opener: str) -> None:
        for word, kind in reversed(self.open):
            if word == opener:
                self.owner[start] = kind
                return

    def _ends(self, start: int, fits: object) -> None:
        assert callable(fits)
        for at in range(len(self.open) - 1, -1, -1):
            if fits(self.open[at][0]):
                self.owner[start] = self.open[at][1]
                del self.open[at:]
                return


def _opens(word: str, text: str) -> bool:
    """Does the line open a block? `IF ... GOTO n` does not."""
    rest = text[len(word) :].lstrip()
    if word == "IF":
        return re.search(r"(?<![\w.])THEN\s*$", text, re.IGNORECASE) is not None
    return word != "DO" or not rest


def code_of(text: str) -> str:
    """A step's text without the comment behind it."""
    found = _CODE.match(text)
    return (found.group() if found else text).strip(_BLANKS)


def split(source: Source, outline: Outline) -> Iterator[Piece]:
    """The pieces of a V+ file; fills the outline on the way."""
    for number, match in enumerate(_LINE.finditer(source.text), 1):
        yield from _line(match.group(), match.start(), number, source, outline)


def _line(line: str, start: int, number: int, source: Source, outline: Outline) -> Iterator[Piece]:
    body = line.strip(_BLANKS)
    if not body:
        if line.strip():
            yield Piece(LAYOUT, start, start + len(line), "")
        return
    at = start + line.index(body[0])
    end = at + len(body)
    if _MARKS.search(line):  # an end sign of old editors: part of the line it stands on
        at, end = start, start + len(line)
        body = line
    if body.strip(_BLANKS).startswith(";"):
        yield Piece(COMMENT, at, end, body.strip(_BLANKS)[1:].rstrip())
        return
    found = _CODE.match(body) if _SIGNS.search(body) else None
    code = found.group() if found else body
    comment = body[len(code) + 1 :].rstrip(_BLANKS) if len(code) < len(body) else None
    text = code.strip(_BLANKS)
    if outline.section and not text.startswith("."):
        yield Piece(STATEMENT, at, end, f"@DATA {text}", comment)
        return
    line_number = source.position(at)[0]
    parts = list(_parts(code, at))
    parts[0] = (at, parts[0][1])
    for position, (begin, piece) in enumerate(parts):
        last = position == len(parts) - 1
        outline.note(piece, begin, line_number)
        stop = end if last else parts[position + 1][0]
        text = f"@LABEL {piece}" if piece.isdigit() else piece
        yield Piece(STATEMENT, begin, stop, text, comment if last else None)


def _parts(code: str, at: int) -> Iterator[tuple[int, str]]:
    """A line's label, its step, and what stands behind the colon of VALUE, each with its offset."""
    rest = code
    offset = at + len(code) - len(code.lstrip(_BLANKS))
    rest = code.strip(_BLANKS)
    label = _LABEL.match(rest) if rest[:1].isdigit() else None
    if label:
        yield offset, label.group()
        tail = rest[label.end() :]
        offset += label.end() + len(tail) - len(tail.lstrip(_BLANKS))
        rest = tail.strip(_BLANKS)
    head = _VALUE_LINE.match(rest) if ":" in rest else None
    if head and rest[head.end() :].strip(_BLANKS):
        yield offset, head.group()
        tail = rest[head.end() :]
        offset += head.end() + len(tail) - len(tail.lstrip(_BLANKS))
        rest = tail.strip(_BLANKS)
    if rest or not label:
        yield offset, rest
