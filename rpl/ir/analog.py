"""What the numbers of analogue signals stand for: a voltage or a current.

Languages count analogue signals in different units: a share of the module's range, volts, counts of a converter, or
what the I/O configuration makes of it. A range says which level two numbers stand for; between them it is linear.
"""

from __future__ import annotations

from dataclasses import dataclass

VOLTS, MILLIAMPERES = "V", "mA"
EVERY = 1 << 30  # the last number of a kind of signals


@dataclass(frozen=True, slots=True)
class AnalogRange:
    """`numbers[0]` and `numbers[1]` of a program stand for `levels[0]` and `levels[1]` in `unit` (V or mA). `usual`:
    the controller's modules can be other ones, these are what they are as a rule."""

    numbers: tuple[float, float]
    levels: tuple[float, float]
    unit: str = VOLTS
    usual: bool = False

    def level(self, number: float) -> float:
        """The level in `unit` that a number stands for."""
        share = (number - self.numbers[0]) / (self.numbers[1] - self.numbers[0])
        return self.levels[0] + share * (self.levels[1] - self.levels[0])

    def number(self, level: float) -> float:
        """The number that stands for a level in `unit`."""
        share = (level - self.levels[0]) / (self.levels[1] - self.levels[0])
        return self.numbers[0] + share * (self.numbers[1] - self.numbers[0])

    @property
    def text(self) -> str:
        """The range in words."""
        (a, b), (low, high) = self.numbers, self.levels
        return f"{a:g} to {b:g} for {low:g} to {high:g} {self.unit}"


@dataclass(frozen=True, slots=True)
class AnalogPorts:
    """The range of a language's signals `first` to `last` of a kind (`analog_in`, `analog_out`); None: it changes.
    `name`: of the one signal that a program calls so instead."""

    kind: str
    range: AnalogRange | None
    first: int = 0
    last: int = EVERY
    name: str = ""


@dataclass(frozen=True, slots=True)
class AnalogSetting:
    """What a cell file says of one signal of a language, by the name that the program or the language gives it."""

    language: str
    name: str
    range: AnalogRange


__all__ = ["EVERY", "MILLIAMPERES", "VOLTS", "AnalogPorts", "AnalogRange", "AnalogSetting"]
