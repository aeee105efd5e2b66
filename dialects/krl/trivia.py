"""What of a module the editor writes itself: the lines in front of it (`&ACCESS`, `&REL`, `&COMMENT`, `&PARAM`)."""

from __future__ import annotations

import re

from rpl.trivia import Trivia

TRIVIA = Trivia(
    header=re.compile(r"&\s*(\w+)"),
    attributes=frozenset({"ACCESS", "REL", "PARAM", "USER", "CREATE", "MODIFY", "VERSION"}),
    remarks=frozenset({"COMMENT"}),
)
