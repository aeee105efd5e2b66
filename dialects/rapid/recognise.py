"""Is this text RAPID? By its content, never by its name."""

from __future__ import annotations

import re

from .iosignals import is_configuration

# Each text is looked at, logs of thousands of blank lines too: no pattern may have two ways through the same blanks.
_COMMENTS = r"(?:[\s\ufeff]|![^\r\n]*+)*+"
_HEADER = re.compile(rf"{_COMMENTS}%%%\s*VERSION\s*:\s*\d", re.IGNORECASE)
_MODULE = re.compile(rf"{_COMMENTS}(?:%%%[^%]*%%%)?{_COMMENTS}MODULE\s+[^\W\d]\w*\s*(?:\(|\r|\n|!|$)", re.IGNORECASE)
_END = re.compile(r"^[ \t]*+END(?:MODULE|PROC|FUNC|TRAP)\b", re.IGNORECASE | re.MULTILINE)
_PROC = re.compile(
    r"^[ \t]*+(?:LOCAL\s+)?(?:PROC\s+\w+\s*\(|FUNC\s+\w+\s+\w+\s*\(|TRAP\s+\w+\s*$)", re.IGNORECASE | re.MULTILINE
)
_DATA = re.compile(
    r"^[ \t]*+(?:LOCAL\s+|TASK\s+)?(?:CONST|VAR|PERS)\s+"
    r"(?:num|robtarget|jointtarget|bool|string|tooldata|wobjdata)\s+\w+[^;\n]*;",
    re.IGNORECASE | re.MULTILINE,
)
_TAIL = 20_000  # of a text that is longer than what is looked at
_MOVE = re.compile(r"^[ \t]*+Move(?:AbsJ|J|L|C)\b[^;\n]*,[^;\n]*;", re.IGNORECASE | re.MULTILINE)


def encoded(data: bytes) -> bool:
    """Is this an encoded module? They begin with FC or FE and look like no text (UTF-16 marks begin with FE FF)."""
    if data[:1] not in (b"\xfc", b"\xfe") or data[:2] == b"\xfe\xff":
        return False
    head = data[:512]
    strange = sum(1 for byte in head if byte < 9 or 13 < byte < 32 or byte > 126)
    return strange > len(head) // 5


def recognise(path: str, text: str) -> int:
    """0..100: how sure the text is RAPID."""
    if is_configuration(text):
        return 99
    sample = text[:200_000]
    if sample[:1] in "\xfc\xfe" and encoded(sample[:512].encode("latin-1", "replace")):
        return 60 if path.lower().endswith((".mod", ".sys", ".modx", ".sysx")) else 0
    if _HEADER.match(sample):
        return 99
    if _MODULE.match(sample):
        return 98 if _END.search(sample) or _END.search(text, max(0, len(text) - _TAIL)) else 70
    if _PROC.search(sample) and _END.search(sample):
        return 85
    if _DATA.search(sample):
        return 70
    return 60 if _MOVE.search(sample) else 0
