"""Rows of a cell file, read with the place of each mistake: what every table of it needs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rpl.errors import UsageError
from rpl.tomlfile import Lines, line_of

Value = Any  # what TOML can say: numbers, BOOLs, texts, lists, tables
LONGEST_S = 1e9  # no time of a cell is longer


class RowReader:
    """Reads values of rows; what is wrong is raised with file, line and key."""

    def __init__(self, path: str, lines: Lines) -> None:
        self.path = path
        self.lines = lines

    def wrong(self, key: str, what: str) -> UsageError:
        line = line_of(self.lines, key)
        return UsageError(f"{self.path}{f':{line}' if line else ''}: {key}: {what}")

    def rows(self, table: dict[str, Value], name: str) -> Iterator[tuple[str, dict[str, Value]]]:
        rows = table.get(name, [])
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            raise self.wrong(name, f"must be written as [[{name}]] tables")
        for number, row in enumerate(rows, 1):
            yield f"{name}[{number}]", row

    def known(self, key: str, row: dict[str, Value], needed: tuple[str, ...], more: tuple[str, ...] = ()) -> None:
        for name in needed:
            if name not in row:
                raise self.wrong(f"{key}.{name}", "is missing")
        for name in row:
            if name not in needed and name not in more:
                raise self.wrong(f"{key}.{name}", f"unknown; there are {', '.join((*needed, *more))}")

    def seconds(self, key: str, row: dict[str, Value], name: str, default: float = 0.0) -> float:
        value = row.get(name, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= LONGEST_S:
            raise self.wrong(f"{key}.{name}", f"must be a time in s, not {value!r}")
        return float(value)

    def text(self, key: str, row: dict[str, Value], name: str) -> str:
        value = row.get(name, "")
        if not isinstance(value, str):
            raise self.wrong(f"{key}.{name}", f"must be a text, not {value!r}")
        return value

    def times(self, key: str, row: dict[str, Value], name: str) -> tuple[int, ...]:
        """The first, the third...: whole numbers from 1."""
        given = row.get(name, [])
        if not isinstance(given, list) or not all(type(one) is int and one >= 1 for one in given):
            raise self.wrong(f"{key}.{name}", f"must be a list of whole numbers from 1, not {given!r}")
        return tuple(given)

    def signal(self, key: str, row: dict[str, Value], name: str) -> Value:
        value = row[name]
        if not isinstance(value, bool | int | float):
            raise self.wrong(f"{key}.{name}", f"must be true, false or a number, not {value!r}")
        return value
