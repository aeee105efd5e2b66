"""A target's routines: what they are given, give back and keep."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class Parameters(StrEnum):
    """What a routine knows its arguments by."""

    NAMES = auto()
    NUMBERED = auto()  # argument registers: numbers and texts by value, the rest in variables
    NONE = auto()


class Passing(StrEnum):
    """What an argument may be."""

    OPTIONAL = auto()
    """It may be left out."""

    REFERENCES = auto()
    """A routine may write its parameters (else copies go in, and out by variables)."""

    ARRAYS_BY_VALUE = auto()
    """An array by value (else the routine gets the caller's own)."""

    WRITTEN_LISTS = auto()
    """A list that is written out (else it is stored in a variable first)."""


class Local(StrEnum):
    """What a routine has of its own."""

    VARIABLES = auto()
    STATICS = auto()  # variables that keep their values from call to call
    CLOCKS = auto()  # stop watches


class RoutineRule(StrEnum):
    """What else routines can be and do."""

    FUNCTIONS = auto()
    """There are functions of the program (else procedures that leave their result in a variable)."""

    TEXT_RESULTS = auto()
    """Functions may return texts."""

    LIST_RESULTS = auto()
    """Functions may return arrays (else they write a parameter)."""

    LOCAL = auto()
    """A routine can be seen by its module alone."""

    RECURSION = auto()
    """A routine may be active twice, each time with variables of its own (else calls that lead back are refused)."""

    COMPUTED_NAMES = auto()
    """A procedure may be called by a name computed at run time."""


# What most languages have.
_USUAL = frozenset((RoutineRule.FUNCTIONS, RoutineRule.TEXT_RESULTS, RoutineRule.LOCAL, RoutineRule.RECURSION))


@dataclass(frozen=True, slots=True)
class Routines:
    """What routines can be."""

    parameters: Parameters = Parameters.NAMES

    passing: frozenset[Passing] = frozenset((Passing.REFERENCES, Passing.ARRAYS_BY_VALUE, Passing.WRITTEN_LISTS))

    locals: frozenset[Local] = frozenset((Local.VARIABLES, Local.CLOCKS))

    rules: frozenset[RoutineRule] = _USUAL

    most_arguments: int = 0
    """How many arguments a call has at most (0: any)."""
