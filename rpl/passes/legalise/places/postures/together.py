"""The joints at the written targets of a program, found for all of them at once.

One pose alone costs a hundred times what it costs among thousands. Only what is surely found so for one alone is taken
from here; the others are asked for one by one, as are those that have no answer, with the reason.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rpl.ir.columns import stretch_of
from rpl.passes.legalise.places.postures.rowpostures import nearest_by_name
from rpl.passes.rigid import Pose

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation

# Fewer are as quick one by one.
_FEWEST = 8
_AT_ONCE = 4096  # all solutions of each are in memory


@dataclass(frozen=True, slots=True)
class Asked:
    """A flange pose with the flags of a notation. joint: they have to be met, else the posture nearest to the home
    position is one, too; had: there are some, else the home position chooses."""

    notation: str
    flange: tuple[float, ...]
    flags: tuple[tuple[str, int], ...]
    joint: bool
    had: bool


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """The joints (n,) that the flags choose, and those of the other arm; None where these are to be asked for alone."""

    joints: Any
    there: Any = None


def asked_for(notation: Notation, flange: Pose, flags: dict[str, int], joint: bool, had: bool) -> Asked:
    numbers = tuple(one for row in flange.matrix for one in row)
    return Asked(notation.name, numbers, tuple(sorted(flags.items())), joint, had)


def found_together(wanted: Iterable[tuple[Notation, Asked]], arm: Any, other: Any) -> dict[Asked, Found]:
    """What is found for these; other: another arm that goes to the same places, or None."""
    groups: dict[tuple[str, bool], tuple[Any, dict[Asked, None]]] = {}
    for notation, asked in wanted:
        if notation.fields and hasattr(notation, "select_all") and stretch_of(asked.flange) is None:
            groups.setdefault((asked.notation, asked.had), (notation, {}))[1][asked] = None
    done: dict[Asked, Found] = {}
    for (_, had), (notation, some) in groups.items():
        whole = list(some)
        for first in range(0, len(whole) if len(whole) >= _FEWEST else 0, _AT_ONCE):
            done |= _found(notation, whole[first : first + _AT_ONCE], had, arm, other)
    return done


def _found(rules: Any, wanted: list[Asked], had: bool, arm: Any, other: Any) -> dict[Asked, Found]:
    import numpy as np

    flanges = np.array([one.flange for one in wanted], dtype=np.float64).reshape(-1, 4, 4)
    flags = np.full((len(wanted), len(rules.fields)), np.nan)
    for row, one in enumerate(wanted):
        for name, value in one.flags:
            flags[row, rules.fields.index(name)] = value
    joints = rules.select_all(arm, flanges, flags, None if had else arm.home).joints
    left = np.flatnonzero(np.isnan(joints[:, 0]) & ~np.array([one.joint for one in wanted]))
    if len(left):
        solutions = arm.inverse_batch(flanges[left], arm.home).joints
        joints[left] = arm.nearest_of(solutions, np.broadcast_to(arm.home, (len(left), arm.axes)))
    known = np.flatnonzero(~np.isnan(joints[:, 0])).tolist()
    if other is None:
        return {wanted[row]: Found(joints[row]) for row in known}
    there, sure = nearest_by_name(arm, other, flanges, joints)
    return {wanted[row]: Found(joints[row], there[row] if sure[row] else None) for row in known}


__all__ = ["Asked", "Found", "asked_for", "found_together"]
