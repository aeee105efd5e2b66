"""URScript text to statements. Lines end statements only where one is complete, and a line may hold several.

A statement is complete where brackets are closed and an operand, a closing bracket or a word that stands alone came
last; a new one begins where an operand follows an operand (`a = 1 b = 2`), behind the colon of a header, and at every
word that can only begin a statement. So the damage of a missing bracket ends at the next such word.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl.reading.pieces import COMMENT, LAYOUT, STATEMENT, Piece
from rpl.source import Source

# What is taken out of a statement's shape: numbers alone (names decide what a call means).
SHAPE = re.compile(
    r'"[^"\r\n]*"|\'[^\'\r\n]*\'|\{\{.*?\}\}|\{%.*?%\}|\$\$\w+\$\$'
    r"|[^\W\d]\w*"
    r"|0[xX][0-9a-fA-F]+"
    r"|(?P<real>(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"|(?P<int>\d+)"
)

_TOKEN = re.compile(
    r"(?P<blank>[ \t\f\u00a0\ufeff\x1a\x00]+)|(?P<line>\r\n|\r|\n)|(?P<comment>\#[^\r\n]*)"
    r"|(?P<text>\"[^\"\r\n]*\"?|'[^'\r\n]*')"
    r"|(?P<hole>\{\{.*?\}\}|\$\$\w+\$\$)|(?P<tag>\{%.*?%\}|\{\#.*?\#\})|(?P<label>\$[^\r\n]*)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\w*)|(?P<name>[^\W\d]\w*)"
    r"|(?P<member>\.[^\W\d]\w*)|(?P<sign>==|!=|<=|>=|.)",
    re.DOTALL,
)
_STARTS = (
    *("def", "sec", "thread", "if", "elif", "else", "while", "end", "break", "continue", "halt", "return"),
    *("global", "local", "join", "kill", "enter_critical", "exit_critical"),
)
_INFIX = frozenset(("and", "or", "xor"))
_PREFIX = frozenset(("not", "run", "def", "sec", "thread", "if", "elif", "while", "global", "local", "join", "kill"))
# Words that can only begin a statement, wherever they stand.
STARTERS = frozenset(_STARTS)
# Words that are a whole statement; an empty pair of brackets may follow some.
_ALONE = frozenset(("end", "break", "continue", "halt", "enter_critical", "exit_critical"))
# The most frequent lines hold one whole statement and nothing that could end or go on elsewhere: a call, or a name that
# gets numbers, names and calls joined by signs. They need no look at each sign.
_WORD = rf"(?!(?:{'|'.join(sorted(_INFIX | _PREFIX | frozenset(_STARTS)))})\b)[^\W\d]\w*"
_PLAIN = r"[^()\[\]\"'#{}$;\r\n]*"
_INNER = rf"{_PLAIN}(?:[(\[]{_PLAIN}[)\]]{_PLAIN})*"
_OPERAND = rf"[ \t]*-?(?:(?:\d+\.?\d*|\.\d+)(?!\w)|{_WORD}(?:[(\[]{_INNER}[)\]])?)[ \t]*"
_WHOLE_LINE = re.compile(
    rf"[ \t]*(?P<code>{_WORD}(?:\({_INNER}\)|[ \t]*=(?!=){_OPERAND}(?:[-+*/]{_OPERAND})*))[ \t]*"
    r"(?P<remark>#[^\r\n]*)?(?:\r\n|\r|\n)"
)
_LINE_END = re.compile(r"[\r\n]")
_MARKS = re.compile("[\ufeff\x1a\x00]")


@dataclass(slots=True)
class _Statement:
    start: int
    end: int
    head: str
    depth: int = 0
    complete: bool = False
    open_word: bool = False  # `return` may end here or have a value
    remarks: list[tuple[int, int]] = field(default_factory=list)


def split(source: Source) -> Iterator[Piece]:
    """All pieces of a source in order."""
    return _Splitter(source.text).pieces()


def _whole_line(match: re.Match[str]) -> Piece:
    start = match.start("code")
    code = match["code"].rstrip()
    if match["remark"] is None:
        return Piece(STATEMENT, start, start + len(code), code)
    return Piece(STATEMENT, start, match.end("remark"), code, match["remark"][1:].rstrip())


class _Splitter:
    def __init__(self, text: str) -> None:
        self.text = text
        self.now: _Statement | None = None
        self.resume = 0

    def pieces(self) -> Iterator[Piece]:
        at = 0
        fresh = True  # at the beginning of a line
        while at < len(self.text):
            if self.now is None and fresh:
                whole = _WHOLE_LINE.match(self.text, at)
                if whole is not None:
                    yield _whole_line(whole)
                    at = whole.end()
                    continue
            match = _TOKEN.match(self.text, at)
            assert match is not None  # the last alternative takes any sign
            if self.now is not None and self.is_broken_at(match):
                yield self.first_line()
                at = self.resume
                continue
            at = match.end()
            fresh = match.lastgroup == "line"
            yield from self.token(match.lastgroup or "sign", match)
            if at == len(self.text) and self.now is not None and self.now.depth:
                yield self.first_line()
                at = self.resume
        if self.now is not None:
            yield self.finish()

    def is_broken_at(self, match: re.Match[str]) -> bool:
        """Is a bracket still open where a word stands that can only begin a statement?"""
        now = self.now
        starts = now is not None and now.depth > 0 and match.lastgroup == "name" and match.group() in STARTERS
        return starts and self.starts_line(match.start())

    def first_line(self) -> Piece:
        """A statement whose bracket is never closed costs its first line; the rest is read anew."""
        now = self.now
        assert now is not None  # the caller has looked
        found = _LINE_END.search(self.text, now.start)
        end = min(found.start(), now.end) if found is not None else now.end
        now.remarks = [(start, stop) for start, stop in now.remarks if start < (found.start() if found else now.end)]
        now.end = min([end, *(start for start, _ in now.remarks)])
        piece = self.finish()
        self.resume = piece.end
        return piece

    def token(self, kind: str, match: re.Match[str]) -> Iterator[Piece]:
        if kind == "blank":
            if self.now is None and _MARKS.search(match.group()):
                yield Piece(LAYOUT, match.start(), match.end(), "")
        elif kind == "line":
            if self.now is not None and self.now.complete and self.now.depth == 0:
                yield self.finish()
        elif kind == "comment":
            yield from self.comment(match)
        elif self.now is None:
            yield from self.begin(kind, match)
        else:
            yield from self.go_on(kind, match)

    def comment(self, match: re.Match[str]) -> Iterator[Piece]:
        now = self.now
        if now is None:
            yield Piece(COMMENT, match.start(), match.end(), match.group()[1:])
            return
        now.remarks.append(match.span())
        if now.complete and now.depth == 0:
            now.end = match.end()
            yield self.finish()

    def begin(self, kind: str, match: re.Match[str]) -> Iterator[Piece]:
        word = match.group()
        if kind == "label":
            yield Piece(LAYOUT, match.start(), match.end(), word.rstrip())
            return
        if kind == "tag" or (kind == "sign" and word == ";"):
            yield Piece(STATEMENT if kind == "tag" else LAYOUT, match.start(), match.end(), word)
            return
        self.now = _Statement(match.start(), match.end(), word if kind == "name" else "")
        yield from self.take(kind, match)

    def go_on(self, kind: str, match: re.Match[str]) -> Iterator[Piece]:
        now, word = self.now, match.group()
        assert now is not None  # the caller has looked
        starts = kind == "name" and word in STARTERS
        operand = kind in ("text", "number", "hole", "tag", "label") or (kind == "name" and word not in _INFIX)
        follows = operand and now.complete and not now.open_word
        if now.depth == 0 and (starts or follows or word == ";"):
            yield self.finish()
            yield from self.begin(kind, match)
            return
        yield from self.take(kind, match)

    def starts_line(self, at: int) -> bool:
        line = max(self.text.rfind("\n", 0, at), self.text.rfind("\r", 0, at)) + 1
        return not self.text[line:at].strip()

    def take(self, kind: str, match: re.Match[str]) -> Iterator[Piece]:
        """One more token of the statement."""
        now, word = self.now, match.group()
        assert now is not None  # the caller has looked
        now.end = match.end()
        now.open_word = word == "return"
        if word in ("(", "["):
            now.depth += 1
            now.complete = False
        elif word in (")", "]"):
            now.depth = max(now.depth - 1, 0)
            now.complete = True
        elif kind == "member":
            now.complete = True  # also one with the name of a word that begins a statement: time().sec
        elif kind == "sign":
            now.complete = False
            if word == ":" and now.depth == 0:
                yield self.finish()
        elif kind == "name":
            now.complete = word not in _INFIX and word not in _PREFIX and word != "else"
            if word in _ALONE and word == now.head and now.start == match.start():
                yield from self.alone(match.end())
        else:
            now.complete = True

    def alone(self, at: int) -> Iterator[Piece]:
        """A word that is a statement: it ends here, unless empty brackets follow."""
        if re.compile(r"[ \t]*\([ \t]*\)").match(self.text, at) is None and not re.compile(r"[ \t]*(#|$|[\r\n])").match(
            self.text, at
        ):
            yield self.finish()

    def finish(self) -> Piece:
        """The statement as a piece, remarks inside it blanked and put behind it."""
        now = self.now
        assert now is not None  # the caller has looked
        self.now = None
        body = self.text[now.start : now.end]
        words = []
        for start, end in now.remarks:
            words.append(self.text[start + 1 : end].rstrip())
            if start < now.end:
                body = body[: start - now.start] + " " * (end - start) + body[end - now.start :]
        end = max([now.end, *(end for _, end in now.remarks)])
        return Piece(STATEMENT, now.start, end, body.rstrip(), " | ".join(words) if words else None)
