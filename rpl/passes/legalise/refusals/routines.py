"""Routines and data that the target's calls and variables cannot serve."""

from __future__ import annotations

from rpl.passes.legalise.control.locals import RECURSION
from rpl.passes.legalise.refusals.rows import Refusal
from rpl.passes.legalise.routines.undefined import REFUSED as VALUE

__all__ = ["ROUTINES"]

ROUTINES = (
    Refusal("a routine that calls itself, where all calls share its variables", RECURSION),
    Refusal("the question whether something has a value yet, where the way to it does not tell", VALUE),
)
