"""What a run has taken for granted about external axes and carried frames, found in its moves afterwards.

Nobody sees it in the motion itself: an axis without data goes at a speed of the emulator's own, and a corner between
two frames that move differently is rounded in joint space, where the controller's curve is not known.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.runtime.moves.scene import EXTERNAL_SPEED, Scene

if TYPE_CHECKING:
    from rpl.emulator.mechanismfile import Mechanism
    from rpl.runtime.trace import Event, RunResult

AXIS_ASSUMED = code(
    "external-axis-assumed",
    Severity.WARNING,
    "nobody has said how fast external axis {number} is; it goes at most at {speed:g} mm/s or degrees/s",
    "`speed` of the axis of its [[mechanism]] says it",
)
JOINT_CORNER = code(
    "corner-in-joints",
    Severity.WARNING,
    "the frame of the next move moves otherwise than that of this one; their corner is rounded by the joints, not on a "
    "curve in one of the frames",
)
_PATHS = ("linear", "circular")
_MOVED = 1e-9


def report_remarks(result: RunResult, mechanisms: tuple[Mechanism, ...], diagnostics: Diagnostics) -> None:
    """Each axis once, each corner once."""
    scene, told = Scene(mechanisms), set[int]()
    moves = [event for event in result.trace if event.kind == "move"]
    for event in moves:
        for number in sorted(_moved(event) - told):
            told.add(number)
            axis = scene.axis(number)
            if axis is None or axis.speed is None:
                diagnostics.report(AXIS_ASSUMED, event.origin, number=number, speed=EXTERNAL_SPEED)
    corners = set[tuple[int, int]]()
    for event, following in pairwise(moves):
        place = (id(event.origin.source), event.origin.start)
        if place not in corners and _rounded_by_joints(event, following):
            corners.add(place)
            diagnostics.report(JOINT_CORNER, event.origin)


def _moved(event: Event) -> set[int]:
    """Numbers of the external axes that move on its way."""
    found: set[int] = set()
    for leg in event.legs:
        start, end = leg.plan.external_start, leg.plan.external_end
        if len(start) == len(end):
            found |= {int(place) + 1 for place in np.flatnonzero(np.abs(end - start) > _MOVED)}
    return found


def _rounded_by_joints(event: Event, following: Event) -> bool:
    """Is there a corner between two paths that is no curve of the tool?"""
    from rpl.emulator.blending import JointCorner

    if event.data["motion"] not in _PATHS or following.data["motion"] not in _PATHS:
        return False
    return any(leg.plan.kind == "corner" and isinstance(leg.plan.geometry, JointCorner) for leg in event.legs)


__all__ = ["report_remarks"]
