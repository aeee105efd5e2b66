"""Where a robot is: its joints and its tool centre point at any moment, as the language shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.errors import UsageError
from rpl.runtime.faults import ProgramError
from rpl.runtime.moves.chain import current_target, frames_of, joints_value
from rpl.runtime.moves.imagined import Imagined
from rpl.runtime.moves.pieces import Piece
from rpl.runtime.moves.scene import External
from rpl.runtime.values import JointsValue, TargetValue, Value

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray
    from rpl.ir.rules import Rules
    from rpl.motionmodel import MotionModel
    from rpl.runtime.ports import Machine, Task


class RobotState:
    """One robot, standing at `joints` or driving `piece`. Without a model it only imagines where it is."""

    def __init__(self, machine: Machine, task_index: int, model: RobotModel | None) -> None:
        self.machine = machine
        self.task_index = task_index
        self.model = model
        self.joints: FloatArray | None = _start(machine, model)
        self.at_start = self.joints
        self.external: External = machine.cell.external or (None,) * 6
        self.piece: Piece | None = None
        self.resting = False  # it keeps still for a time that the program has ordered (see resting)
        self.imagined = Imagined()
        self.interrupted: tuple[FloatArray, float, External] | None = None

    @property
    def task(self) -> Task:
        return self.machine.tasks[self.task_index]

    def controller_of(self, rules: Rules) -> MotionModel:
        """Who drives moves of that language: the controller chosen for the run, else the language's own."""
        from rpl.controllerfiles import controller_named
        from rpl.motionmodel import on_robot

        chosen = self.machine.controller or controller_named(rules.name)
        if self.model is None or self.model.motion_of != chosen.name:
            return chosen
        return on_robot(chosen, self.model.motion)

    def mark_interrupted(self) -> None:
        """An interrupt came: remember where the robot is."""
        if self.model is not None:
            self.interrupted = (self.joints_array(), self.machine.now, self.external_now())

    def joints_array(self) -> FloatArray:
        """Joints (n,) at this moment."""
        if self.joints is None:
            raise ProgramError("motion", "the position is asked for, but the run has no robot")
        if self.piece is not None:
            return self.piece.joints_at(self.machine.now)
        return self.joints

    def joints_now(self) -> tuple[float, ...] | None:
        if self.model is None:
            return tuple(self.imagined.joints) if self.imagined.joints is not None else None
        return tuple(float(joint) for joint in self.joints_array())

    def joints_as_value(
        self, rules: Rules, joints: FloatArray | None = None, external: External | None = None
    ) -> JointsValue:
        """The joints as the language shows them."""
        if self.model is None:
            if self.imagined.joints is None:
                raise ProgramError("motion", "the joints are asked for, but the run has no robot")
            return joints_value(self.imagined.joints, self.external, rules)
        here = self.joints_array() if joints is None else joints
        there = self.external_now() if external is None else external
        return joints_value([float(joint) for joint in here], there, rules)

    def external_now(self) -> External:
        """External axes at this moment."""
        piece = self.piece
        return self.external if piece is None else external_of(piece, self.machine.now, self.external)

    def target_now(
        self,
        tool: Value,
        frame: Value,
        rules: Rules,
        joints: FloatArray | None = None,
        external: External | None = None,
    ) -> TargetValue:
        """Where the tool centre point is, or would be at given joints and external axes."""
        modal = self.task.modal
        if rules.last_tool and modal.get("tool") is None:
            tool = tool if tool is not None else modal.get("tool_in_use")
            frame = frame if frame is not None else modal.get("frame_in_use")
        here_external = self.external_now() if external is None else external
        scene = self.machine.scene
        frames = frames_of(tool, frame, modal, {}, scene, here_external, self.model is not None)
        if self.model is None:
            return self.imagined.target(frames, self.external, rules)
        here = self.joints_array() if joints is None else joints
        notation = self.machine.linked.notation(rules.name)
        return current_target(self.model, here, here_external, frames, rules, notation)


def external_of(piece: Piece, now: float, before: External) -> External:
    """External axes on a piece; those that no move has named yet have no value."""
    values = piece.plan.external_at(min(max(now - piece.start_s, 0.0), piece.plan.duration_s))
    if len(values) != len(before):
        return before
    goal = piece.drive.external if piece.corner is None else piece.corner.following.external
    return tuple(
        None if old is None and new is None else float(value)
        for value, old, new in zip(values, before, goal, strict=True)
    )


def _start(machine: Machine, model: RobotModel | None) -> FloatArray | None:
    """Where the robot stands when the run begins."""
    given = machine.cell.joints
    if model is None or given is None:
        return model.home.copy() if model is not None else None
    import numpy as np

    if len(given) != model.axes:
        raise UsageError(f"{machine.cell.path}: joints: {model.name} has {model.axes}, {len(given)} are given")
    return np.array(given)
