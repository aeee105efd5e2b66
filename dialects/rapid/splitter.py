"""Cut RAPID text into logical statements: at `;`, at block keywords, at the `:` of labels and cases.

RAPID is free-format, so a line means nothing. A statement that lacks its end is cut where a word stands that can only
begin a statement, or, when it does not parse, at a line break behind which one could begin: damage costs itself alone.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator
from dataclasses import replace

from rpl.reading.pieces import COMMENT, LAYOUT, STATEMENT, Piece
from rpl.reading.runs import Cursor
from rpl.source import Source

from .parser import RapidParser
from .words import PLACEHOLDERS, words

_BLANKS = re.compile(r"[\s\ufeff\x00]+")
_JUNK = re.compile(r"[\ufeff\x00]")  # a byte order mark and zeros belong to what follows
_COMMENT = re.compile(r"!([^\r\n]*)")
_BEHIND = re.compile(r"[ \t]*!([^\r\n]*)")
_HEADER = re.compile(r"%%%(?:[^%]*)%%%")
_STRING = r'"(?:[^"\r\n]|"")*"|"[^\r\n]*'  # the second form: a text that is never closed ends with its line
_WORD = re.compile(r"[^\W\d]\w*")
_ALONE = words("ELSE ENDIF ENDFOR ENDWHILE ENDTEST UNDO BACKWARD")
_ENDS = words("ENDPROC ENDFUNC ENDTRAP ENDRECORD ENDMODULE")
_ERROR = re.compile(r"ERROR\s*\([^()\r\n]*\)|ERROR", re.IGNORECASE)
_LABEL = re.compile(r"[^\W\d]\w*[ \t]*:(?!=)")
_DEFAULT = re.compile(r"DEFAULT\s*:", re.IGNORECASE)
_MODULE = re.compile(r"MODULE\s+[^\s(;!]+(?:\s*\([^()]*\))?", re.IGNORECASE)
_TRAP_OR_RECORD = re.compile(r"(?:LOCAL\s+)?(?:TRAP|RECORD)[ \t]+[^\s;!]+", re.IGNORECASE)
_ROUTINE = re.compile(r"(?:LOCAL\s+)?(?:PROC|FUNC)\b[^();!\r\n]*\(", re.IGNORECASE)
_PLACEHOLDER = re.compile(r"<(?:SMT|EIT|DDN|RDN|TDN|CSE)>\s*;?", re.IGNORECASE)
# Behind these a line break says nothing: a compact IF may put its statement there.
_MAY_GO_ON = re.compile(r"(?:IF|LOCAL|TASK|CONST|VAR|PERS|ALIAS|PROC|FUNC)\b", re.IGNORECASE)
_INSTRUCTION = re.compile(r"[^\W\d]\w*+(?!\s*[(.{:+])")  # not a function or a variable in an expression
_ASSIGNMENT = re.compile(r"[^\W\d]\w*\s*:=")

# Words that can only begin a statement or end a block. Inside another statement they prove that its end is missing.
_STARTERS = (
    "MODULE|ENDMODULE|PROC|ENDPROC|FUNC|ENDFUNC|TRAP|ENDTRAP|RECORD|ENDRECORD|ELSE|ELSEIF|ENDIF|FOR|ENDFOR|WHILE"
    "|ENDWHILE|TEST|ENDTEST|CASE|DEFAULT|BACKWARD|UNDO|LOCAL|CONST|ALIAS|PERS|VAR|TASK|IF"
)
_SIGNS = rf"{_STRING}|!|;|<SMT>|(?<![\w\\.])(?:THEN|DO|{_STARTERS})\b"
_STATEMENT_END = re.compile(_SIGNS, re.IGNORECASE)
_CASE_END = re.compile(rf"{_SIGNS}|:(?!=)", re.IGNORECASE)
_PARENTHESES = re.compile(r'[()]|!|;|"(?:[^"\r\n]|"")*"')
_SUSPICIOUS = re.compile(rf"{_STRING}|[\[({{]|[\])}}]|[ \t]*(?:\r\n|\r|\n)\s*(?=[^\W\d])")
_COMPLETE = re.compile(r"[\w\])}\"]")
_HEADS = {"IF": "THEN", "ELSEIF": "THEN", "FOR": "DO", "WHILE": "DO"}
_PLACEHOLDER_WORDS = frozenset(f"<{word}>" for word in PLACEHOLDERS)


def split(
    source: Source, parser: RapidParser, instructions: Container[str] = (), cursor: Cursor | None = None
) -> Iterator[Piece]:
    """All pieces of a source in order. Comments inside a statement go behind it.

    instructions: names (lower case) that begin a statement when they begin a line. Where the cursor is set further on,
    it goes on there."""
    return _Splitter(source.text, parser, instructions).pieces(cursor or Cursor())


class _Splitter:
    def __init__(self, text: str, parser: RapidParser, instructions: Container[str]) -> None:
        self.text = text
        self.parser = parser
        self.instructions = instructions
        self.remarks: list[tuple[int, int, str]] = []

    def pieces(self, cursor: Cursor) -> Iterator[Piece]:
        text, at, length = self.text, 0, len(self.text)
        while True:
            at = max(at, cursor.at)
            blank = _BLANKS.match(text, at)
            if blank:
                lead = at if _JUNK.search(text, at, blank.end()) else blank.end()
                at = blank.end()
            else:
                lead = at
            if at >= length:
                if lead < at:
                    yield Piece(LAYOUT, lead, at, "")
                return
            if text[at] == "!":
                comment = _COMMENT.match(text, at)
                end = comment.end() if comment else length
                yield Piece(COMMENT, lead, end, text[at + 1 : end].rstrip())
                at = end
                continue
            self.remarks = []
            end = max(self.end_of(at), at + 1)
            for start, stop in self.mended(at, end):
                for first, last, remark in self.remarks:  # comments at the break between two statements
                    if at <= first and last <= start:
                        yield Piece(COMMENT, first, last, remark)
                        at = last
                piece = self.statement(start, stop)
                yield replace(piece, start=lead) if lead < start == at else piece
                at = piece.end

    def statement(self, start: int, end: int) -> Piece:
        """The piece from start to end, its inner comments blanked, with the comment behind it on its line."""
        text = self.text
        body = text[start:end]
        inner = [remark for remark in self.remarks if start <= remark[0] < end]
        for first, last, _ in inner:
            body = body[: first - start] + " " * (last - first) + body[last - start :]
        comments = [words for _, _, words in inner]
        behind = _BEHIND.match(text, end)
        if behind:
            end = behind.end()
            comments.append(behind.group(1).rstrip())
        body = body.rstrip()
        if body[-5:].upper() in _PLACEHOLDER_WORDS:
            body += ";"
        return Piece(STATEMENT, start, end, body, " | ".join(comments) if comments else None)

    def end_of(self, at: int) -> int:
        """Where the statement that begins at `at` ends."""
        text = self.text
        word = _WORD.match(text, at)
        if word is None:
            return self.end_of_odd(at)
        upper = word.group().upper()
        if upper in _ALONE or upper in _ENDS:
            return word.end()
        if upper == "ERROR":
            return self.matched(_ERROR, at)
        if upper == "DEFAULT":
            return self.matched(_DEFAULT, at)
        if upper == "MODULE":
            return self.matched(_MODULE, at)
        if upper in _HEADS:
            return self.find(at, word.end(), _HEADS[upper], upper)
        if upper == "TEST":
            return self.find(at, word.end(), "CASE", upper)
        if upper == "CASE":
            return self.find(at, word.end(), ":", upper)
        if upper in ("PROC", "FUNC", "TRAP", "RECORD", "LOCAL"):
            end = self.header(at)
            if end is not None:
                return end
        label = _LABEL.match(text, at)
        if label:
            return label.end()
        return self.find(at, word.end(), ";", upper)

    def end_of_odd(self, at: int) -> int:
        text = self.text
        if text.startswith("%%%", at):
            return self.matched(_HEADER, at)
        placeholder = _PLACEHOLDER.match(text, at)
        if placeholder:
            return placeholder.end()
        return self.find(at, at, ";", "")

    def matched(self, pattern: re.Pattern[str], at: int) -> int:
        found = pattern.match(self.text, at)
        return found.end() if found else self.find(at, at + 1, ";", "")

    def header(self, at: int) -> int | None:
        """End of a routine or record header; None when the text is none."""
        text = self.text
        plain = _TRAP_OR_RECORD.match(text, at)
        if plain:
            return plain.end()
        opened = _ROUTINE.match(text, at)
        if not opened:
            return None
        depth = 1
        for found in _PARENTHESES.finditer(text, opened.end()):
            sign = found.group()
            if sign == "(":
                depth += 1
            elif sign == ")":
                depth -= 1
                if depth == 0:
                    return found.end()
            elif sign == "!":
                comment = _COMMENT.match(text, found.start())
                if comment:
                    self.remarks.append((comment.start(), comment.end(), comment.group(1).rstrip()))
            elif sign == ";":
                break
        return self.line_end(at)

    def line_end(self, at: int) -> int:
        found = re.compile(r"[\r\n]").search(self.text, at)
        return found.start() if found else len(self.text)

    def find(self, start: int, at: int, wanted: str, first: str) -> int:
        """The end of a statement that runs to `wanted`: a sign or keyword (included; CASE is not)."""
        text = self.text
        pattern = _CASE_END if wanted == ":" else _STATEMENT_END
        while True:
            found = pattern.search(text, at)
            if found is None:
                return len(text)
            sign = found.group()
            at = found.end()
            if sign == "!":
                comment = _COMMENT.match(text, found.start())
                if comment:
                    self.remarks.append((comment.start(), comment.end(), comment.group(1).rstrip()))
                    at = comment.end()
                continue
            if sign[0] == '"':
                if len(sign) < 2 or sign[-1] != '"' or sign.count('"') % 2:
                    return at  # a text that is never closed: damage ends with its line
                continue
            if sign == ":":
                return at
            if sign[0] in ";<":
                return at
            upper = sign.upper()
            if upper == wanted and wanted in ("THEN", "DO"):
                return at
            if upper == "CASE" and wanted == "CASE":
                return self.before(start, found.start())
            if self.proves_an_end(upper, first, start, found.start()):
                return self.before(start, found.start())

    def proves_an_end(self, word: str, first: str, start: int, at: int) -> bool:
        if word in ("THEN", "DO"):
            return False
        if word == "TASK" or (word in ("PERS", "VAR", "CONST", "ALIAS") and first in ("LOCAL", "TASK")):
            return first not in ("LOCAL", "TASK") and self.begins_line(at)
        if first == "IF" and word in ("IF", "TEST", "FOR", "WHILE"):
            return self.begins_line(at)
        return True

    def begins_line(self, at: int) -> bool:
        line = self.text.rfind("\n", 0, at) + 1
        line = max(self.text.rfind("\r", line, at) + 1, line)
        return not self.text[line:at].strip()

    def before(self, start: int, at: int) -> int:
        """The end of what stands before a keyword, without blanks and the comments in between."""
        end = at
        while True:
            end = start + len(self.text[start:end].rstrip())
            if self.remarks and self.remarks[-1][1] == end and self.remarks[-1][0] >= start:
                end = self.remarks.pop()[0]
            else:
                return end

    def mended(self, start: int, end: int) -> list[tuple[int, int]]:
        """The statement, or where it does not parse the parts that line breaks make of it."""
        text = self.text
        if "\n" not in text[start:end] and "\r" not in text[start:end]:
            return [(start, end)]
        breaks = self.suspicious_breaks(start, end)
        if not breaks:
            return [(start, end)]
        spans, at = [], start
        certain = [place for place in breaks if self.begins_another(start, place)]
        if certain:
            for stop, further in certain:
                spans.append((at, stop))
                at = further
            return [*spans, *self.mended(at, end)]
        whole = self.statement(start, end).text
        if self.parser.reads(whole):
            return [(start, end)]
        breaks = [place for place in breaks if _COMPLETE.match(whole, place[0] - start - 1)] or breaks
        for stop, further in breaks:
            rest = self.statement(further, end).text
            spans.append((at, stop))
            at = further
            if self.parser.reads(rest):
                break
        spans.append((at, end))
        return spans

    def begins_another(self, start: int, place: tuple[int, int]) -> bool:
        """Does another statement certainly begin behind this line break? `Stop` and `n:=1;` on the next line would
        read as a call with a named argument."""
        first = _WORD.match(self.text, start)
        if first is None or _MAY_GO_ON.match(self.text, start):
            return False
        word = _INSTRUCTION.match(self.text, place[1])
        if word is not None and word.group().lower() in self.instructions:
            return True
        installed = first.group().lower() in self.instructions
        return (first.end() == place[0] or installed) and _ASSIGNMENT.match(self.text, place[1]) is not None

    def suspicious_breaks(self, start: int, end: int) -> list[tuple[int, int]]:
        """Line breaks outside of brackets before a word: a statement that lacks its end may stop there."""
        depth, found = 0, []
        for match in _SUSPICIOUS.finditer(self.statement(start, end).text):
            sign = match.group()
            if sign[:1] in ("[", "(", "{"):
                depth += 1
            elif sign[:1] in ("]", ")", "}"):
                depth -= 1
            elif sign[:1] != '"':
                found.append((start + match.start(), start + match.end()))
        return found
