"""What a connection to a controller can do, whatever its maker, and how it can fail.

A link reads and writes files and tells what state the controller is in. It has no word for starting a program,
selecting one or switching drives on: who brings programs must not be able to move the robot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from rpl.errors import RplError

# No file of a controller is larger (bytes), none holds more of them, and no answer is waited for longer (s).
LARGEST_FILE = 64 * 2**20
MOST_FILES = 20_000
PATIENCE_S = 10.0


class LinkError(RplError):
    """The controller could not be asked or did not do what was asked."""


class LostError(LinkError):
    """The connection is gone, or no answer came in time: what the controller did with the last request is unknown."""


class RefusedError(LinkError):
    """The controller said no, in its own words: it runs, the file is protected, its disk is full. Nothing changed."""


class LoginError(RefusedError):
    """The controller does not know this user or password."""


class NotThereError(RefusedError):
    """The controller has no file of that name."""


class GarbledError(LinkError):
    """The answer is none that this protocol knows, too long, or names what no answer may name."""


class OtherControllerError(LinkError):
    """Another controller answers than the one that is meant, or its key is not the one that was pinned."""


@dataclass(frozen=True, slots=True)
class RemoteFile:
    """A file of the controller: its name as seen from the profile's path ('/' between folders), size in bytes (None:
    the controller does not say)."""

    name: str
    size: int | None = None


@dataclass(frozen=True, slots=True)
class Identity:
    """Who the controller says it is; what it does not say is empty."""

    maker: str = ""
    model: str = ""
    serial: str = ""
    firmware: str = ""
    name: str = ""
    axes: int | None = None

    def said(self) -> dict[str, str]:
        """What is known, by its word."""
        known = {word: getattr(self, word) for word in ("maker", "model", "serial", "firmware", "name")}
        known["axes"] = str(self.axes) if self.axes is not None else ""
        return {word: value for word, value in known.items() if value}


@dataclass(frozen=True, slots=True)
class State:
    """What the controller is doing; None: it does not say. `mode`: as its maker calls it. `selected`: names of
    programs that are loaded or selected for running; `opened`: open in its editor."""

    mode: str | None = None
    running: bool | None = None
    motors_on: bool | None = None
    emergency_stop: bool | None = None
    program: str | None = None
    line: int | None = None
    selected: tuple[str, ...] | None = None
    opened: tuple[str, ...] | None = None

    def as_json(self) -> dict[str, object]:
        return {
            word: list(value) if isinstance(value := getattr(self, word), tuple) else value
            for word in ("mode", "running", "motors_on", "emergency_stop", "program", "line", "selected", "opened")
        }


class Link(Protocol):
    """A connection to one controller. Names are as in `RemoteFile`. Every call raises a LinkError when it fails, and
    none waits longer than the profile's patience for one answer."""

    @property
    def can_rename(self) -> bool:
        """Can a file be written under another name first, and take its place in one step?"""

    def identity(self) -> Identity: ...
    def state(self) -> State: ...
    def files(self) -> Sequence[RemoteFile]:
        """The program files that the controller holds, in the order of their names."""

    def fetch(self, name: str) -> bytes:
        """The bytes of a file. Raises NotThereError."""

    def put(self, name: str, data: bytes) -> None:
        """Write a file whole; one of that name is replaced."""

    def rename(self, old: str, new: str) -> None:
        """Give a file another name; one that has that name is replaced (only where `can_rename`)."""

    def delete(self, name: str) -> None:
        """Remove a file. Raises NotThereError."""

    def lock(self) -> None:
        """Take what the controller wants a writer to hold (mastership); never from somebody else by force."""

    def unlock(self) -> None:
        """Give it back."""

    def take_in(self, names: Sequence[str]) -> None:
        """Let the controller load files that were written, where it does not by itself; selects and starts nothing."""

    def take_out(self, names: Sequence[str]) -> None:
        """Let the controller let go of files that it may have been made to load and that are to be removed again; those
        that it has not loaded are passed by."""

    def close(self) -> None: ...
