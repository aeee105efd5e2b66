"""What a controller's screen can show: ASCII, short comments, remarks cut into lines."""

from __future__ import annotations

import unicodedata

from rpl.writing.text import number_text, wrapped

from . import tables

_SPELLED = str.maketrans({"ß": "ss", "æ": "ae", "ø": "o", "ł": "l", "đ": "d", "°": "deg", "µ": "u", "€": "EUR"})


def ascii_text(text: str) -> str:
    """The text in ASCII: accents dropped, what has no likeness as a question mark."""
    plain = unicodedata.normalize("NFKD", text.translate(_SPELLED))
    signs = (sign for sign in plain if not unicodedata.combining(sign))
    return "".join(sign if " " <= sign <= "~" else " " if sign.isspace() else "?" for sign in signs)


def comment(text: str) -> str:
    """A comment inside of brackets: no bracket, colon or quotation mark, at most as long as the controller keeps it."""
    shown = "".join(sign for sign in ascii_text(text) if sign not in '[]{}:";')
    return shown[: tables.LONGEST_COMMENT].strip()


def register_comment(bank: str, text: str) -> str:
    """The comment of a register. That of a position register has no comma: what stands behind one may be read as the
    number of a component (`PR[15:slot2,2]`)."""
    return comment(text.replace(",", "_") if bank == "PR" else text)


def remarks(text: str) -> list[str]:
    """The remark as lines of `!`, cut at blanks."""
    found: list[str] = []
    for line in text.splitlines() or [""]:
        found.extend(f"  !{part.rstrip()}" for part in wrapped(ascii_text(line).strip(), tables.LONGEST_REMARK))
    return found


def number(value: float | int) -> str:
    """A constant; the screen shows a negative one in brackets, and so it is written."""
    shown = number_text(value, style=tables.NUMBERS)
    return f"({shown})" if shown.startswith("-") else shown
