"""A recorded motion as CSV: a header line, then a line per moment with the time in s and joints or a pose.

Columns by name, in any order, others are left alone: `time` (or `t`, `time_s`); `j1`..`jn` in the robot's pendant
units; `x`, `y`, `z` in mm of the tool centre point in the robot's base frame. Between semicolons decimals may stand
behind a comma. Every fault names file and line.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass

import numpy as np

from rpl.emulator.rotations import FloatArray
from rpl.errors import UsageError
from rpl.source import read_bytes

TIMES = ("time", "t", "time_s")
PLACE = ("x", "y", "z")
FEWEST = 20
# Moments further apart than this (s) say nothing about ramps: such a time is in another unit.
WIDEST_S = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """Times (k,) s, rising, and values (k, n): joints in pendant units, or (k, 3) places of the tool in mm."""

    path: str
    times: FloatArray
    values: FloatArray
    joints: bool

    @property
    def unit(self) -> str:
        return "deg" if self.joints else "mm"

    def thinned(self, most: int) -> Log:
        """Every so-many-th moment, so that at most `most` are left."""
        step = max(-(-len(self.times) // most), 1)
        return Log(self.path, self.times[::step], self.values[::step], self.joints)


def read_log(path: str, axes: int) -> Log:
    """Read a log of a robot with that many axes. Raises UsageError with file and line."""
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text in UTF-8"
        raise UsageError(f"{path}: the log cannot be read: {reason}") from error
    lines = text.splitlines()
    if not lines:
        raise UsageError(f"{path}:1: the log is empty")
    separator = ";" if lines[0].count(";") > lines[0].count(",") else ","
    reader = csv.reader(lines, delimiter=separator)
    try:
        rows = list(reader)
    except csv.Error as error:
        raise UsageError(f"{path}:{reader.line_num}: {error}") from None
    names = [name.strip().lower() for name in rows[0]]
    time_name = next((name for name in TIMES if name in names), None)
    if time_name is None:
        raise UsageError(f"{path}:1: the header has no column 'time' (found: {', '.join(names)})")
    wanted = _columns(path, names, axes)
    places = [names.index(name) for name in (time_name, *wanted)]
    numbers: list[list[float]] = []
    for line, row in enumerate(rows[1:], 2):
        if not any(cell.strip() for cell in row):
            continue
        here = [_number(path, line, row, place, names, separator == ";") for place in places]
        if numbers and here[0] <= numbers[-1][0]:
            raise UsageError(f"{path}:{line}: the time {here[0]:g} does not rise (before: {numbers[-1][0]:g})")
        numbers.append(here)
    if len(numbers) < FEWEST:
        raise UsageError(f"{path}:{len(rows)}: {len(numbers)} moments are too few, a fit needs at least {FEWEST}")
    table = np.array(numbers)
    apart = float(np.median(np.diff(table[:, 0])))
    if apart > WIDEST_S:
        hint = "is the time in ms?" if apart <= 1e3 * WIDEST_S else "is the time in microseconds?"
        raise UsageError(f"{path}:2: the moments are {apart:g} s apart, which shows no ramps; times are in s: {hint}")
    return Log(path, table[:, 0], table[:, 1:], wanted != PLACE)


def _columns(path: str, names: list[str], axes: int) -> tuple[str, ...]:
    joints = tuple(f"j{number}" for number in range(1, axes + 1))
    given = [name for name in names if name[:1] == "j" and name[1:].isdigit()]
    if given:
        if sorted(given) != sorted(joints):
            raise UsageError(f"{path}:1: the robot has the joints {', '.join(joints)}, the log {', '.join(given)}")
        return joints
    missing = [name for name in PLACE if name not in names]
    if missing:
        raise UsageError(f"{path}:1: the header needs {', '.join(joints)} or x, y, z; missing {', '.join(missing)}")
    return PLACE


def _number(path: str, line: int, row: list[str], place: int, names: list[str], commas: bool) -> float:
    cell = row[place].strip() if place < len(row) else ""
    if commas and cell.count(",") == 1 and "." not in cell:
        cell = cell.replace(",", ".")
    if not cell:
        raise UsageError(f"{path}:{line}: there is no value in column '{names[place]}'")
    try:
        value = float(cell)
    except ValueError:
        raise UsageError(f"{path}:{line}: '{cell}' in column '{names[place]}' is no number") from None
    if not math.isfinite(value):
        raise UsageError(f"{path}:{line}: '{cell}' in column '{names[place]}' is not finite")
    return value
