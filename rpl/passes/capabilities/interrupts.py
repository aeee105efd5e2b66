"""What a target's interrupts can do, and which of them are tasks that watch."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class InterruptRule(StrEnum):
    """What interrupts can do."""

    STOPPING = auto()
    """Brake the robot and drop its move (DeclareInterrupt `stops`); the program goes on behind that."""

    MASKED = auto()
    """The less urgent ones can be made to wait (ControlInterrupt `mask`)."""

    ONE_SHOT = auto()
    """One that has come is off until it is armed again (DeclareInterrupt `once`); elsewhere it comes at each edge."""

    SINGLE_DISABLES = auto()
    """A single one can be disabled."""


class Watched(StrEnum):
    """What stands in `statements` although the controller has none: passes make tasks that watch beside moves."""

    NOTHING = auto()
    INTERRUPTS = auto()  # one that stops the robot ends its moves by a search
    ALL = auto()  # path events and searches too


class ActionArguments(StrEnum):
    """What a call may be given: one of an interrupt, of a place on the path, and variables of the routine around."""

    REACTION = auto()
    PATH = auto()
    OWN = auto()


@dataclass(frozen=True, slots=True)
class Interrupts:
    """What interrupts can do."""

    rules: frozenset[InterruptRule] = frozenset()

    watched: Watched = Watched.NOTHING

    action_arguments: frozenset[ActionArguments] = frozenset((ActionArguments.REACTION, ActionArguments.PATH))
