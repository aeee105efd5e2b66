"""A numbered line of a listing, and the lengths of pulses in it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text

from . import tables

PULSE_ROUNDED = code("tp-pulse-rounded", Severity.WARNING, "a pulse of {time:g} s is written as one of {written:g} s")
_SAME_S = 1e-6


@dataclass(frozen=True, slots=True)
class Line:
    """The text behind the number (`  R[1]=5`, `J P[1] 100% FINE`), and the lines that continue it. `words`: those of
    the macro of a move."""

    first: str
    further: tuple[str, ...] = ()
    words: Mapping[str, str] | None = field(default=None, compare=False)

    @property
    def length(self) -> int:
        return max(len(one) for one in (self.first, *self.further))


def pulse_length(seconds: float, origin: Origin, diagnostics: Diagnostics) -> str:
    """The length of a pulse in seconds, in tenths; raises CannotSayError beyond what can be written.

    Measured on a controller: above 25.5 s it is refused, 0.25 s becomes 0.3 s, below 0.05 s the controller's own."""
    tenths = math.floor(seconds * 10.0 + 0.5)
    if not 1 <= tenths <= 255:
        raise CannotSayError("a pulse lasts from 0.1 to 25.5 seconds")
    if abs(tenths / 10.0 - seconds) > _SAME_S:
        diagnostics.report(PULSE_ROUNDED, origin, time=seconds, written=tenths / 10.0)
    return number_text(tenths / 10.0, style=tables.NUMBERS)
