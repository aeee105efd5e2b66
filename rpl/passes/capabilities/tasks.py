"""What a target's tasks can do."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class Background(StrEnum):
    """Background programs, where nothing is started by a statement."""

    NO = auto()
    SHARED = auto()  # they see the data of the others
    SEPARATE = auto()  # modules of their own that share persistent data by name; they can ask where the robot is


@dataclass(frozen=True, slots=True)
class Tasks:
    """What tasks can do."""

    operations: frozenset[str] = frozenset(("start", "stop", "pause", "resume", "join"))
    """Ops of TaskControl, where that is in `statements`."""

    background: Background = Background.NO

    moving: bool = True
    """A task that the program starts may move the robot."""
