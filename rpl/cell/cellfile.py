"""Reads a `cell.toml`: inputs over time, reactions to outputs, initial data, the operator's answers, and what vendor
statements stand for. Every error names the file and the key.

    seed = 1                                             of random numbers
    joints = [0, -90, 90, 0, 45, 0]                      where the robot stands at the start (its home if not said)
    external = [0, 500]                                  where external axes stand then (else where a move puts them)
    [[mechanism]] name = "table" ...                     see rpl.emulator.mechanismfile
    [[input]]     time = 1.5  signal = "di1"  value = true  [duration = 0.2]
    [[reaction]]  when = "do1"  becomes = true  after = 0.4  signal = "di2"  value = true  [except = [2, 5]]
    [variables]   count = 3   "module.name" = [1, 2]   "data[1]" = { x = 10.0, y = 0.0 }
    [system]      path_speed = 100.0   tool = { x = 0, y = 0, z = 100, a = 0, b = 0, c = 0 }
    [[answer]]    answer = 2  [text = "regex"]  [after = 1.0]
    [analog.tp]   "AO[1]" = { numbers = [0, 2000], volts = [0, 10] }     or milliamperes = [4, 20]
    [[vendor]]    match = "regex"  effect = "none|message|time"  [seconds = 1.0]  [value = 5]  [set = [["di3", true]]]
    [[routine]]   name = "GRIP"  [seconds = 0.5]  [message = "text"]  [value = 5]  [set = [["di3", true]]]
    [[robot]] [[gripper]] [[fixture]] [[bin]] [[part]] ...   bodies: see rpl.cell.layoutfile
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from rpl import ir, registry
from rpl.cell.layout import Layout
from rpl.cell.layoutfile import TABLES, LayoutReader
from rpl.cell.rows import RowReader, Value
from rpl.emulator.mechanismfile import Mechanism, read_mechanisms
from rpl.errors import UsageError
from rpl.ir.analog import MILLIAMPERES, VOLTS, AnalogRange, AnalogSetting
from rpl.source import read_bytes
from rpl.tomlfile import FARTHEST, LARGEST, SMALLEST, TomlError, key_lines, no_numbers, read_toml


@dataclass(frozen=True, slots=True)
class Input:
    """A signal gets a value at a time."""

    time_s: float
    signal: str
    value: Value


@dataclass(frozen=True, slots=True)
class Reaction:
    """When `when` becomes `value`, `signal` becomes `result` after some seconds. `unanswered`: at which of these times,
    counted from 1, it does not: a gripper that misses, a part that sticks. `deed`: what happens to bodies instead (see
    rpl.cell.world), of rows that follow from the layout."""

    when: str
    value: Value
    after_s: float
    signal: str
    result: Value
    unanswered: tuple[int, ...] = ()
    deed: str = ""


@dataclass(frozen=True, slots=True)
class Answer:
    """The operator's answer to a dialog: to the next one, or to each whose text matches."""

    answer: Value
    after_s: float = 0.0
    text: re.Pattern[str] | None = None


@dataclass(frozen=True, slots=True)
class VendorMeaning:
    """What a statement that only one controller has stands for. `value`: what a vendor function gives."""

    match: re.Pattern[str]
    effect: str = "none"
    seconds: float = 0.0
    message: str = ""
    value: Value = None
    set: tuple[tuple[str, Value], ...] = ()


@dataclass(frozen=True, slots=True)
class RoutineMeaning:
    """What a call of a routine stands for that is not in what was read. `value`: what a function gives."""

    seconds: float = 0.0
    message: str = ""
    value: Value = None
    set: tuple[tuple[str, Value], ...] = ()


NO_BODIES = Layout()


@dataclass(frozen=True, slots=True)
class Cell:
    """Everything a cell file says. `assume_data`: data without a value gets one when it is first read."""

    inputs: tuple[Input, ...] = ()
    reactions: tuple[Reaction, ...] = ()
    variables: Mapping[str, Value] = field(default_factory=dict)
    system: Mapping[str, Value] = field(default_factory=dict)
    answers: tuple[Answer, ...] = ()
    vendor: tuple[VendorMeaning, ...] = ()
    seed: int = 1
    joints: tuple[float, ...] | None = None
    path: str = ""
    mechanisms: tuple[Mechanism, ...] = ()
    external: tuple[float | None, ...] | None = None
    analog: tuple[AnalogSetting, ...] = ()
    routines: Mapping[str, RoutineMeaning] = field(default_factory=dict)  # by folded name
    assume_data: bool = False
    layout: Layout = NO_BODIES


