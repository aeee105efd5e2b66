"""Where a target keeps data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum, auto


@dataclass(frozen=True, slots=True)
class Bank:
    """Numbered storage of a controller: elements `first`..`last` under one name (`R[1]`..`R[200]`)."""

    name: str
    first: int
    last: int

    holds: str = ""
    """What else has these numbers, a kind of signal or a system variable (flags, timers)."""

    most: int = 0
    """The last number there can be when the controller is set up for more (0: there are never more)."""


class ModulePoints(StrEnum):
    """Taught points that are data of the module."""

    NO = auto()
    MODULE = auto()  # constants of it
    GLOBAL = auto()  # constants, where all modules share their names
    LIST = auto()  # a data list that the pendant changes


@dataclass(frozen=True, slots=True)
class Storage:
    """Where data is kept."""

    banks: Mapping[str, Bank] = field(default_factory=dict)
    """Where variables of a type (class name) are kept, when they have numbers and no names; types may share a bank."""

    own: frozenset[str] = frozenset()
    """Data of the controller's own (frames by number, an outcome that it jumps by), which keep their names."""

    points: Bank | None = None
    """Taught points that live in a routine."""

    module_points: ModulePoints = ModulePoints.NO
