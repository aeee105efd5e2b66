"""Targets that are handed over one by one (URScript servoj): each drives the robot for its time, then the next one.

Such a move blocks the program for its time, no longer and no shorter, whether the robot has then come to the target,
is still on its way (the axes are not fast enough) or stood there from the beginning (Universal Robots' script manual
for software 5.20, servoj: "the function is blocking for time t"). The next one takes over at the speed there is in its
direction; any other move begins when the robot has come to the last target. M: between two targets the way is straight
for the axes, as fast as they may; what look-ahead and gain of the controller make of it is not followed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.runtime.moves import pieces, velocities
from rpl.runtime.moves.chain import is_joints
from rpl.runtime.moves.orders import Drive, Order
from rpl.runtime.moves.pieces import Piece

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.ports import Robot

NO_WAY_DEG = 1e-9  # a way that is shorter is none


def go(queue: Robot, order: Order, next: int) -> int:
    """Drive towards the order's target from now on; how the program goes on."""
    task, before = queue.task, queue.piece
    if task.busy and not _may_take_over(queue):
        velocities.let_rest(queue)
        return task.wait_for("idle", order.at, order.at)
    if before is not None and is_joints(order.target) and order.target == before.drive.order.target:
        return velocities.after(queue, order, order.speed.duration or 0.0, next)  # it is on its way
    joints = queue.joints_array()
    queue.planned_joints = joints
    queue.numbers += 1
    drive = queue.plan_order(order, queue.numbers)
    if not isinstance(drive, Drive):
        return queue.refuse(drive, order, next)
    assert drive.plan is not None  # with a model there is one
    plan, now = _taken_over(drive.plan, joints, before, queue.machine.now), queue.machine.now
    velocities.leave(queue, joints)
    queue.planned_joints = plan.end_joints
    drive.started_s, drive.released = now, True
    queue.queue.append(drive)
    task.busy = True
    queue.drive(Piece(drive, plan, now))
    return velocities.after(queue, order, order.speed.duration or 0.0, next)


def _may_take_over(queue: Robot) -> bool:
    """Is the robot on its way to such a target, with nothing commanded behind it?"""
    piece = queue.piece
    return piece is not None and piece.drive.order.servo and piece.halting is None and len(queue.queue) == 1


def _taken_over(plan: PlannedMove, joints: FloatArray, before: Piece | None, now: float) -> PlannedMove:
    """The move from rest to its target, begun with the part of the present speed that goes its way."""
    import numpy as np

    if before is None:
        return plan
    ends = before.plan.geometry.joints(np.array([0.0, 1.0]))
    _, share = pieces.place_of(before, now)
    way = plan.end_joints - joints
    length = float(way @ way)
    along = share * float((ends[1] - ends[0]) @ way) / length if length > NO_WAY_DEG**2 else 0.0
    return plan if along <= 0.0 else plan.part((0.0, 1.0), plan.profile.law(0.0, 1.0, min(along, 1e6), 0.0))


__all__ = ["go"]
