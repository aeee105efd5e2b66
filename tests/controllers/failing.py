"""A controller in memory whose link fails where it is told to: for the rules of sending, without any protocol."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rpl.controllers.link import Identity, LostError, NotThereError, RefusedError, RemoteFile, State
from rpl.controllers.profile import Profile
from rpl.controllers.rules import SendingRules


class Killed(BaseException):
    """This process is killed: nothing of it may run any more, and nothing catches that."""


@dataclass
class Controller:
    """files: what it holds. loaded: what it was made to load. fails: number of the request that fails, `how`: `before`
    or `after` it was carried out (the line is lost), `refuse`, or `kill` (this process); `for_good`: all later ones
    fail as well."""

    files: dict[str, bytes]
    renames: bool = True
    fails: int = 0
    how: str = "before"
    for_good: bool = False
    requests: int = 0
    loaded: list[str] = field(default_factory=list)
    is_running: bool = False
    emergency_stop: bool = False
    locked: bool = False
    serial: str = "1"
    truncates: int = 0
    written: int = 0

    def ask(self, carry_out: str) -> None:
        self.requests += 1
        due = self.requests == self.fails or (self.for_good and 0 < self.fails <= self.requests)
        if due and self.how == carry_out == "before":
            raise LostError("the line is lost")
        if due and self.how == "refuse" and carry_out == "before":
            raise RefusedError("the controller says no")
        if due and self.how == "kill" and carry_out == "before":
            raise Killed

    def done(self) -> None:
        due = self.requests == self.fails or (self.for_good and 0 < self.fails <= self.requests)
        if due and self.how == "after":
            raise LostError("the line is lost")


@dataclass
class FailingLink:
    """A connection to it; each one is good until a request fails."""

    controller: Controller
    is_killed: bool = False

    @property
    def can_rename(self) -> bool:
        return self.controller.renames

    def _asked(self) -> Controller:
        if self.is_killed:
            raise Killed
        try:
            self.controller.ask("before")
        except Killed:
            self.is_killed = True
            raise
        return self.controller

    def identity(self) -> Identity:
        return Identity(serial=self.controller.serial)

    def state(self) -> State:
        here = self._asked()
        found = State(running=here.is_running, emergency_stop=here.emergency_stop, selected=(), opened=())
        here.done()
        return found

    def files(self) -> Sequence[RemoteFile]:
        here = self._asked()
        here.done()
        return [RemoteFile(name, len(data)) for name, data in sorted(here.files.items())]

    def fetch(self, name: str) -> bytes:
        here = self._asked()
        if name not in here.files:
            raise NotThereError(name)
        here.done()
        return here.files[name]

    def put(self, name: str, data: bytes) -> None:
        here = self._asked()
        here.written += 1
        here.files[name] = data[: len(data) // 2] if here.written == here.truncates else data
        here.done()

    def rename(self, old: str, new: str) -> None:
        here = self._asked()
        here.files[new] = here.files.pop(old)
        here.done()

    def delete(self, name: str) -> None:
        here = self._asked()
        if here.files.pop(name, None) is None:
            raise NotThereError(name)
        here.done()

    def lock(self) -> None:
        here = self._asked()
        here.locked = True
        here.done()

    def unlock(self) -> None:
        if not self.is_killed:
            self.controller.locked = False

    def take_in(self, names: Sequence[str]) -> None:
        here = self._asked()
        here.loaded = sorted({*here.loaded, *names})
        here.done()

    def take_out(self, names: Sequence[str]) -> None:
        here = self._asked()
        here.loaded = sorted({*here.loaded} - {*names})
        here.done()

    def close(self) -> None:
        """Nothing is open."""


RULES = SendingRules(programs=("*.src", "*.dat"), denied=("safety*", "$machine.dat"), pairs={".dat": ".src"})


def profile_in(folder: Path, **more: object) -> Profile:
    """A profile whose journals are kept in that folder."""
    return Profile("cell", "test", RULES, {"files": 1}, state_folder=folder, **more)  # type: ignore[arg-type]
