"""What of a listing the controller writes itself and nobody means: numbers of lines, sizes and dates of the header.

Source: headers of listings that a controller printed before and after an edit differ in these attributes only.
"""

from __future__ import annotations

import re
from itertools import count

from rpl.trivia import Trivia

_SECTION = re.compile(r"^/(\w+)", re.MULTILINE)
_NUMBERED = re.compile(r"^([ \t]*)\d+(?=[ \t]*:)", re.MULTILINE)
_COUNT = re.compile(r"^(LINE_COUNT\s*=\s*)\d+", re.MULTILINE)


def _tidy(text: str) -> str:
    """Statements numbered in a row and counted in the header. A controller numbers them itself when it loads a listing;
    people and their tools look at the numbers."""
    begin = next((found for found in _SECTION.finditer(text) if found[1] == "MN"), None)
    if begin is None:
        return text
    end = next((found.start() for found in _SECTION.finditer(text, begin.end())), len(text))
    numbers = count(1)
    body = _NUMBERED.sub(lambda found: f"{next(numbers):{len(found[0])}d}", text[begin.end() : end])
    head = _COUNT.sub(lambda found: f"{found[1]}{next(numbers) - 1}", text[: begin.end()], count=1)
    return head + body + text[end:]


TRIVIA = Trivia(
    numbering=re.compile(r"\s*\d+\s*:"),
    header=re.compile(r"\s*(?:TCD:)?\s*(\w+)\s*="),
    attributes=frozenset(
        {"OWNER", "PROG_SIZE", "CREATE", "MODIFIED", "FILE_NAME", "VERSION", "LINE_COUNT", "MEMORY_SIZE"}
    ),
    remarks=frozenset({"COMMENT"}),
    tidy=_tidy,
)
