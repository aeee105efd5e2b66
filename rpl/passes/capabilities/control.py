"""A target's structure and expressions.

Which of If, Switch, For, While, Repeat, Loop, ExitLoop, NextPass, Goto, Label stand in `statements` says what structure
there is; without If there is still `If` with one Goto as its only branch.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class Counting(StrEnum):
    """The rule of a FOR."""

    AT_LEAST_ONCE = auto()  # the first pass runs whatever the last value is
    SCOPED = auto()  # the counter is the loop's own
    AUTOMATIC = auto()  # it counts down by itself where the last value is smaller
    REAL = auto()  # the counter may be a real number
    KEEPS_LAST = auto()  # the counter keeps the last value a pass ran with
    LOOKS_EACH_PASS = auto()  # the last value is looked at before each pass (else before the first only)
    ONE_STEP = auto()  # only up or down by 1


class Limit(StrEnum):
    """What expressions and choices cannot be."""

    STEPS = auto()
    """An assignment has one operator or function of constants and variables."""

    COMPARISONS = auto()
    """Conditions are comparisons of two simple operands, joined by and/or."""

    PLAIN_PLACES = auto()
    """Moves, signals and waits take no calculation."""

    FUNCTIONS_ALONE = auto()
    """A function stands only as the whole right side of an assignment."""

    ONE_BRANCH = auto()
    """An If has one condition."""

    CONSTANT_CASES = auto()
    """Case values are literals."""


@dataclass(frozen=True, slots=True)
class Control:
    """What structure and expressions can be."""

    counting: frozenset[Counting] = frozenset()

    limits: frozenset[Limit] = frozenset()

    short_circuit: bool = False
    """`and` and `or` end early."""

    switch_types: frozenset[str] = frozenset()
    """Type classes a Switch may select by (NamedType: enumerations); empty: any type."""
