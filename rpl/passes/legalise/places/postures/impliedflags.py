"""Flags of one notation that those of another imply, wherever the place lies.

The place of a target is not known before the run where the program computes the tool or the frame of its moves. What
the flags say of the arm's shoulder, elbow and wrist holds all the same: a flag of the target's notation that is equal
at many joint values with the given flags is kept, one that also hangs on the place (turns, quadrants) is left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.emulator.model import RobotModel

_TRIED = 3000  # joint values, spread evenly by chance over the ranges of the axes
_FEWEST = 12  # of them that have the given flags; with less nothing is said
_SHARE = 0.9  # of each range: flags change at its ends

Known = dict[tuple[str, str, str, tuple[tuple[str, int], ...]], dict[str, int]]


def implied_flags(
    arm: RobotModel, notation: Notation, flags: Mapping[str, int], wanted: Notation, known: Known
) -> dict[str, int]:
    """The flags of `wanted` at all joints where `notation` shows `flags`. `known`: what was asked before."""
    key = (arm.name, notation.name, wanted.name, tuple(sorted(flags.items())))
    if key not in known:
        known[key] = _found(arm, notation, flags, wanted)
    return known[key]


def _found(arm: RobotModel, notation: Notation, flags: Mapping[str, int], wanted: Notation) -> dict[str, int]:
    import numpy as np  # most translations ask nothing of the arm

    low, high = arm.limits[:, 0], arm.limits[:, 1]
    spread = np.random.default_rng(1).uniform(-_SHARE, _SHARE, size=(_TRIED, len(low)))
    common: dict[str, int] | None = None
    seen = 0
    for joints in (low + high) / 2 + spread * (high - low) / 2:
        shown = notation.encode(arm, joints)
        if any(shown.get(name) != value for name, value in flags.items()):
            continue
        seen += 1
        found = wanted.encode(arm, joints)
        common = found if common is None else {name: one for name, one in common.items() if found.get(name) == one}
        if not common:
            return {}
    return common or {} if seen >= _FEWEST else {}


__all__ = ["Known", "implied_flags"]
