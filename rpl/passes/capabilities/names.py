"""What a target accepts as a name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

AS_MODULE: Final = "<module>"


@dataclass(frozen=True, slots=True)
class NameRules:
    """What the target accepts as a name."""

    longest: int
    """Characters at most."""

    case_sensitive: bool

    reserved: frozenset[str]
    """Words that are no names, in lower case when names are case-insensitive."""

    first: str = "abcdefghijklmnopqrstuvwxyz"
    """What a name may begin with, in lower case."""

    further: str = "abcdefghijklmnopqrstuvwxyz0123456789_"

    longest_routine: int = 0
    """The length of a routine's name where that is shorter (0: as any other)."""

    predefined: frozenset[str] = frozenset()
    """Names (lower case) of the data and routines every controller has; a program's own of that name would hide it, so
    it gets another. Those that passes bring along keep their spelling."""

    entry: str = ""
    """The name of the routine that the controller starts, where it asks for one; its modules are called like nothing
    else in the program then. AS_MODULE: that of its module, which the operator selects and starts."""
