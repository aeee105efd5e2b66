"""What happens to the bodies of a cell, as a run of it keeps it: where every part was when, and what grippers did."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rpl.emulator.rotations import FloatArray

# rests: stands where it is. held: goes with the flange that holds it. falls: on its way to its next entry, straight
# from this place to that one. lost: nothing of the cell is below it. gone: taken away.
State = Literal["rests", "held", "falls", "lost", "gone"]


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A part from a moment on. `pose` (4, 4): in the cell, or where a gripper holds it, in the flange of the gripper's
    robot. `on`: the fixture or part that it rests on, or the gripper that holds it."""

    t: float
    part: str
    state: State
    pose: FloatArray
    on: str = ""


@dataclass(frozen=True, slots=True)
class Grasp:
    """A gripper has closed, or lost on the way (`lost`) what it held. `part`: what it was about, "" where nothing was
    there; `why`: it holds nothing, or what is to be said of it."""

    t: float
    gripper: str
    part: str
    ok: bool
    why: str = ""
    lost: bool = False


@dataclass(frozen=True, slots=True)
class Knock:
    """What a gripper holds is knocked out of it at a time (s), by something of this name."""

    t: float
    gripper: str
    by: str


@dataclass(frozen=True, slots=True)
class Opening:
    """A gripper has opened. `open`: FALSE where it closes; `width_mm`: of its jaws then."""

    t: float
    gripper: str
    open: bool
    width_mm: float


def pose_between(places: Sequence[Placed], t: float) -> tuple[FloatArray, str]:
    """Where a part is at a time: its pose (4, 4) and "" in the cell, or the gripper in whose robot's flange it is.

    `places` are those of one part by time, the first at or before `t`. A falling part goes straight, and turns at once
    at the end of its way.
    """
    number = max((i for i, one in enumerate(places) if one.t <= t), default=0)
    here = places[number]
    if here.state == "held":
        return here.pose, here.on
    if here.state != "falls" or number + 1 == len(places) or places[number + 1].t <= here.t:
        return here.pose, ""
    after = places[number + 1]
    pose = here.pose.copy()
    pose[:3, 3] += (after.pose[:3, 3] - here.pose[:3, 3]) * ((t - here.t) / (after.t - here.t))
    return np.asarray(pose), ""
