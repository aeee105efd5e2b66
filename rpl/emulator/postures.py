"""The facts that arm configuration flags are made of, as inequalities over the joints.

A translated program works the flags of its source language out from the joints, because its own controller writes other
ones. Only arms with axes 2 and 3 parallel and a spherical wrist have such facts here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.arms import OpwArm

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True)
class Sine:
    """`amplitude` (mm, or 1) times the sine of factors . joints + offset (degrees). `narrow`: the angle stays inside of
    a half turn on either side by the joints' limits, so that its sign is that of the sine."""

    amplitude: float
    factors: tuple[float, ...]
    offset: float
    narrow: bool


@dataclass(frozen=True, slots=True)
class Fact:
    """True where constant + the sum of the sines is below zero."""

    constant: float
    sines: tuple[Sine, ...]


def posture_facts(model: RobotModel) -> dict[str, Fact]:
    """The facts of rpl.emulator.model.Posture (`elbow_above_stretched` is the opposite of `behind_lower_arm`); empty
    for an arm of another build."""
    arm = model.arm
    if not isinstance(arm, OpwArm):
        return {}
    elbow = float(np.degrees(arm.elbow_angle))
    forearm = float(np.hypot(arm.a2, arm.c3))
    reach = (_sine(model, arm.c2, (1,), 0.0), _sine(model, forearm, (1, 2), elbow))
    return {
        "behind_axis1": Fact(arm.a1, reach),
        "behind_lower_arm": Fact(0.0, (_sine(model, 1.0, (2,), elbow),)),
        "wrist_negative": Fact(0.0, (_sine(model, 1.0, (4,), 0.0),)),
    }


def _sine(model: RobotModel, amplitude: float, thetas: tuple[int, ...], offset: float) -> Sine:
    """The sine of a sum of the arm's own angles, over the joints as the pendant shows them."""
    rows = model.pendant_to_arm[list(thetas)].sum(axis=0)
    start = offset - float(model.offsets[list(thetas)].sum())
    ends = np.stack([rows * model.limits[:, 0], rows * model.limits[:, 1]])
    low, high = float(ends.min(axis=0).sum()) + start, float(ends.max(axis=0).sum()) + start
    return Sine(float(amplitude), tuple(float(row) for row in rows), start, low > -180.0 and high < 180.0)
