"""Robots that are driven together: moves of the same identity begin at the same time and end at the same time, that of
the slowest (MultiMove manual 3HAC021272-001, 6.7.4: the movement that takes longest determines the speed of others).
A faster move is planned with the speed that takes as long (M: makers do not say how their ramps look then). Corners
between such moves are not driven: every move ends at rest, and a warning says so.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rpl.runtime import meetings
from rpl.runtime.faults import ProgramError
from rpl.runtime.moves.orders import BlendOrder, Drive, Order

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.runtime.ports import Robot, Task

_ALONE = "has an identity, but the robots do not go together here"


def check(task: Task, order: Order) -> None:
    """Before a move is planned: does it say what a move of robots that go together has to say, and no other one?"""
    group, called = task.together, order.identity
    if not group:
        if called is not None:
            raise ProgramError("synchronisation", f"the move of {task.name} {_ALONE} ({called})")
        return
    if called is None:
        raise ProgramError(
            "synchronisation", f"{task.name} goes together with other robots: its move needs an identity"
        )
    if order.search is not None or order.concurrent or order.velocity or order.servo or order.block:
        raise ProgramError(
            "synchronisation", f"a move of this kind is not driven together with other robots ({called})"
        )
    order.together = group
    for one in meetings.present(task.machine):
        if one.task in group and one.mode == "apart":
            raise _unequal(task, called, task.machine.tasks[one.task])
    if not order.blend.stops:
        order.blend = BlendOrder("stop")
        text = f"move {called} of robots that go together ends at rest: corners between such moves are not driven"
        data = {"code": "corner-together", "text": text}
        task.machine.event("warning", data, task, order.code.origin(order.at))


def _unequal(task: Task, called: str, other: Task) -> ProgramError:
    what = f"{task.name} has a move {called} for which {other.name} has none before they go apart"
    return ProgramError("synchronisation", what)


def check_apart(task: Task) -> None:
    """A task is at the point where the robots go apart: has another one a move that waits for it?"""
    for number in sorted(task.together):
        other = task.machine.tasks[number]
        head = _head(other.robot)
        if head is not None and not head.order.agreed:
            raise _unequal(other, head.order.identity or "", task)


def _head(robot: Robot | None) -> Drive | None:
    """The move that the robot would begin now."""
    if robot is None or robot.piece is not None or robot.stopped or not robot.queue:
        return None
    return robot.queue[0] if robot.queue[0].order.together else None


def may_begin_s(queue: Robot, drive: Drive) -> float:
    """The controller lets some time pass after a move that stopped exactly: from when on this one may begin."""
    return queue.stood_s + (drive.plan.controller.restart_s if drive.plan is not None else 0.0)


def begins(queue: Robot, drive: Drive) -> bool:
    """May the move begin? One of robots that go together waits until all are ready; they begin at the same moment."""
    order = drive.order
    earliest = may_begin_s(queue, drive)
    if earliest > queue.machine.now:
        queue.ask_at(earliest)
        return False
    return not order.together or order.agreed or _agree(queue, drive)


def _agree(queue: Robot, drive: Drive) -> bool:
    """Settle when the moves of all robots begin and how long they last, once all are there."""
    order = drive.order
    machine = queue.machine
    tasks = [machine.tasks[number] for number in sorted(order.together)]
    heads = [(task, head) for task in tasks if task.robot is not None and (head := _head(task.robot)) is not None]
    for task, head in heads:
        if head.order.identity != order.identity:
            mine = f"{queue.task.name} has move {order.identity}"
            told = f"{mine}, {task.name} at the same time move {head.order.identity}"
            machine.fault("synchronisation", told, queue.task, order.code.origin(order.at))
            return False
    if len(heads) < len(tasks):
        wait = queue.task.wait
        if wait is not None:
            missing = ", ".join(task.name for task in tasks if all(task is not other for other, _ in heads))
            wait.subject = f"move {order.identity} together with {missing}"
        return False
    start = max(may_begin_s(task.robot, head) for task, head in heads if task.robot is not None)
    if start > machine.now:
        queue.ask_at(start)
        return False
    longest = max(head.plan.duration_s for _, head in heads if head.plan is not None)
    for task, head in heads:
        assert head.plan is not None and task.robot is not None  # robots of a model have plans
        if head.plan.duration_s < longest:
            head.plan = _slower(task.robot, head, longest)
        head.order.agreed = True
        if head is not drive:
            task.robot.ask_at(machine.now)
    return True


def _slower(queue: Robot, head: Drive, seconds: float) -> PlannedMove:
    """The move planned anew with the speed that takes so long; what is then missing is made up evenly."""
    assert head.plan is not None
    order, ahead = head.order, (queue.planned_joints, queue.planned_external)
    queue.planned_joints, queue.planned_external = queue.joints, queue.external
    order.speed = replace(order.speed, duration=seconds)
    made = queue.plan_order(order, head.number)
    queue.planned_joints, queue.planned_external = ahead
    plan = made.plan if isinstance(made, Drive) else None
    return lasting(head.plan if plan is None else plan, seconds)


def lasting(plan: PlannedMove, seconds: float) -> PlannedMove:
    """The same way in a longer time, evenly slower."""
    if plan.duration_s <= 0.0 or seconds == plan.duration_s:
        return plan if plan.duration_s == seconds else replace(plan, duration_s=seconds)
    share, law = seconds / plan.duration_s, plan.law
    slower = replace(law, times=law.times * share, speeds=law.speeds / share, smoothing_s=law.smoothing_s * share)
    return replace(plan, law=slower, duration_s=seconds)
