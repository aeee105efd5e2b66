"""A .LS listing to pieces: header, numbered statements, positions, end.

A statement begins at `nn:` and ends with `;`; text behind an unnumbered colon goes on where the line before did not end
(the second point of an arc, long conditions). The lines of a SELECT belong to one statement. Comments in brackets
(`R[1:count]`) are taken out of the text to parse; `notes` finds them. Remarks begin with `!` or `--`, disabled lines
with `//`; both are comments.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from rpl.reading.pieces import COMMENT, LAYOUT, STATEMENT, Piece
from rpl.source import Source

from .words import english, is_german

HEADER, POSITIONS, END, MACRO = "/PROG", "/POS", "/END", "@"

# What is taken out of a statement's shape: numbers alone. Words that end in a number (CNT50) are split, names of
# programs are not.
SHAPE = re.compile(
    r"\A@.*|\bMESSAGE\s*\[.*"
    r"|'[^'\n]*'"
    r"|(?:CNT|ACC|CR|CD|EV|PSPD|RT_LD|AP_LD|DIV|MOD)(?=\d)"
    r"|\$(?:\[[*\w]+\])?[\w$.]*(?:\[[^\]]*\][\w$.]*)*"
    r"|(?i:(?:CALL|RUN|MONITOR(?:\s+END)?|ERROR_PROG\s*=|RESUME_PROG\s*=|MAINT_PROG\s*=)\s*[A-Za-z_\u0080-\uffff][-\w]*)"
    r"|[A-Za-z_\u0080-\uffff][\w$]*"
    r"|(?P<real>(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<int>\d+)"
)

_HEAD = re.compile(r"^[ \t\ufeff]*/PROG\b", re.MULTILINE)
_SECTION = re.compile(r"^[ \t]*/(MN|POS|END)\b[^\n]*", re.MULTILINE)
_LINE = re.compile(r"[^\r\n]+")
_NUMBERED = re.compile(r"([ \t]*)(\d*)[ \t]*:(?!=)")
_DASHES = re.compile(r"[ \t]*-{3,}[ \t]*;?[ \t]*\Z")
_REMARK = ("!", "--")
_SELECT = re.compile(r"SELECT\b", re.IGNORECASE)
_SELECT_NEXT = re.compile(r"(?:=|ELSE\s*,)", re.IGNORECASE)
_POINT = re.compile(r"P\s*\[\s*\d+[^\{]*?\]\s*\{.*?\}\s*;?", re.DOTALL)
_INDEXED_NOTE = re.compile(r"\[\s*(?:GP\d+\s*:\s*)?[^\[\]:']*?(:)")
_BLANKS = " \t\f\v\ufeff\u00a0\x00\x1a"

# First words of the statements that the grammar knows; any other word begins an application's or a macro instruction.
_KNOWN = re.compile(
    r"""(?ix)
    (?:[JLCAS]\s+(?:P|PR)\s*\[)
    |(?:R|PR|SR|P|AR|DI|DO|RI|RO|UI|UO|SI|SO|WI|WO|WSI|WSO|AI|AO|GI|GO|F|M|TIMER|UFRAME|UTOOL|PAYLOAD|UALM
       |MESSAGE|LBL|SEMAPHORE|TIMER_OVERFLOW|PL)\s*\[
    |WAIT(?![\w.])(?!(?:\s+[A-Z_]+){2,}\s*;?\s*\Z)  # words alone are the name of a macro that begins with WAIT
    |(?:IF|ELSE|ENDIF|SELECT|FOR|ENDFOR|JMP|END|PAUSE|ABORT|CALL|RUN|OVERRIDE|UFRAME_NUM|UTOOL_NUM|MONITOR|WHEN
       |ERROR_PROG|RESUME_PROG|MAINT_PROG|CLEAR_RESUME_PROG|LOCK|UNLOCK)(?![\w.])
    |(?:SKIP|OFFSET|TOOL_OFFSET)\s+CONDITION\b|\$
    """
)
# `PR[41:place,1]`: the component behind the comment; a controller itself prints `PR[41,1:place]`.
_LABEL = re.compile(r"(?:LBL|LABEL)\s*\[", re.IGNORECASE)
_COMPONENT = re.compile(r"\s*,\s*(?:[1-9]|A?R\[[^\[\],]*\])\s*\Z")
# Body-shop calls with bare words as arguments are no calls of a program.
_NAMED_ARGUMENTS = re.compile(r"CALL\s+VW_\w+\s*\(", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Note:
    """A comment in brackets: of which bank and number."""

    bank: str
    number: int
    text: str


def without_notes(text: str) -> tuple[str, tuple[Note, ...]]:
    """The statement without the comments in its brackets, and these comments."""
    if ":" not in text:
        return text, ()
    found: list[Note] = []
    at, parts = 0, []
    while True:
        match = _INDEXED_NOTE.search(text, at)
        if match is None:
            break
        colon = match.start(1)
        inner = text[match.start() + 1 : colon].strip()
        if re.fullmatch(r"(?i)GP\d+", inner):  # a group, no number yet
            parts.append(text[at : colon + 1])
            at = colon + 1
            continue
        end = _closing(text, colon)
        parts.append(text[at:colon])
        bank = re.search(r"([A-Za-z_]+)\s*\Z", text[: match.start()])
        if bank and bank[1].upper() == "PR" and "," not in inner:
            component = _COMPONENT.search(text[:end], colon)
            if component is not None:
                parts.append(component[0])
                if inner.isdigit():
                    found.append(Note("PR", int(inner), text[colon + 1 : component.start()].strip()))
                at = end
                continue
        number = re.search(r"(\d+)(?:\s*,\s*\d+)?\Z", inner)  # `PR[1,2:pick]` is element 2 of the register called pick
        if bank and number:
            found.append(Note(bank[1].upper(), int(number[1]), text[colon + 1 : end].strip()))
        at = end
    parts.append(text[at:])
    return "".join(parts), tuple(found)


def _closing(text: str, start: int) -> int:
    """Where the bracket that holds the comment closes. Comments may hold brackets themselves."""
    depth = 0
    for at in range(start, len(text)):
        if text[at] == "[":
            depth += 1
        elif text[at] == "]":
            if depth == 0:
                return at
            depth -= 1
    last = text.find("]", start)
    return last if last >= 0 else len(text)


@dataclass(slots=True)
class _Line:
    """A logical line under way: its span, its text, whether it has ended."""

    start: int
    end: int
    text: str
    done: bool
    remark: bool


def split(source: Source) -> Iterator[Piece]:
    """The pieces of one listing."""
    text = source.text
    german = is_german(text)
    sections = _sections(text)
    head = _HEAD.search(text)
    begin = sections["MN"].end() if "MN" in sections else (head.end() if head else 0)
    start = head.start() if head and head.start() < begin else 0
    yield from _loose(text, 0, start)
    yield Piece(STATEMENT, start, begin, HEADER)
    stop = min((sections[name].start() for name in ("POS", "END") if name in sections), default=len(text))
    yield from _statements(text, begin, max(begin, stop), german)
    tail = sections["END"].start() if "END" in sections else len(text)
    if "POS" in sections:
        at = sections["POS"]
        yield Piece(STATEMENT, at.start(), at.end(), POSITIONS)
        yield from _positions(text, at.end(), max(at.end(), tail))
    end = sections["END"].end() if "END" in sections else len(text)
    yield Piece(STATEMENT, tail, max(end, tail), END)
    if text[end:].strip():
        yield Piece(COMMENT, end, len(text), text[end:].strip())


def _sections(text: str) -> dict[str, re.Match[str]]:
    """The first mark of each section that stands behind the one before it."""
    marks = list(_SECTION.finditer(text))
    found: dict[str, re.Match[str]] = {}
    at = 0
    for name in ("MN", "POS", "END"):
        mark = next((mark for mark in marks if mark[1] == name and mark.start() >= at), None)
        if mark is not None:
            found[name], at = mark, mark.end()
    return found


def _positions(text: str, begin: int, end: int) -> Iterator[Piece]:
    at = begin
    for match in _POINT.finditer(text, begin, end):
        yield from _loose(text, at, match.start())
        yield Piece(STATEMENT, match.start(), match.end(), "/P")
        at = match.end()
    yield from _loose(text, at, end)


def _loose(text: str, begin: int, end: int) -> Iterator[Piece]:
    """Something between positions that is none."""
    rest = text[begin:end]
    if rest.strip(_BLANKS + "\r\n"):
        start = begin + len(rest) - len(rest.lstrip())
        yield Piece(STATEMENT, start, begin + len(rest.rstrip()), rest.strip())


def _statements(text: str, begin: int, end: int, german: bool) -> Iterator[Piece]:
    waiting: Piece | None = None
    for line in _lines(text, begin, end):
        body = line.text.strip(_BLANKS)
        if line.remark or body.startswith("//"):
            if waiting is not None:
                yield waiting
                waiting = None
            kept = body[2:] if body.startswith("--") else body[1:] if line.remark else body
            yield Piece(COMMENT, line.start, line.end, kept.removesuffix(";").rstrip())
            continue
        if body in (";", ""):  # a numbered line with nothing in it
            if waiting is not None:
                yield waiting
                waiting = None
            yield Piece(LAYOUT, line.start, line.end, "")
            continue
        piece = Piece(STATEMENT, line.start, line.end, readable(body, german), _label_text(body))
        if waiting is not None and _SELECT_NEXT.match(piece.text):
            joined = f"{waiting.text} {piece.text}"
            waiting = Piece(STATEMENT, waiting.start, piece.end, joined)
            continue
        if waiting is not None:
            yield waiting
            waiting = None
        if _SELECT.match(piece.text):
            waiting = piece
        else:
            yield piece
    if waiting is not None:
        yield waiting


def _label_text(body: str) -> str | None:
    """What `LBL[10:retry]` says of its label: a remark on that line."""
    found = _LABEL.match(body)
    if found is None:
        return None
    _, notes = without_notes(body)
    return notes[0].text or None if notes else None


def readable(body: str, german: bool) -> str:
    """The statement as the grammar reads it: English, without comments in brackets, unknown instructions marked."""
    written = body = body.strip().removesuffix(";").rstrip()
    if german and not body.startswith("'"):
        body = english(body)
    if _DASHES.fullmatch(body):
        return "------"
    if body[:8].upper().startswith("MESSAGE"):
        return body
    plain, _ = without_notes(body)
    if plain.startswith("=") or _SELECT_NEXT.match(plain):
        return plain
    if not _KNOWN.match(plain) or _NAMED_ARGUMENTS.match(plain):
        return MACRO + written
    return plain


def _lines(text: str, begin: int, end: int) -> Iterator[_Line]:
    current: _Line | None = None
    for match in _LINE.finditer(text, begin, end):
        raw = match.group()
        if not raw.strip(_BLANKS):
            continue
        numbered = _NUMBERED.match(raw)
        fresh = numbered is not None and bool(numbered[2])
        content = raw[numbered.end() :] if numbered else raw
        next_remark = numbered is not None and current is not None and current.remark and current.text[0] == "!"
        if current is not None and not current.done and not (fresh or next_remark):
            current.text = f"{current.text} {content.strip(_BLANKS)}"
            current.end = match.end()
        else:
            if current is not None:
                yield current
            body = content.strip(_BLANKS)
            start = match.start() + len(raw) - len(raw.lstrip(_BLANKS))
            current = _Line(start, match.end(), body, False, body.startswith(_REMARK) and not _DASHES.fullmatch(body))
        current.done = current.text.rstrip(_BLANKS).endswith(";")
    if current is not None:
        yield current
