"""The files of a virtual controller, in memory, and why it may refuse to touch them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from typing import Literal

from rpl.controllers.virtual.faults import Faults

Why = Literal["missing", "protected", "full", "busy", "syntax", "name", "exists", "emergency-stop"]
ROOM = 64 * 2**20  # bytes


class NotDoneError(Exception):
    """The controller refuses; every maker says it in its own words. `said`: what more there is to say."""

    def __init__(self, why: Why, said: str = "") -> None:
        super().__init__(said or why)
        self.why = why
        self.said = said


def takes_all(name: str, data: bytes) -> None:
    """A controller that looks at no file when it is written."""


class Store:
    """Files by name ('/' between folders). fold: capitals are no difference in names. may_write(name): raises
    NotDoneError where the controller's state forbids it. accepts(name, data): raises NotDoneError where its loader
    refuses the text. rewrite(name, data): what the controller keeps of a text, where it writes it anew."""

    def __init__(
        self,
        faults: Faults,
        fold: bool = False,
        may_write: Callable[[str], None] = lambda name: None,
        accepts: Callable[[str, bytes], None] = takes_all,
        rewrite: Callable[[str, bytes], bytes] = lambda name, data: data,
    ) -> None:
        self.faults = faults
        self.fold = fold
        self.may_write = may_write
        self.accepts = accepts
        self.rewrite = rewrite
        self.protected: set[str] = set()
        self.lock = threading.RLock()
        self._files: dict[str, tuple[str, bytes]] = {}
        self._written: set[str] = set()

    def _key(self, name: str) -> str:
        clean = name.strip("/")
        return clean.lower() if self.fold else clean

    def fold_names(self) -> None:
        """From now on capitals are no difference in names; of two that differ by them the later one stays."""
        with self.lock:
            self.fold = True
            self._files = {self._key(name): (name, data) for name, data in self._files.values()}

    def renamed(self, how: Callable[[str], str]) -> None:
        """Give every file the name that the controller has for it."""
        with self.lock:
            named = [(how(name), data) for name, data in self._files.values()]
            self._files = {}
            self.put(named)

    def protect(self, name: str, on: bool) -> None:
        """Make a file one that nobody writes, or let it be written again."""
        (self.protected.add if on else self.protected.discard)(self._key(name))

    def names(self) -> list[str]:
        """All of them, in order."""
        with self.lock:
            listed = sorted(name for name, _ in self._files.values())
        return [*listed, "../../evil.txt"] if self.faults.comes("names", counted=False) else listed

    def __contains__(self, name: str) -> bool:
        return self._key(name) in self._files

    def size(self, name: str) -> int:
        if self.faults.comes("huge", counted=False):
            return 2**40
        return len(self.kept(name))

    def kept(self, name: str) -> bytes:
        """What is kept, for the controller itself. Raises NotDoneError("missing")."""
        with self.lock:
            found = self._files.get(self._key(name))
        if found is None:
            raise NotDoneError("missing", name)
        return found[1]

    def read(self, name: str) -> bytes:
        """What a client gets when it reads."""
        data = self.kept(name)
        if self._key(name) in self._written and self.faults.comes("misread"):
            return data[:-1] + bytes([(data[-1] + 1) % 128]) if data else b"?"
        return data

    def put(self, files: Iterable[tuple[str, bytes]]) -> None:
        """What is on the controller from the beginning."""
        for name, data in files:
            self._files[self._key(name)] = (name.strip("/"), data)

    def write(self, name: str, data: bytes) -> None:
        """What a client brings. Raises NotDoneError, and nothing has changed then."""
        with self.lock:
            self.may_write(name)
            if self._key(name) in self.protected or self.faults.comes("protected"):
                raise NotDoneError("protected", name)
            used = sum(len(other) for key, (_, other) in self._files.items() if key != self._key(name))
            if used + len(data) > ROOM or self.faults.comes("full"):
                raise NotDoneError("full", name)
            if self.faults.comes("truncate"):
                data = data[: len(data) // 2]
            else:
                self.accepts(name, data)
                data = self.rewrite(name, data)
            self._files[self._key(name)] = (name.strip("/"), data)
            self._written.add(self._key(name))

    def rename(self, old: str, new: str) -> None:
        """A file takes the name, and the place, of another."""
        with self.lock:
            data = self.kept(old)
            self.may_write(new)
            if self._key(new) in self.protected:
                raise NotDoneError("protected", new)
            del self._files[self._key(old)]
            self._files[self._key(new)] = (new.strip("/"), data)
            self._written.add(self._key(new))

    def delete(self, name: str) -> None:
        with self.lock:
            self.kept(name)
            self.may_write(name)
            if self._key(name) in self.protected:
                raise NotDoneError("protected", name)
            del self._files[self._key(name)]
