"""Motion at a given speed (URScript speedl, speedj): the robot speeds up to it and goes on until told otherwise.

Such a move has no end. It is driven in stretches of its straight way (or of its axes' way), each planned when the one
before it ends; the next order of this kind takes over at the speed there is, any other move and the end of the task
brake first. The program goes on after the time it gives, or when the speed is reached.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rpl.passes import rigid
from rpl.runtime.moves import pieces
from rpl.runtime.moves.chain import Planning, request_of
from rpl.runtime.moves.orders import Drive, Order, Rate
from rpl.runtime.moves.pieces import Piece
from rpl.runtime.waits import Wait

if TYPE_CHECKING:
    from rpl.emulator.planner import MotionFault, MoveRequest, PlannedMove
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.ports import Robot

STRETCHES_S = (0.5, 0.1, 0.02)  # planned at once; a shorter stretch where the arm reaches no further
STANDS = 1e-9
# What does not govern a motion is not to slow it down.
FREE = 1e6


def is_endless(queue: Robot) -> bool:
    """Is the robot driven by such a move, and not braking?"""
    return queue.piece is not None and queue.piece.drive.rate is not None and not queue.piece.halting


def let_rest(queue: Robot) -> None:
    """Brake a move that has no end."""
    if is_endless(queue):
        queue.halt(False, ends_move=True)


def go(queue: Robot, order: Order, next: int) -> int:
    """Drive at the order's speed from now on; how the program goes on."""
    task, now = queue.task, queue.machine.now
    if queue.model is None:
        return after(queue, order, order.speed.duration or 0.0, next)
    if task.busy and not is_endless(queue):
        return task.wait_for("idle", order.at, order.at)
    joints = queue.joints_array()
    rate, request, tool = _wanted(queue, order, joints)
    if rate.size < STANDS:
        let_rest(queue)
        return after(queue, order, order.speed.duration or 0.0, next)
    speed, before = _speed_along(queue, rate), queue.piece
    if before is None or not _same(before.drive.rate, rate):
        made = _stretch(queue, joints, rate, request, speed)
        if not isinstance(made, tuple):
            return queue.refuse(made, order, next)
        leave(queue, joints)
        plan, rate = made
        queue.numbers += 1
        drive = Drive(queue.numbers, order, plan, tool, None, queue.external)
        drive.rate, drive.started_s, drive.released = rate, now, True
        queue.queue.append(drive)
        task.busy = True
        queue.drive(Piece(drive, plan, now))
    ramp = abs(rate.size - speed) / rate.acceleration
    return after(queue, order, order.speed.duration or ramp, next)


def go_on(queue: Robot, piece: Piece) -> None:
    """The next stretch of a move that has no end."""
    drive = piece.drive
    joints = piece.plan.end_joints
    rate, request, _ = _wanted(queue, drive.order, joints)
    made = _stretch(queue, joints, rate, request, _speed_along(queue, rate))
    if isinstance(made, tuple):
        plan, drive.rate = made
        queue.drive(Piece(drive, plan, queue.machine.now))
        return
    queue.joints = queue.planned_joints = joints
    queue.close_leg(piece, queue.machine.now)
    queue.piece = None
    queue.done(drive, False)
    queue.fault(made, drive.order)


def after(queue: Robot, order: Order, seconds: float, next: int) -> int:
    """The program goes on after a time, in which nothing else is waited for; with a robot no earlier than in the next
    cycle of its controller. M: programs run there that repeat such a motion in a loop that does nothing else."""
    if queue.model is not None:
        seconds = max(seconds, order.rules.wait_poll_s)
    if seconds <= 0.0:
        return next
    now = queue.machine.now
    return queue.task.block(Wait("time", order.at, next, queue.machine.token(), now, now + seconds))


def leave(queue: Robot, joints: FloatArray) -> None:
    """Another speed or target takes over: the move before is over where the robot is."""
    before = queue.piece
    queue.joints = queue.planned_joints = joints
    if before is not None:
        queue.close_leg(before, queue.machine.now)
        queue.queue.remove(before.drive)
        queue.piece = None
        queue.show(before.drive, False, True)


