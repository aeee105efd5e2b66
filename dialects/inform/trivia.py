"""What of a job's header the controller writes itself: the date of the last edit, and how many positions there are."""

from __future__ import annotations

import re

from rpl.trivia import Trivia

_COUNTS = re.compile(r"^(///NPOS[ \t]+)(\d+(?:,\d+)*)", re.MULTILINE)
# What the numbers of NPOS count, in their order: positions of the robot, its base, its station, and variables.
_COUNTED = ("C", "BC", "EC", "P", "BP", "EX")


def _tidy(text: str) -> str:
    """The positions counted again: a controller refuses a job whose count is wrong."""

    def counted(found: re.Match[str]) -> str:
        names = _COUNTED[: found[2].count(",") + 1]
        return found[1] + ",".join(str(len(re.findall(rf"^{name}\d+[ \t]*=", text, re.MULTILINE))) for name in names)

    return _COUNTS.sub(counted, text, count=1)


TRIVIA = Trivia(
    header=re.compile(r"/{2,3}(\w+)"),
    attributes=frozenset({"DATE", "NPOS", "POS", "INST"}),
    remarks=frozenset({"COMM"}),
    tidy=_tidy,
)
