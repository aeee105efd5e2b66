"""Which range an analogue signal of a program has: said by the cell file, by the program itself, or fixed by its
language; None where the I/O configuration of the controller alone knows it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rpl import ir, registry
from rpl.ir.analog import EVERY, AnalogPorts, AnalogRange, AnalogSetting
from rpl.passes.scope import rules_of

_SHORT = {"analog_in": "ai", "analog_out": "ao"}


@dataclass(frozen=True, slots=True)
class AnalogRanges:
    """The ranges of one language. `settings`: what a cell file says; `said`: what the program says of its signals."""

    language: str
    settings: Sequence[AnalogSetting] = ()
    said: Sequence[AnalogPorts] = ()

    def of(self, kind: str, number: int | None, names: Iterable[str] = ()) -> AnalogRange | None:
        """The range of a signal by its number, where it has one, or its names. None: it is not known. Without a number
        or a name (it is computed) only what holds for every signal of the kind counts."""
        known = {name.strip().lower() for name in names}
        if number is not None:
            spelled = registry.dialect(self.language).signal_name(kind, number)
            known |= {spelled.lower(), f"{_SHORT[kind]}{number}", f"{_SHORT[kind]}[{number}]"}
        own = [one for one in self.settings if one.language == self.language]
        for one in own:
            if one.name.strip().lower() in known:
                return one.range
        if not known and own:
            return None
        for ports in (*self.said, *rules_of(self.language).analog):
            if ports.name and ports.kind == kind and ports.name.lower() in known:
                return ports.range
            if ports.kind != kind or ports.name:
                continue
            if number is None and ports.first <= 1 and ports.last == EVERY:
                return ports.range
            if number is not None and ports.first <= number <= ports.last:
                return ports.range
        return None


def analog_ranges(program: ir.Program, language: str, settings: Sequence[AnalogSetting] = ()) -> AnalogRanges:
    """The ranges of the program's language."""
    return AnalogRanges(language, settings, registry.dialect(language).analog_said(program))


__all__ = ["AnalogRanges", "analog_ranges"]
