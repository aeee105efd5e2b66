"""What of a job's header the controller writes itself: the date of the last edit, and how many positions there are."""

from __future__ import annotations

import re

from rpl.trivia import Trivia

TRIVIA = Trivia(
    header=re.compile(r"/{2,3}(\w+)"),
    attributes=frozenset({"DATE", "NPOS", "POS", "INST"}),
    remarks=frozenset({"COMM"}),
)
