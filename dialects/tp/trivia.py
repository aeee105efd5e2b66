"""What of a listing the controller writes itself and nobody means: numbers of lines, sizes and dates of the header.

Source: headers of listings that a controller printed before and after an edit differ in these attributes only.
"""

from __future__ import annotations

import re

from rpl.trivia import Trivia

TRIVIA = Trivia(
    numbering=re.compile(r"\s*\d+\s*:"),
    header=re.compile(r"\s*(?:TCD:)?\s*(\w+)\s*="),
    attributes=frozenset(
        {"OWNER", "PROG_SIZE", "CREATE", "MODIFIED", "FILE_NAME", "VERSION", "LINE_COUNT", "MEMORY_SIZE"}
    ),
    remarks=frozenset({"COMMENT"}),
)
