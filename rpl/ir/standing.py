"""What stands on the robot that will run a translation, as its backup says: names, numbers, signals, tools and frames.

A translation gives nothing of it to something else, and takes what is the same. The target's own dialect makes the
record (`Dialect.standing`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Pose = tuple[float, float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Standing:
    """names: of programs and of global data, folded -> the file. numbers: (bank, number) -> what its comment calls it
    ("" where it is used without one). computed: banks whose numbers are chosen at run time. signals: (kind, number) ->
    name or "". poses: (bank of tools or frames, number) -> x, y, z mm and a, b, c degrees (turned about Z, Y, X)."""

    names: Mapping[str, str] = field(default_factory=dict)
    numbers: Mapping[tuple[str, int], str] = field(default_factory=dict)
    computed: frozenset[str] = frozenset()
    signals: Mapping[tuple[str, int], str] = field(default_factory=dict)
    poses: Mapping[tuple[str, int], Pose] = field(default_factory=dict)

    def of(self, bank: str) -> set[int]:
        """The numbers of a bank that are in use there."""
        return {number for name, number in self.numbers if name == bank}

    def like(self, bank: str, value: tuple[float, ...]) -> int | None:
        """The number that has this pose there, within a hundredth of a millimetre or a degree."""
        return next((number for (name, number), one in self.poses.items() if name == bank and near(one, value)), None)


NOTHING = Standing()
_NEAR = 0.01


def near(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Are two poses the same, component by component (mm, degrees; whole turns do not count)?"""
    differences = [a - b for a, b in zip(one, other, strict=True)]
    angles = [(one + 180.0) % 360.0 - 180.0 for one in differences[3:]]
    return all(abs(one) <= _NEAR for one in (*differences[:3], *angles))
