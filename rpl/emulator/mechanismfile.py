"""External mechanisms as data: tracks, turn-tables and positioners, from `[[mechanism]]` tables of robot or cell files.

    [[mechanism]]
    name = "table"                       what programs call it;  also = ["STN1", "GP2"]  names in other languages
    kind = "rotary"                      track (sliding axes), rotary (one turning axis), positioner (two of them)
    carries = "work"                     work (frames of programs stand on it) or robot; a track carries the robot
    root = [1200, 0, 400, 0, 0, 0]       in the world: x y z in mm, a b c in degrees (ZYX);  on = "robot": in its base
    flange = [0, 0, 50, 0, 0, 0]         what it carries, from its last axis at zero
    axes = [{ number = 1, direction = "z", limits = [-180, 180], speed = 90 }]

Of an axis: `number` of the external axis that moves it, `direction` (x, -x .. or three numbers) along or about which,
`place` of it from the axis before, `pitch` (mm or degrees of movement per unit of the external axis), limits, speed and
acceleration in units of the external axis, `pulses` per unit for controllers that count them. Only reading and
checking; the poses are in `rpl.emulator.mechanisms`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from rpl.errors import UsageError
from rpl.tomlfile import FARTHEST, LARGEST, SMALLEST, Lines, line_of

KINDS = {"track": (1, 3), "rotary": (1, 1), "positioner": (2, 2)}  # kind -> how many axes
MOST_EXTERNAL = 6
_DIRECTIONS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_NOWHERE = (0.0,) * 6
_KEYS = ("name", "also", "kind", "carries", "on", "root", "flange", "axes")
_AXIS_KEYS = ("number", "direction", "place", "pitch", "limits", "speed", "acceleration", "pulses")

# Pulses per degree (or mm) of arms whose own controller counts none, for programs of controllers that do. Neutral: one
# count is 0.0001 degrees, as in other angles of such programs.
NEUTRAL_PULSES = 10000.0

Six = tuple[float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class MechanismAxis:
    """One axis. `direction` is a unit vector; `speed` and `acceleration` None: those of an axis without data. `pulses`:
    motor pulses per unit of the external axis, where a controller counts in them."""

    number: int
    sliding: bool
    direction: tuple[float, float, float]
    place: Six = _NOWHERE
    pitch: float = 1.0
    limits: tuple[float, float] | None = None
    speed: float | None = None
    acceleration: float | None = None
    pulses: float | None = None


@dataclass(frozen=True, slots=True)
class Mechanism:
    """A mechanism: `root` in the world (or in the robot's base where `on_robot`), `flange` on its last axis, both as
    x y z in mm and ZYX angles in degrees."""

    name: str
    kind: str
    axes: tuple[MechanismAxis, ...]
    names: frozenset[str]
    carries_robot: bool = False
    on_robot: bool = False
    root: Six = _NOWHERE
    flange: Six = _NOWHERE

    def is_called(self, name: str) -> bool:
        """Is this one of its names? Capital letters do not count."""
        return name.strip().lower() in self.names


def read_mechanisms(rows: object, file: str, lines: Lines | None = None) -> tuple[Mechanism, ...]:
    """The `[[mechanism]]` tables of a file; UsageError with file, line (where `lines` tells it) and key when one is
    wrong."""
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise UsageError(f"{file}: mechanism: must be written as [[mechanism]] tables")
    readers = [_Reader(file, f"mechanism[{place}]", row, lines or {}) for place, row in enumerate(rows, 1)]
    return checked_together(tuple(reader.mechanism() for reader in readers), file)


def checked_together(found: tuple[Mechanism, ...], file: str) -> tuple[Mechanism, ...]:
    """Mechanisms of one cell: no name and no external axis twice, at most one carries the robot."""
    names: set[str] = set()
    numbers: set[int] = set()
    for one in found:
        for name in sorted(one.names & names):
            raise UsageError(f"{file}: mechanism: two have the name '{name}'")
        for axis in one.axes:
            if axis.number in numbers:
                raise UsageError(f"{file}: mechanism '{one.name}': external axis {axis.number} is used twice")
            numbers.add(axis.number)
        names |= one.names
    if sum(one.carries_robot for one in found) > 1:
        raise UsageError(f"{file}: mechanism: only one can carry the robot")
    return found


def pulses_of(mechanisms: tuple[Mechanism, ...], number: int, neutral: bool) -> float | None:
    """Motor pulses per unit of an external axis; the `neutral` scale where nobody counts; None: not known."""
    for one in mechanisms:
        for axis in one.axes:
            if axis.number == number and axis.pulses is not None:
                return axis.pulses
    return NEUTRAL_PULSES if neutral else None


@dataclass(frozen=True, slots=True)
class _Reader:
    file: str
    key: str
    row: dict[str, object]
    lines: Lines

    def wrong(self, key: str, what: str) -> UsageError:
        line = line_of(self.lines, f"{self.key}.{key}")
        return UsageError(f"{self.file}{f':{line}' if line else ''}: {self.key}.{key}: {what}")

    def known(self, keys: tuple[str, ...]) -> None:
        for key in self.row:
            if key not in keys:
                raise self.wrong(key, f"unknown; there are {', '.join(keys)}")

    def mechanism(self) -> Mechanism:
        self.known(_KEYS)
        name = self.row.get("name")
        if not isinstance(name, str) or not name.strip():
            raise self.wrong("name", "must be a text that is not empty")
        also = self.row.get("also", [])
        if not isinstance(also, list) or not all(isinstance(one, str) and one.strip() for one in also):
            raise self.wrong("also", "must be a list of names")
        kind = self.row.get("kind")
        if not isinstance(kind, str) or kind not in KINDS:
            raise self.wrong("kind", f"must be one of {', '.join(KINDS)}, not {kind!r}")
        carries = self.row.get("carries", "robot" if kind == "track" else "work")
        if carries not in ("robot", "work"):
            raise self.wrong("carries", f"must be robot or work, not {carries!r}")
        on = self.row.get("on", "world")
        if on not in ("world", "robot") or (on == "robot" and carries == "robot"):
            raise self.wrong("on", "must be world or, of what does not carry the robot, robot")
        names = frozenset(one.strip().lower() for one in (name, *also))
        return Mechanism(
            name, kind, self.axes(kind), names, carries == "robot", on == "robot", self.six("root"), self.six("flange")
        )

    def axes(self, kind: str) -> tuple[MechanismAxis, ...]:
        rows = self.row.get("axes")
        fewest, most = KINDS[kind]
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            raise self.wrong("axes", "must be a list of tables, one for each axis")
        if not fewest <= len(rows) <= most:
            count = str(fewest) if fewest == most else f"{fewest} to {most}"
            raise self.wrong("axes", f"a {kind} has {count}, not {len(rows)}")
        keys = (f"{self.key}.axes[{place}]" for place in range(1, len(rows) + 1))
        readers = [_Reader(self.file, key, row, self.lines) for key, row in zip(keys, rows, strict=True)]
        return tuple(reader.axis(kind == "track") for reader in readers)

    def axis(self, sliding: bool) -> MechanismAxis:
        self.known(_AXIS_KEYS)
        number = self.row.get("number")
        if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= MOST_EXTERNAL:
            raise self.wrong("number", f"must be the number of an external axis, 1 to {MOST_EXTERNAL}, not {number!r}")
        pitch = self.number("pitch", 1.0)
        if pitch == 0.0:
            raise self.wrong("pitch", "must not be zero: the axis would not move")
        if not SMALLEST <= abs(pitch) <= LARGEST:
            raise self.wrong("pitch", f"must be from {SMALLEST:f} to {LARGEST:,.0f}, not {pitch:g}")
        speed, acceleration, pulses = (self.above_zero(key) for key in ("speed", "acceleration", "pulses"))
        return MechanismAxis(
            number, sliding, self.direction(), self.six("place"), pitch, self.limits(), speed, acceleration, pulses
        )

    def direction(self) -> tuple[float, float, float]:
        given = self.row.get("direction", "z")
        if isinstance(given, str) and given.lstrip("+-") in _DIRECTIONS and len(given) <= 2:
            x, y, z = _DIRECTIONS[given[-1]]
            sign = -1.0 if given.startswith("-") else 1.0
            return sign * x, sign * y, sign * z
        numbers = _numbers(given, 3)
        length = math.hypot(*numbers) if numbers is not None else 0.0
        if numbers is None or length < 1e-9:
            raise self.wrong("direction", f"must be x, y, z, -x, -y, -z or three numbers, not {given!r}")
        return numbers[0] / length, numbers[1] / length, numbers[2] / length

    def six(self, key: str) -> Six:
        if key not in self.row:
            return _NOWHERE
        numbers = _numbers(self.row[key], 6)
        if numbers is None:
            raise self.wrong(key, "must be six numbers: x y z in mm, a b c in degrees")
        if max(map(abs, numbers)) > FARTHEST:
            raise self.wrong(key, f"no place is farther than {FARTHEST:,.0f}")
        return numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]

    def limits(self) -> tuple[float, float] | None:
        if "limits" not in self.row:
            return None
        numbers = _numbers(self.row["limits"], 2)
        if numbers is None or numbers[0] > numbers[1]:
            raise self.wrong("limits", f"must be [lower, upper], not {self.row['limits']!r}")
        if max(abs(numbers[0]), abs(numbers[1])) > FARTHEST:
            raise self.wrong("limits", f"no axis goes farther than {FARTHEST:,.0f}")
        return numbers[0], numbers[1]

    def number(self, key: str, default: float) -> float:
        numbers = _numbers([self.row.get(key, default)], 1)
        if numbers is None:
            raise self.wrong(key, f"must be a number, not {self.row.get(key)!r}")
        return numbers[0]

    def above_zero(self, key: str) -> float | None:
        if key not in self.row:
            return None
        value = self.number(key, 0.0)
        if value <= 0.0:
            raise self.wrong(key, f"must be above zero, not {value:g}")
        if not SMALLEST <= value <= LARGEST:
            raise self.wrong(key, f"must be from {SMALLEST:f} to {LARGEST:,.0f}, not {value:g}")
        return value


def _numbers(value: object, count: int) -> tuple[float, ...] | None:
    """So many numbers of some use, or None."""
    if not isinstance(value, list) or len(value) != count:
        return None
    if not all(isinstance(one, int | float) and not isinstance(one, bool) for one in value):
        return None
    return tuple(float(one) for one in value) if all(abs(one) <= LARGEST for one in value) else None
