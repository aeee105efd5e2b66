"""What a controller's screen can show: ASCII, remarks cut into lines, numbers as operands."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator

from rpl.writing.statements import CannotSayError
from rpl.writing.text import NumberStyle, number_text, wrapped

from . import tables

_SPELLED = str.maketrans({"ß": "ss", "æ": "ae", "ø": "o", "ł": "l", "đ": "d", "°": "deg", "µ": "u", "€": "EUR"})
_REAL = NumberStyle(always_point=True, exponent="")


def ascii_text(text: str) -> str:
    """The text in ASCII: accents dropped, what has no likeness as a question mark."""
    plain = unicodedata.normalize("NFKD", text.translate(_SPELLED))
    signs = (sign for sign in plain if not unicodedata.combining(sign))
    return "".join(sign if " " <= sign <= "~" else " " if sign.isspace() else "?" for sign in signs)


def remarks(text: str) -> Iterator[str]:
    """The remark as lines of `'`, cut at blanks."""
    for line in text.splitlines() or [""]:
        for part in wrapped(ascii_text(line).strip(), tables.LONGEST_REMARK):
            yield f"'{part.rstrip()}"


def real(value: float) -> str:
    return number_text(float(value), style=_REAL)


def fixed(value: float, decimals: int) -> str:
    """With so many places, never `-0.000`."""
    shown = f"{value:.{decimals}f}"
    return shown[1:] if shown.startswith("-") and not shown.strip("-0.") else shown


def quoted(text: str, longest: int = tables.LONGEST_TEXT) -> str:
    if '"' in text or len(text) > longest or ascii_text(text) != text:
        raise CannotSayError(f"a text is ASCII without quotation marks, of at most {longest} characters")
    return f'"{text}"'
