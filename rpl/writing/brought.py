"""Routines that a written program brings along for what its controller has no function for: a file of them in the
target's own language, beside its templates.

A program gets those that it uses and those that these call.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from importlib import resources


@dataclass(frozen=True, slots=True)
class Brought:
    """`texts`: the lines of each routine by its name, in the order of the file."""

    texts: Mapping[str, tuple[str, ...]]

    @classmethod
    def of(cls, package: str, file: str, head: str) -> Brought:
        """`head`: pattern of a routine's first line, its name in group 1. A blank line ends a routine."""
        found = {}
        for part in resources.files(package).joinpath(file).read_text(encoding="utf-8").split("\n\n"):
            lines = tuple(part.strip("\n").splitlines())
            if lines and (name := re.match(head, lines[0])):
                found[name[1]] = lines
        return cls(found)

    def needed(self, names: Collection[str]) -> tuple[str, ...]:
        """Names of the routines and of those that they call, each behind what it calls."""
        done: dict[str, None] = {}

        def add(name: str) -> None:
            if name in done:
                return
            for other in self.texts:
                if other != name and any(f"{other}(" in line for line in self.texts[name]):
                    add(other)
            done[name] = None

        for name in self.texts:
            if name in names:
                add(name)
        return tuple(done)
