"""A numbered line of a listing."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Line:
    """The text behind the number (`  R[1]=5`, `J P[1] 100% FINE`), and the lines that continue it."""

    first: str
    further: tuple[str, ...] = ()

    @property
    def length(self) -> int:
        return max(len(one) for one in (self.first, *self.further))
