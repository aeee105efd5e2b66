"""The words of a language, which its reader and its writer share: `words.toml` in the folder of its dialect.

Each fact of the vocabulary stands there once: names of functions and system variables with their units, reserved words,
words of types, numbers of errors. A reader takes a table as it stands, a writer from the other side.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Words:
    """The tables of one `words.toml`. Each method raises TypeError where what stands there has another form."""

    table: Mapping[str, object]

    def listed(self, key: str) -> tuple[str, ...]:
        """The words of a text, which white space parts."""
        text = self.table[key]
        if not isinstance(text, str):
            raise TypeError(f"{key} is no text")
        return tuple(text.split())

    def pairs(self, key: str) -> dict[str, str]:
        """A table of texts, in its order."""
        return _texts(key, self.table[key])

    def numbers(self, key: str) -> dict[str, int | float]:
        """A table of numbers, in its order."""
        table = self.table[key]
        if not isinstance(table, dict):
            raise TypeError(f"{key} is no table")
        found = {name: value for name, value in table.items() if isinstance(value, int | float)}
        if len(found) < len(table):
            raise TypeError(f"{key} holds more than numbers")
        return found

    def nested(self, key: str) -> dict[str, dict[str, str]]:
        """A table of tables of texts, in its order."""
        table = self.table[key]
        if not isinstance(table, dict):
            raise TypeError(f"{key} is no table")
        return {name: _texts(f"{key}.{name}", inner) for name, inner in table.items()}


def _texts(key: str, table: object) -> dict[str, str]:
    if not isinstance(table, dict):
        raise TypeError(f"{key} is no table")
    found = {name: value for name, value in table.items() if isinstance(name, str) and isinstance(value, str)}
    if len(found) < len(table):
        raise TypeError(f"{key} holds more than texts")
    return found


def lowered(pairs: Mapping[str, str]) -> dict[str, str]:
    """The same with keys in small letters, for a language that does not tell capitals apart."""
    return {key.lower(): value for key, value in pairs.items()}


def spelled(pairs: Mapping[str, str]) -> dict[str, str]:
    """From the other side: what a word means -> the first word that means it."""
    found: dict[str, str] = {}
    for word, meaning in pairs.items():
        found.setdefault(meaning, word)
    return found
