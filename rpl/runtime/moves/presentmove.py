"""The move that is driven now, as programs ask about it: where it begins and ends, and where a path was left.

A program pointer that runs ahead may have commanded further moves: they do not count here. In a corner the present move
is the one before it up to the corner's middle, or the one behind it where a program goes on as soon as that is begun.
Of a spline block it is the segment that is driven.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.moves.orders import Drive
    from rpl.runtime.moves.scene import External
    from rpl.runtime.ports import Robot

Place = tuple["FloatArray", "External"]


def ends(queue: Robot) -> tuple[Place, Place] | None:
    """Joints (n,) and external axes at the programmed start and end of the present move, also while it is stopped.
    None where no move is begun."""
    piece = queue.piece or queue.halted
    if piece is None:
        return None
    drive = piece.drive
    begun = drive.order.rules.advance.runs_ahead_of == "begun"
    if piece.corner is not None and (begun or drive not in queue.queue):
        drive = piece.corner.following
    assert drive.plan is not None  # with a piece there is a plan
    bounds = (0.0, *drive.marks, 1.0)
    at = min(drive.passed, len(drive.marks))
    first, last = (_place(queue, drive, drive.plan, share) for share in bounds[at : at + 2])
    return first, last


def _place(queue: Robot, drive: Drive, plan: PlannedMove, share: float) -> Place:
    import numpy as np

    joints = plan.start_joints if share <= 0.0 else plan.end_joints
    if 0.0 < share < 1.0:
        joints = plan.geometry.joints(np.array([share]))[0]
    before = queue.external
    if len(plan.external_end) != len(before):
        return joints, before
    values = plan.external_along(np.array(share))
    named = zip(values, before, drive.external, strict=True)
    return joints, tuple(None if old is None and new is None else float(value) for value, old, new in named)


def left_at(queue: Robot) -> Place | None:
    """Where the robot stopped on a path that it is to go on with; None while it is on one, or has none left.

    KUKA names it the place to which an interrupt's routine has to bring the robot back (message KSS01437). M: while
    the robot is on its path it is where the robot is."""
    return queue.left if queue.stopped or queue.set_aside else None


__all__ = ["ends", "left_at"]
