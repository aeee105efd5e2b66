"""How a virtual controller misbehaves when it is asked to: each fault that a sender of programs must survive.

Written as `NAME`, `NAME:NUMBER` or `NAME:NUMBER+`. A fault comes once and then everything is well again, so that what
was interrupted can be finished; with `+` it stays.
"""

from __future__ import annotations

import re
import time
from dataclasses import dataclass

from rpl.errors import UsageError

# Name -> what its number is, its usual number, and what happens.
FAULTS: dict[str, tuple[str, float, str]] = {
    "drop": ("request", 1, "the connection is lost at this request, after the controller has got it"),
    "before": ("request", 1, "the connection is lost at this request, before the controller has got it"),
    "truncate": ("write", 1, "of what this write brings, only the first half is kept, and no error is said"),
    "misread": ("read", 1, "this read of a file that was written gives back other bytes than were kept"),
    "busy": ("-", 1, "a program is running"),
    "protected": ("write", 1, "what this write is for is write-protected"),
    "full": ("write", 1, "there is no room for what this write brings"),
    "login": ("login", 1, "this login is refused"),
    "slow": ("s", 0.2, "every answer takes this long"),
    "estop": ("request", 1, "the emergency stop is pressed at this request"),
    "endless": ("request", 1, "the answer to this request has no end"),
    "garbage": ("request", 1, "the answer to this request is noise"),
    "names": ("-", 1, "the list of files has names that lead elsewhere, such as ../../evil"),
    "huge": ("-", 1, "a file says that it is larger than any is"),
}
_SPELLING = re.compile(r"([a-z]+)(?::(\d+(?:\.\d+)?))?(\+)?")


class DroppedError(Exception):
    """The connection is to be lost now. `got`: the request was carried out before that."""

    def __init__(self, got: bool) -> None:
        super().__init__("the connection is lost")
        self.got = got


@dataclass(slots=True)
class Faults:
    """The fault that is asked for, and how often its occasion has come."""

    name: str = ""
    number: float = 1.0
    stays: bool = False
    count: int = 0

    def comes(self, name: str, counted: bool = True) -> bool:
        """Is this occasion the one at which the fault comes? Each call is an occasion, if `counted`."""
        if name != self.name:
            return False
        if not counted:
            return True
        self.count += 1
        return self.count == self.number or (self.stays and self.count > self.number)

    @property
    def is_on(self) -> str:
        return self.name

    def slow_down(self) -> None:
        """Take the time that a slow controller takes."""
        if self.name == "slow":
            time.sleep(self.number)

    @property
    def delay_s(self) -> float:
        """How long each answer takes (s)."""
        return self.number if self.name == "slow" else 0.0


def fault_of(text: str | None) -> Faults:
    """The fault that is spelled so; None: none. Raises UsageError with all that there are."""
    if not text:
        return Faults()
    found = _SPELLING.fullmatch(text)
    if found is None or found[1] not in FAULTS:
        listed = "; ".join(f"{name}: {said}" for name, (_, _, said) in FAULTS.items())
        raise UsageError(f"no fault {text!r}. There are (NAME, NAME:NUMBER, NAME:NUMBER+ to stay) {listed}")
    usual = FAULTS[found[1]][1]
    return Faults(found[1], float(found[2]) if found[2] else usual, found[3] is not None)
