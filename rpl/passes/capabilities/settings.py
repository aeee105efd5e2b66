"""Where a target says tool, frame, speed, blend and their kin, and in which quantities."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class MoveSetting(StrEnum):
    """What a move may say itself."""

    TOOL = auto()
    FRAME = auto()
    SPEED = auto()
    BLEND = auto()
    DECELERATION = auto()


class SettingRule(StrEnum):
    """What else is true of settings."""

    NEXT_MOVE = auto()
    """SetForNextMove can be said (else it is attached to the next move)."""

    READ_OVERRIDE = auto()
    """A program may read the override that it can set."""

    ASKED_FRAME = auto()
    """A program can ask for the frame in force (else a variable keeps it where one does)."""

    TOOL_IN_FORCE = auto()
    """Asking for a place without a tool means the one of the last move (else each such question names one)."""


@dataclass(frozen=True, slots=True)
class Settings:
    """What holds for moves, and how it is said."""

    modal: bool
    """Tool, frame, speed and blend are modal (KRL); otherwise each move names them (RAPID)."""

    of_moves: frozenset[MoveSetting] = frozenset()
    """Which of them a move says itself, the rest being modal; empty: all or none, in data of types of RAPID or KRL."""

    speeds: frozenset[str] = frozenset()
    """Fields of ir.Speed that the target says (for joint moves `joint`, `axis`; for the others `path`, ...), where
    moves say something themselves."""

    blends: frozenset[str] = frozenset()
    """Blend classes that it says (BlendStop always), where moves say something themselves."""

    rules: frozenset[SettingRule] = frozenset(
        (SettingRule.READ_OVERRIDE, SettingRule.ASKED_FRAME, SettingRule.TOOL_IN_FORCE)
    )

    bare: tuple[str, str] | None = None
    """The target's own tool data and work object without any offset, where moves name such data and no plain poses."""
