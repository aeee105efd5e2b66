"""What ties a machine to the bodies around its robot: outputs that do something to them come as deeds on its agenda,
and what follows from them as inputs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell import Reaction

if TYPE_CHECKING:
    from rpl.cell.world import World
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.moves.scene import External
    from rpl.runtime.ports import Machine, Robot

_INPUTS = 0  # the phase of a moment in which the world acts


def deeds(world: World, robot: str) -> Iterator[Reaction]:
    """What a robot's outputs do to bodies, as reactions to them."""
    for switch, deed in world.switches(robot):
        yield Reaction(switch.signal, switch.value, 0.0, "", None, (), deed)


class Bodies:
    """The world as one robot's machine sees it. `robot`: its name in the cell; `base`: where it stands there (4, 4)."""

    def __init__(self, machine: Machine, world: World, robot: str, base: FloatArray) -> None:
        self.machine, self.world, self.robot, self.base = machine, world, robot, base
        world.join(robot, self)

    @property
    def now(self) -> float:
        """s on the clock."""
        return self.machine.now

    def flange_in_cell(self) -> FloatArray:
        """Where the flange is at this moment (4, 4)."""
        return np.asarray(self._carried(self._robot.joints_array()[None], [self._robot.external_now()])[0])

    @property
    def _robot(self) -> Robot:
        return next(task.robot for task in self.machine.tasks if task.robot is not None)

    def _carried(self, joints: FloatArray, external: Sequence[External]) -> FloatArray:
        """The flange in the cell (k, 4, 4) with joints (k, n); on a track, where that is."""
        from rpl.emulator.mechanisms import mechanism_pose

        model, rides = self.machine.model, self.machine.scene.rides
        assert model is not None  # who makes a world for a robot has one
        flanges = model.forward(joints)
        if rides is not None:
            flanges = np.stack([mechanism_pose(rides, [value or 0.0 for value in one]) for one in external]) @ flanges
        return np.asarray(self.base @ flanges)

    def _way(self, times: FloatArray) -> FloatArray:
        """The flange in the cell (k, 4, 4) at times (k,) of the piece that is driven."""
        piece = self._robot.piece
        assert piece is not None
        joints = piece.plan.joints_at(np.clip(times - piece.start_s, 0.0, piece.plan.duration_s))
        return self._carried(joints, [self._robot.external_now()] * len(times))

    def deed_later(self, time_s: float, deed: str) -> None:
        """Put something that happens to bodies on the agenda."""
        self.machine.schedule(max(time_s, self.now), _INPUTS, "deed", 0, deed)

    def input_later(self, time_s: float, signal: str, value: bool) -> None:
        """Put an input on the agenda."""
        self.machine.schedule(max(time_s, self.now), _INPUTS, "input", 0, signal, value)

    def happen(self, deed: str) -> None:
        """A deed of the agenda has come."""
        self.world.happen(self.robot, deed)

    def begins(self, start_s: float, end_s: float) -> None:
        """The arm drives from one moment to another."""
        self.world.begins(self.robot, start_s, end_s, self._way)
