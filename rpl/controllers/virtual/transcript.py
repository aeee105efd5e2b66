"""What a virtual controller was told, in order: tests ask it what a client did, and what it never did."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

# What a request is about. `start`, `select` and `servo` are what no transfer of programs may ever ask for.
Kind = (
    Literal["connect", "login", "look", "list", "read", "write", "delete", "lock", "load", "set", "other"]
    | Literal["start", "stop", "select", "servo"]
)
_LONGEST = 300


@dataclass(frozen=True, slots=True)
class Told:
    """One request: t, s since the controller was switched on, the interface it came by, what it is about, its words."""

    t: float
    interface: str
    kind: Kind
    text: str

    def as_json(self) -> dict[str, object]:
        return {"t": round(self.t, 6), "interface": self.interface, "kind": self.kind, "text": self.text}


@dataclass(slots=True)
class Transcript:
    """Kept in memory, and a line of JSON for each request in a file where one is named."""

    file: Path | None = None
    requests: list[Told] = field(default_factory=list)
    began: float = field(default_factory=time.monotonic)

    def add(self, interface: str, kind: Kind, text: str) -> None:
        told = Told(time.monotonic() - self.began, interface, kind, text[:_LONGEST])
        self.requests.append(told)
        if self.file is not None:
            with self.file.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(told.as_json(), ensure_ascii=False) + "\n")
