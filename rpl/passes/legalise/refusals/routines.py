"""Routines that the target's calls cannot serve."""

from __future__ import annotations

from rpl.passes.legalise.control.locals import RECURSION
from rpl.passes.legalise.refusals.rows import Refusal

__all__ = ["ROUTINES"]

ROUTINES = (Refusal("a routine that calls itself, where all calls share its variables", RECURSION),)
