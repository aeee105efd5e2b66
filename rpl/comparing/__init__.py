"""Comparing and merging robot programs by what they say.

`differences(a, b)` tells in which points, frames, settings, signals and statements two read projects differ; what means
nothing (dates, numbers of lines, blanks, capitals where the language folds them) is counted only.
"""

from rpl.comparing.changes import Change, Differences, Spot
from rpl.comparing.projects import differences

__all__ = ["Change", "Differences", "Spot", "differences"]
