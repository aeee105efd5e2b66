"""Listings in German: the controller translates its key words, so each statement is put into English before it is read.

The list was put together from public listings of German controllers; what is not in it stays as it is and is reported
where it cannot be read.
"""

from __future__ import annotations

import re

# Key words that only German listings have: their presence in a header or statement makes it German.
GERMAN_MARKS = re.compile(
    r"^(?:EIGN\.|KOMMENTAR|PROG_GR|ERSTELL|GE[^\n]{1,2}NDERT|DATEI_NAME|ZEILEN|SPEICHERGR\.|SCHUTZ|DEFAULT_GRUP\b"
    r"|KONTROLLCODE)",
    re.MULTILINE,
)

# German word -> English word; longest first. Signal letters only in front of a bracket.
_WORDS: tuple[tuple[str, str], ...] = (
    (r"\[&\]", " AND "),
    (r"\[\+\]", " OR "),
    (r"\bSPRUNG\b", "JMP"),
    (r"\bLABEL(?=\s*\[)", "LBL"),
    (r"\bAUFRUF\b", "CALL"),
    (r"\bENDE\s*WENN\b|\bENDWENN\b", "ENDIF"),
    (r"\bWENN\b", "IF"),
    (r"\bDANN\b", "THEN"),
    (r"\bSONST\b", "ELSE"),
    (r"\bWARTE(?:N)?\b", "WAIT"),
    (r"\bZEITFEHLER\b|\bZEIT(?:UE|Ü)BER(?:L|SCHR)?\b", "TIMEOUT"),
    (r"\bBENUTZER_NUM\b", "UFRAME_NUM"),
    (r"\bWKZ_NUM\b", "UTOOL_NUM"),
    (r"\bBENUTZER(?=\s*\[)", "UFRAME"),
    (r"\bWKZ(?=\s*\[)", "UTOOL"),
    (r"\bTRAGLST(?=\s*\[)", "PAYLOAD"),
    (r"\bZEIT\s+VOR\b", "TB"),
    (r"\bZEIT\s+NACH\b", "TA"),
    (r"\bmax_Geschw\.", "max_speed"),
    (r"(?<=mm/)sek\b|(?<=deg/)sek\b|(?<=Grad/)sek\b", "sec"),
    (r"\bGrad/sec\b", "deg/sec"),
    (r"(?<![A-Za-z])[Ss]ek\b", "sec"),
    (r"\bInterrupt,(?=\s*LBL)", "Skip,"),
    (r"\bENDE\b", "END"),
    (r"\bABBRUCH\b", "ABORT"),
    (r"\bPROG_PAUSE\b", "PAUSE"),
    (r"\bMELDUNG(?=\s*\[)", "MESSAGE"),
    (r"\bSTOPP\b", "STOP"),
    (r"=\s*AN\b(?!\s*\[)", "=ON"),
    (r"=\s*AUS\b", "=OFF"),
    (r"\(\s*AN\s*\)", "(ON)"),
    (r"\(\s*AUS\s*\)", "(OFF)"),
    (r"\bPULS\b", "PULSE"),
    (r"(?<![\w$])gA(?=\s*\[)", "GO"),
    (r"(?<![\w$])gE(?=\s*\[)", "GI"),
    (r"(?<![\w$])aA(?=\s*\[)", "AO"),
    (r"(?<![\w$])aE(?=\s*\[)", "AI"),
    (r"(?<![\w$])i(?=\s*\[)", "R"),
    (r"(?<![\w$])A(?=\s*\[)", "DO"),
    (r"(?<![\w$])E(?=\s*\[)", "DI"),
)
_GERMAN = tuple((re.compile(pattern), english) for pattern, english in _WORDS)

_ATTRIBUTES = {
    "EIGN.": "OWNER",
    "KOMMENTAR": "COMMENT",
    "ERSTELL": "CREATE",
    "DATEI_NAME": "FILE_NAME",
    "ZEILEN": "LINE_COUNT",
    "SPEICHERGR.": "MEMORY_SIZE",
    "SCHUTZ": "PROTECT",
    "DEFAULT_GRUP": "DEFAULT_GROUP",
    "KONTROLLCODE": "CONTROL_CODE",
}
_MOMENT = re.compile(r"\bTAG\s+(\S+)\s+ZEIT\s+(\S+)")


def is_german(text: str) -> bool:
    """Is the listing in German? Told by its header."""
    return GERMAN_MARKS.search(text[:4000]) is not None


def english(statement: str) -> str:
    """A German statement with its key words in English; quoted texts stay."""
    parts = re.split(r"('[^']*')", statement)
    return "".join(part if part.startswith("'") else _english(part) for part in parts)


def _english(part: str) -> str:
    for pattern, word in _GERMAN:
        part = pattern.sub(word, part)
    return part


def attribute_name(name: str) -> str:
    """The English name of a header attribute."""
    return _ATTRIBUTES.get(name, name)


def attribute_value(value: str) -> str:
    """The value of a header attribute with its words in English (`TAG 24-01-31  ZEIT 10:20:30`)."""
    return _MOMENT.sub(r"DATE \1  TIME \2", value)