def read_cell(path: str | Path) -> Cell:
    """Read a cell file. Raises UsageError with file and key when it is wrong."""
    try:
        data = read_bytes(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot read the cell file: {error.strerror}") from None
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{path}: a cell file is UTF-8 text") from None
    return parse_cell(text, str(path))


def parse_cell(text: str, path: str = "cell") -> Cell:
    """The cell that a text describes."""
    try:
        table = read_toml(text)
    except TomlError as error:
        raise UsageError(error.at(path)) from None
    reader = _Reader(path, key_lines(text))
    for key, value in no_numbers(table):
        raise reader.wrong(key, f"must be a finite number, not {value}")
    return reader.cell(table)


_TOP = frozenset(
    (
        "seed",
        "assume_data",
        "joints",
        "external",
        "input",
        "reaction",
        "variables",
        "system",
        "answer",
        "answers",
        "vendor",
        "routine",
        "mechanism",
        "analog",
        *TABLES,
    )
)
_MOST_EXTERNAL = 6
# System variables that say how fast something is; of blends they say where one begins.
_RATE = re.compile(r"^(?!blend_).*(speed|acceleration|deceleration)")


def _is_place(value: Value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= FARTHEST


class _Reader(RowReader):
    def cell(self, table: dict[str, Value]) -> Cell:
        for key in table:
            if key not in _TOP:
                raise self.wrong(key, f"unknown; there are {', '.join(sorted(_TOP))}")
        inputs = [made for key, row in self.rows(table, "input") for made in self.input(key, row)]
        inputs.sort(key=lambda item: item.time_s)
        variables, system = table.get("variables", {}), table.get("system", {})
        for key, value in (("variables", variables), ("system", system)):
            if not isinstance(value, dict):
                raise self.wrong(key, "must be a table of names and values")
        for name, value in system.items():
            self.system(name, value)
        seed = table.get("seed", 1)
        if not isinstance(seed, int) or isinstance(seed, bool):
            raise self.wrong("seed", "must be a whole number")
        assume = table.get("assume_data", False)
        if not isinstance(assume, bool):
            raise self.wrong("assume_data", "must be true or false")
        return Cell(
            tuple(inputs),
            tuple(self.reaction(key, row) for key, row in self.rows(table, "reaction")),
            variables,
            system,
            self.answers(table),
            tuple(self.vendor(key, row) for key, row in self.rows(table, "vendor")),
            seed,
            self.joints(table),
            self.path,
            read_mechanisms(table.get("mechanism", []), self.path, self.lines),
            self.external(table),
            tuple(self.analog(table.get("analog", {}))),
            dict(self.routine(key, row) for key, row in self.rows(table, "routine")),
            assume,
            LayoutReader(self.path, self.lines).layout(table) or NO_BODIES,  # such cells are equal
        )

    def system(self, name: str, value: Value) -> None:
        """The value that a system variable has at the start."""
        row = ir.SYSTEM_VARIABLES.get(name.partition("[")[0])
        if row is None or row.access != "rw":
            raise self.wrong(f"system.{name}", "is no system variable that can be set")
        moves = row.type == "n" and _RATE.search(row.name) is not None
        for one in value if isinstance(value, list) else [value]:
            if moves and isinstance(one, int | float) and not SMALLEST <= one <= LARGEST:
                raise self.wrong(f"system.{name}", f"must be from {SMALLEST:f} to {LARGEST:,.0f}, not {one:g}")

    def external(self, table: dict[str, Value]) -> tuple[float | None, ...] | None:
        given = table.get("external")
        if given is None:
            return None
        numbers = isinstance(given, list) and all(_is_place(one) for one in given)
        if not numbers or not 1 <= len(given) <= _MOST_EXTERNAL:
            raise self.wrong(
                "external", f"must be a list of 1 to {_MOST_EXTERNAL} values of external axes within {FARTHEST:,.0f}"
            )
        return (*(float(one) for one in given), *(None,) * (_MOST_EXTERNAL - len(given)))

    def analog(self, table: Value) -> Iterator[AnalogSetting]:
        """`[analog.LANGUAGE]`: what the numbers of a signal stand for."""
        if not isinstance(table, dict):
            raise self.wrong("analog", "must be written as [analog.LANGUAGE] tables")
        for language, rows in table.items():
            if language not in registry.dialect_names():
                raise self.wrong(f"analog.{language}", f"no language: there are {', '.join(registry.dialect_names())}")
            if not isinstance(rows, dict):
                raise self.wrong(f"analog.{language}", "must be a table of signals")
            for name, row in rows.items():
                key = f"analog.{language}.{name}"
                if not isinstance(row, dict):
                    raise self.wrong(key, "must be { numbers = [a, b], volts = [c, d] }")
                self.known(key, row, ("numbers",), ("volts", "milliamperes"))
                units = [unit for unit in ("volts", "milliamperes") if unit in row]
                if len(units) != 1:
                    raise self.wrong(key, "needs one of volts and milliamperes")
                unit = VOLTS if units == ["volts"] else MILLIAMPERES
                numbers, levels = self.two(key, row, "numbers"), self.two(key, row, units[0])
                yield AnalogSetting(language, name, AnalogRange(numbers, levels, unit))

    def two(self, key: str, row: dict[str, Value], name: str) -> tuple[float, float]:
        """Two different numbers."""
        given = row[name]
        plain = isinstance(given, list) and all(
            isinstance(one, int | float) and not isinstance(one, bool) for one in given
        )
        if not plain or len(given) != 2 or given[0] == given[1]:
            raise self.wrong(f"{key}.{name}", f"must be two different numbers, not {given!r}")
        return float(given[0]), float(given[1])

    def joints(self, table: dict[str, Value]) -> tuple[float, ...] | None:
        given = table.get("joints")
        if given is None:
            return None
        if not isinstance(given, list) or not all(_is_place(each) for each in given):
            raise self.wrong("joints", f"must be a list of joint values, none beyond {FARTHEST:,.0f}")
        return tuple(float(each) for each in given)

    def pattern(self, key: str, row: dict[str, Value], name: str) -> re.Pattern[str]:
        try:
            return re.compile(self.text(key, row, name), re.IGNORECASE)
        except re.error as error:
            raise self.wrong(f"{key}.{name}", f"is no regular expression: {error}") from None

    def input(self, key: str, row: dict[str, Value]) -> Iterator[Input]:
        self.known(key, row, ("time", "signal", "value"), ("duration",))
        time, signal = self.seconds(key, row, "time"), self.text(key, row, "signal")
        value = self.signal(key, row, "value")
        yield Input(time, signal, value)
        if "duration" in row:
            back: Value = not value if isinstance(value, bool) else 0
            yield Input(time + self.seconds(key, row, "duration"), signal, back)

    def reaction(self, key: str, row: dict[str, Value]) -> Reaction:
        self.known(key, row, ("when", "signal", "value"), ("becomes", "after", "except"))
        becomes = self.signal(key, row, "becomes") if "becomes" in row else True
        return Reaction(
            self.text(key, row, "when"),
            becomes,
            self.seconds(key, row, "after"),
            self.text(key, row, "signal"),
            self.signal(key, row, "value"),
            self.times(key, row, "except"),
        )

    def answers(self, table: dict[str, Value]) -> tuple[Answer, ...]:
        plain = table.get("answers", [])
        if not isinstance(plain, list) or not all(isinstance(each, int | float | str) for each in plain):
            raise self.wrong("answers", "must be a list of numbers or texts")
        made = []
        for key, row in self.rows(table, "answer"):
            self.known(key, row, ("answer",), ("text", "after"))
            text = self.pattern(key, row, "text") if "text" in row else None
            made.append(Answer(row["answer"], self.seconds(key, row, "after"), text))
        return (*(Answer(each) for each in plain), *made)

    def vendor(self, key: str, row: dict[str, Value]) -> VendorMeaning:
        self.known(key, row, ("match",), ("effect", "seconds", "message", "value", "set"))
        effect = row.get("effect", "none")
        if effect not in ("none", "message", "time"):
            raise self.wrong(f"{key}.effect", f"must be none, message or time, not {effect!r}")
        return VendorMeaning(
            self.pattern(key, row, "match"),
            effect,
            self.seconds(key, row, "seconds"),
            self.text(key, row, "message"),
            row.get("value"),
            self.switched(key, row),
        )

    def routine(self, key: str, row: dict[str, Value]) -> tuple[str, RoutineMeaning]:
        """The folded name of a routine, and what its calls stand for."""
        self.known(key, row, ("name",), ("seconds", "message", "value", "set"))
        name = self.text(key, row, "name")
        seconds, message = self.seconds(key, row, "seconds"), self.text(key, row, "message")
        return name.lower(), RoutineMeaning(seconds, message, row.get("value"), self.switched(key, row))

    def switched(self, key: str, row: dict[str, Value]) -> tuple[tuple[str, Value], ...]:
        """The signals that a row switches, with their values."""
        pairs = row.get("set", [])
        if not isinstance(pairs, list) or not all(isinstance(p, list) and len(p) == 2 for p in pairs):
            raise self.wrong(f"{key}.set", "must be a list of [signal, value] pairs")
        return tuple((str(signal), value) for signal, value in pairs)
