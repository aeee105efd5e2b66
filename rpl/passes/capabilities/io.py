"""A target's signals, flags, waits and clocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum, auto


class GroupRule(StrEnum):
    """What a group of signals can be. Where signals have names (`signal_prefixes`), a group has one of its own; groups
    of which a part is used otherwise are written bit by bit."""

    COMPUTED = auto()
    """It may have computed numbers (else such groups of a constant width are written bit by bit, as where signals have
    names)."""

    NUMBERED = auto()
    """It has a number of its own beside those of its bits (GO[2])."""


class PulseRule(StrEnum):
    """What a Pulse can be."""

    ANY_LEVEL = auto()  # else it is to high
    COMPUTED_TIME = auto()  # else its length is a number


@dataclass(frozen=True, slots=True)
class Io:
    """Signals, flags, waits and clocks."""

    signal_prefixes: Mapping[str, str] = field(default_factory=dict)
    """Empty when signals have numbers (KRL); otherwise signals have names (RAPID), and a number 5 of a kind is called
    prefix + 5."""

    own_signals: frozenset[str] = frozenset()
    """Folded names of signals that the controller has under these names, beside those that have numbers (TP RO[2])."""

    number_data: Mapping[str, tuple[tuple[int, int, int], ...]] = field(default_factory=dict)
    """Programs name signals that have numbers by data that holds these, at their head: of a kind, the first and the
    last number and what the data has more than the number (V+: 1 to 512 are inputs 1001 to 1512)."""

    groups: frozenset[GroupRule] = frozenset((GroupRule.COMPUTED,))

    widest_group: int = 8
    """Bits of a group at most, where a program shows that eight are not enough."""

    pulses: frozenset[PulseRule] = frozenset(PulseRule)

    last_flag: int | None = None
    """The largest number of a flag there is (None: any, or the passes give them names; 0: there are no flags); flags
    beyond it are data."""

    timers: int = 0
    """How many system timers there are (`timer[1]` ...)."""

    wait_timeout: bool = False
    """WaitUntil takes a timeout."""

    wait_answers: bool = True
    """A wait with a timeout says whether it took too long, in a word of its own (else what it waited for is asked once
    more behind it, as where the answer takes lines of its own or the wait is a loop)."""

    waits_at_rest: bool = True
    """Waits say that the robot stands before they begin."""

    shortest_wait_s: float = 0.0
    """The smallest time that a wait can be given (0: any)."""

    poll_s: float = 0.008
    """Time between two looks in a loop that waits for a condition, for targets without WaitUntil."""