def _wanted(queue: Robot, order: Order, joints: FloatArray) -> tuple[Rate, MoveRequest, rigid.Pose]:
    """The order's speeds from where the arm is, its way in a second as a request, and the point that moves."""
    import numpy as np

    from rpl.emulator.rotations import matrix_to_rotation_vector

    assert queue.model is not None  # asked by the caller
    notation = queue.machine.linked.notation(order.rules.name)
    controller, scene = queue.controller_of(order.rules), queue.machine.scene
    plan = Planning(queue.model, joints, queue.external, queue.task.modal, notation, controller, scene)
    request, tool, _, _ = request_of(order, plan)
    given = order.speed
    if request.target_joints is not None:
        vector = np.asarray(request.target_joints) - joints
        size = float(np.abs(vector).max())
        return Rate(True, vector, size, max(given.axis_acceleration or 0.0, 1e-3)), request, tool
    assert request.target_pose is not None  # it is one or the other
    start = queue.model.forward(joints) @ request.tool
    way = request.target_pose[:3, 3] - start[:3, 3]
    turn = matrix_to_rotation_vector(request.target_pose[:3, :3] @ start[:3, :3].T)
    size, acceleration = float(np.linalg.norm(way)), max(given.path_acceleration or 0.0, 1e-3)
    if size < STANDS:  # the tool turns only: the acceleration in m/s2 is taken as one in rad/s2
        size, acceleration = float(np.degrees(np.linalg.norm(turn))), float(np.degrees(acceleration / 1000.0))
    return Rate(False, np.concatenate([way, turn]), size, acceleration), request, tool


def _stretch(
    queue: Robot, joints: FloatArray, rate: Rate, request: MoveRequest, speed: float
) -> tuple[PlannedMove, Rate] | MotionFault:
    """A stretch of the way, begun with a speed, with enough way behind its end to brake there."""
    assert queue.model is not None  # asked by the caller
    braking_s = rate.size / (2.0 * rate.acceleration)
    fault: MotionFault | None = None
    for seconds in STRETCHES_S:
        whole = seconds + braking_s
        made = pieces.plan(queue.model, joints, _request(queue, joints, rate, request, whole))
        if not pieces.is_planned(made):
            assert pieces.is_fault(made)  # it is either
            fault = fault or made
            continue
        begin, end = min(speed / (rate.size * whole), 1e6), seconds / whole
        profile = made.profile
        last = min(profile.speed, (begin * begin + 2.0 * profile.acceleration * end) ** 0.5)
        law = profile.law(0.0, end, begin, last)
        return made.part((0.0, end), law), replace(rate, stretch_s=whole)
    assert fault is not None  # there are stretches
    return fault


def _request(queue: Robot, joints: FloatArray, rate: Rate, second: MoveRequest, seconds: float) -> MoveRequest:
    import numpy as np

    from rpl.emulator.rotations import pose_matrix, rotation_vector_to_matrix

    assert queue.model is not None  # asked by the caller
    if rate.joint:
        share = np.maximum(np.abs(rate.vector), 1e-9)
        return replace(
            second,
            target_joints=joints + rate.vector * seconds,
            joint_speed=share / queue.model.speeds,
            joint_acc=share / rate.size * rate.acceleration / queue.model.accelerations,
            tcp_speed_for_joint_move=None,
            duration_s=None,
        )
    start = queue.model.forward(joints) @ second.tool
    goal = pose_matrix(
        start[:3, 3] + rate.vector[:3] * seconds,
        rotation_vector_to_matrix(rate.vector[3:] * seconds) @ start[:3, :3],
    )
    turns = float(np.linalg.norm(rate.vector[:3])) < STANDS
    return replace(
        second,
        target_pose=goal,
        path_speed_mm_s=FREE if turns else rate.size,
        path_acc_mm_s2=FREE if turns else rate.acceleration,
        ori_speed_deg_s=rate.size if turns else FREE,
        ori_acc_deg_s2=rate.acceleration if turns else FREE,
        duration_s=None,
    )


def _same(one: Rate | None, other: Rate) -> bool:
    """Do both drive alike? Rounding of where the arm is does not count."""
    if one is None or one.joint != other.joint or one.acceleration != other.acceleration:
        return False
    return bool(abs(one.vector - other.vector).max() < 1e-6 * max(one.size, 1.0))


def _speed_along(queue: Robot, rate: Rate) -> float:
    """The leading speed that the robot has already in the direction of the new one."""
    piece = queue.piece
    if piece is None or piece.drive.rate is None or piece.drive.rate.joint != rate.joint:
        return 0.0
    old = piece.drive.rate
    _, share = pieces.place_of(piece, queue.machine.now)
    now = old.vector * (share * old.stretch_s)
    count = 3 if not rate.joint and float(abs(rate.vector[:3]).max()) > STANDS else len(rate.vector)
    length = float((rate.vector[:count] ** 2).sum()) ** 0.5
    along = float(now[:count] @ rate.vector[:count]) / (length * length) if length > 0.0 else 0.0
    return max(along, 0.0) * rate.size


__all__ = ["after", "go", "go_on", "is_endless", "leave", "let_rest"]
