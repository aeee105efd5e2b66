"""How RPL text is told from other languages; light, because every file of every language is shown to it."""

from __future__ import annotations

import re

_SURE = re.compile(
    r"^[ \t]*(?:END (?:PROCEDURE|MODULE)|MODULE[ \t]+\S+[ \t]+USING[ \t]+\w+)\b", re.IGNORECASE | re.MULTILINE
)
_LIKELY = re.compile(
    r"^[ \t]*(?:MOVE(?: JOINT| LINEAR| CIRCULAR)? (?:TO|BY|VIA)\b|END (?:IF|FOR|WHILE|LOOP|SWITCH|FUNCTION)\b"
    r"|(?:VAR|CONST|PERSISTENT)[ \t]+\w+[ \t]*:[ \t]*\w+|SET .+ TO (?:ON|OFF)\b|WAIT UNTIL\b|(?:OPEN|CLOSE) \w+[ \t]*$"
    r"|WAIT [\d.]+ s\b|MESSAGE \"|FRAME \w+ = |GRIPPER \w+ = )",
    re.IGNORECASE | re.MULTILINE,
)


def recognise(path: str, text: str) -> int:
    """How sure it is that the text is RPL, from its own block ends and statements."""
    if _SURE.search(text):
        return 85
    hits = sum(1 for _ in zip(_LIKELY.finditer(text), range(8), strict=False))
    return 30 + 5 * hits if hits else 0
