"""What a target's data can be."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class Aggregate(StrEnum):
    """How a value with components is written."""

    NAMED = auto()  # each is named (else listed in order)
    PARTIAL = auto()  # some may be left out
    CONSTANT = auto()  # they must be constants


class Composite(StrEnum):
    """Kinds of types a program makes. Without ARRAYS, an array is consecutive numbers of a bank."""

    RECORDS = auto()
    ARRAYS = auto()
    ENUMS = auto()


class DataRule(StrEnum):
    """What else is true of data."""

    LISTS = auto()
    """Values of a module stand in a list of data apart from the program; they are set there, or at its start."""

    ALIASES = auto()
    """A type may have a second name."""

    ROW_SIZES = auto()
    """The function `dimension` tells of a list in lists how many there are in any of its dimensions (else the sizes of
    such a list come with it where a routine is given it)."""

    COMPARED_RECORDS = auto()
    """Whole records are compared (else each of their components)."""


@dataclass(frozen=True, slots=True)
class Data:
    """What data can be."""

    aggregates: frozenset[Aggregate] = frozenset()

    composites: frozenset[Composite] = frozenset((Composite.RECORDS, Composite.ARRAYS))

    rules: frozenset[DataRule] = frozenset((DataRule.ROW_SIZES,))
