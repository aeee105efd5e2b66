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

    next_move: bool = False
    """SetForNextMove can be said; otherwise it is attached to the next move."""

    reads_override: bool = True
    """A program may read the override that it can set."""

    asked_frames: bool = True
    """A program can ask for the frame in force (else a variable keeps it where one does)."""

    tool_in_force: bool = True
    """Asking for a place without a tool means the one of the last move (else each such question names one)."""

    no_tool: str = ""
    """The target's own tool data without any offset, where moves name such data and no plain poses."""

    no_frame: str = ""
    """The same for the work object."""
