"""What a target does about errors."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class Fault(StrEnum):
    """What stops the controller (else the program looks first)."""

    INDEX_OUTSIDE = auto()  # an index outside of an array
    INDEX_FRACTION = auto()  # an index with a fraction (else it is rounded or cut)
    TEXT_PART = auto()  # a part beyond the end of its text (else it is shorter or empty)


@dataclass(frozen=True, slots=True)
class Errors:
    """What is done about errors."""

    handlers: bool = False
    """A routine may handle errors."""

    faults: frozenset[Fault] = frozenset(Fault)
