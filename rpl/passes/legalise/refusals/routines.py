"""Routines that the target's calls cannot serve."""

from __future__ import annotations

from rpl.passes.legalise.refusals.rows import Refusal
from rpl.passes.legalise.storage.locals import RECURSION

__all__ = ["ROUTINES"]

ROUTINES = (Refusal("a routine that calls itself, where all calls share its variables", RECURSION),)
