"""The way of a linear or circular move between constant places, and pieces of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rpl import ir

from .places import Values, between

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

Flags = tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Way:
    """The way of a linear move, or of a circular one about `centre` from the direction `first` towards `second`
    (its radius long), in the move's frame. `flags`: the posture of its end; `length` in mm."""

    start: Values
    end: Values
    flags: Flags
    length: float
    centre: FloatArray | None = None
    first: FloatArray | None = None
    second: FloatArray | None = None

    def at(self, along: float) -> ir.Aggregate:
        """The place so many millimetres behind the start."""
        values = between(self.start, self.end, along / self.length)
        if self.centre is not None and self.first is not None and self.second is not None:
            angle = along / float(np.linalg.norm(self.first))
            place = self.centre + np.cos(angle) * self.first + np.sin(angle) * self.second
            values = (*(float(round(float(one), 9)) + 0.0 for one in place), *values[3:])
        entries: list[tuple[str | None, ir.Expression]] = [
            (name, ir.RealLiteral(value)) for name, value in zip(ir.POSE, values, strict=True)
        ]
        entries.extend((name, ir.IntLiteral(value)) for name, value in self.flags)
        return ir.Aggregate(tuple(entries))

    def piece(self, move: ir.Move, begin: float, end: float) -> ir.Move:
        """The move from one place on the way to another."""
        target = move.target if end == self.length else self.at(end)
        via = None if move.via is None else self.at((begin + end) / 2)
        return replace(move, target=target, via=via, triggers=())


def line(start: Values, end: Values, flags: Flags) -> Way:
    """The straight way."""
    return Way(start, end, flags, float(np.linalg.norm(np.subtract(end[:3], start[:3]))))


def arc(start: Values, through: Values, end: Values, flags: Flags) -> Way | None:
    """The circle through three places; None where they are on a line."""
    via = np.asarray(through[:3])
    one, other = via - np.asarray(start[:3]), np.asarray(end[:3]) - np.asarray(start[:3])
    normal = np.cross(one, other)
    size = float(normal @ normal)
    if size < 1e-9:
        return None
    out = (np.cross(normal, one) * float(other @ other) + np.cross(other, normal) * float(one @ one)) / (2 * size)
    first = -out
    second = np.cross(normal / np.sqrt(size), first)
    last = other - out
    angle = float(np.arctan2(last @ second, last @ first)) % (2 * np.pi)
    length = angle * float(np.linalg.norm(first))
    return Way(start, end, flags, length, np.asarray(start[:3]) + out, first, second)


__all__ = ["Way", "arc", "line"]
