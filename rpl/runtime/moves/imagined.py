"""Moves of a run without a robot: each is made in no time, so that a program's logic can be run without an arm.

Joints are known after a move to joints, the pose after a move to a pose; neither gives the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.moves import pieces, velocities
from rpl.runtime.moves.chain import (
    Frames,
    convention_of,
    external_value,
    filled,
    frames_of,
    is_joints,
    joints_of,
    shifted,
)
from rpl.runtime.moves.orders import Order
from rpl.runtime.values import ConfigValue, TargetValue, Value, pose_of

if TYPE_CHECKING:
    from rpl.ir.rules import Rules
    from rpl.runtime.ports import Robot


@dataclass(slots=True, eq=False)
class Imagined:
    """Where an arm would be: `pose` of the tool in the robot's base, or `joints`."""

    pose: rigid.Pose | None = None
    joints: list[float] | None = None

    def make(self, queue: Robot, order: Order, next: int) -> int:
        """Make the move at once, of a block each one; its triggers fire in their order."""
        for one in order.block:
            self.make(queue, one, next)
        task = queue.task
        data: dict[str, Value] = {"motion": order.kind}
        frames = frames_of(order.tool, order.frame, task.modal, order.modal, known=False)
        relative = order.relative
        if order.external_only:
            pass
        elif is_joints(order.target):
            self.joints = joints_of(order.target, self.joints or [0.0] * 6, relative is not None)
            self.pose = None
            data["joints"] = [round(joint, 6) for joint in self.joints]
        else:
            before = self.goal(frames)
            goal = filled(order.target, before) if relative is None else shifted(order.target, before, relative)
            place, moving = frames.target_in_robot(goal)
            self.pose = place.then(moving.inverse) if frames.stationary else place
            data |= pieces.pose_data(place)
        data["duration"] = 0.0
        machine = queue.machine
        machine.moves += 1
        machine.event("move", data, task, order.code.origin(order.at))
        for trigger in order.triggers:
            queue.fire(trigger)
        self._search(order)
        if order.servo:
            return velocities.after(queue, order, order.speed.duration or 0.0, next)
        return task.attention(next) if task.triggers else next

    def _search(self, order: Order) -> None:
        search = order.search
        if search is None:
            return
        found = bool(search.condition(search.values))
        if search.hit is not None:
            search.hit(search.values, found)
        elif not found:
            raise ProgramError("search_missed", "the search has found nothing")
        if found and search.write is not None:
            search.write(search.values, order.target)

    def goal(self, frames: Frames) -> rigid.Pose:
        """The pose in the frames of a move; the origin when no pose is known."""
        if self.pose is None:
            return rigid.IDENTITY
        return frames.goal_of(self.pose) if frames.stationary else frames.base.inverse.then(self.pose)

    def target(self, frames: Frames, external: tuple[float | None, ...], rules: Rules) -> TargetValue:
        """The pose as the language shows it."""
        if self.pose is None:
            raise ProgramError("motion", "the position is asked for, but the run has no robot")
        pose = pose_of(self.goal(frames), convention_of(rules))
        return TargetValue(pose, ConfigValue(rules.name, ()), external_value(external, rules))
