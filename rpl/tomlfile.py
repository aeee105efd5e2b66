"""Settings files (cells, robots, controllers) are TOML: reading one, the lines of keys, and numbers that are none.

Numbers that no machine has are refused where they are read: what a planner makes of a speed of 1e-300 or of limits of
1e9 degrees is a run that never ends, or an answer that looks like one.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator
from typing import Any

# No speed, acceleration, scale or time of a settings file is larger, no speed or acceleration smaller (mm, deg, s, %).
LARGEST, SMALLEST = 1e9, 1e-6
# No length is longer and no axis goes farther, mm or degrees.
FARTHEST = 1e6

Lines = dict[tuple[str, str], int]
_HEADER = re.compile(r"\s*\[\[?\s*([^\]]+?)\s*\]")
_KEY = re.compile(r"\s*(?:\"([^\"\n]*)\"|'([^'\n]*)'|([\w-]+))\s*[=.]")
_DIGITS = re.compile(r"\d[\d_]{4300,}")
_AT = re.compile(r"\(at line (\d+), column \d+\)")
_STEP = re.compile(r"(.*)\[(\d+)\]")
_WHOLE = 2**63  # TOML 1.0: whole numbers have 64 bits


class TomlError(ValueError):
    """The text is no TOML. `line`: where, 0 where that is not known; `key`: what stands there, perhaps."""

    def __init__(self, reason: str, line: int, key: str) -> None:
        super().__init__(reason)
        self.line = line
        self.key = key

    def at(self, place: str) -> str:
        """The complaint behind the file, the line and the key."""
        where = f"{place}:{self.line}" if self.line else place
        return f"{where}: '{self.key}': {self}" if self.key else f"{where}: {self}"


def read_toml(text: str) -> dict[str, Any]:
    """The table that a text holds. Raises TomlError."""
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = _AT.search(str(error))
        raise _error(text, str(error), int(found[1]) if found else 0) from None
    except RecursionError:
        raise TomlError("its lists and tables are nested too deeply", 0, "") from None
    except ValueError:  # whole numbers of more than 4,300 digits are not even read
        long = _DIGITS.search(text)
        line = text.count("\n", 0, long.start()) + 1 if long else 0
        raise _error(text, "a number has more than 4300 digits", line) from None
    for path, value in _values(table):
        if isinstance(value, int) and not -_WHOLE <= value < _WHOLE:
            raise TomlError("a whole number has more than 64 bits", line_of(key_lines(text), path), path)
    return table


def _error(text: str, reason: str, line: int) -> TomlError:
    lines = text.split("\n")
    key = _KEY.match(lines[line - 1]) if 0 < line <= len(lines) else None
    return TomlError(reason, line, _name(key) if key else "")


def _name(key: re.Match[str]) -> str:
    return str(key[key.lastindex or 0])


def key_lines(text: str) -> Lines:
    """Where each key of each table stands: (table or "", key) to the number of its line; the key "" is the header. The
    second table of a list of them is called `link 2`."""
    found: Lines = {("", ""): 1}
    counts: dict[str, int] = {}
    table = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _HEADER.match(line):
            counts[header[1]] = counts.get(header[1], 0) + 1
            table = header[1] if counts[header[1]] == 1 else f"{header[1]} {counts[header[1]]}"
            found[table, ""] = number
        elif key := _KEY.match(line):
            found.setdefault((table, _name(key)), number)
    return found


def line_of(lines: Lines, path: str) -> int:
    """The line of a key such as `input[2].time`, `system.path_speed` or `analog.tp.AO[1].volts`; that of the table
    where the key is missing, and 0 where nothing of it is found."""
    if ("", path) in lines:
        return lines["", path]
    steps = path.split(".")
    for count in range(len(steps) - 1, -1, -1):
        table, rest = ".".join(_table(step) for step in steps[:count]), ".".join(steps[count:])
        inner = _STEP.fullmatch(steps[count])
        for key in (rest, steps[count], inner[1] if inner else steps[count]):
            if (table, key) in lines:
                return lines[table, key]
        if table and (table, "") in lines:
            return lines[table, ""]
    return lines.get((_table(path), ""), 0)


def _table(step: str) -> str:
    """`input[2]` as `key_lines` names it."""
    found = _STEP.fullmatch(step)
    if found is None:
        return step
    return found[1] if found[2] == "1" else f"{found[1]} {found[2]}"


def no_numbers(table: dict[str, Any]) -> Iterator[tuple[str, float]]:
    """Keys in a table, as `line_of` takes them, whose value is infinite or no number."""
    return ((path, value) for path, value in _values(table) if isinstance(value, float) and not math.isfinite(value))


def _values(table: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Everything in the tables and lists of a table, with its key, in order."""
    ahead: list[tuple[str, Any]] = [("", table)]
    while ahead:
        path, value = ahead.pop()
        if isinstance(value, dict):
            ahead += [(f"{path}.{key}" if path else key, inner) for key, inner in reversed(value.items())]
        elif isinstance(value, list):
            ahead += [(f"{path}[{place}]", inner) for place, inner in reversed([*enumerate(value, 1)])]
        else:
            yield path, value
