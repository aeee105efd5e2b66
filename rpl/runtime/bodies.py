"""What ties a machine to the bodies around its robot: outputs that do something to them come as deeds on its agenda,
and what follows from them as inputs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rpl.cell import Reaction

if TYPE_CHECKING:
    from rpl.cell.world import World
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.ports import Machine

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
        from rpl.emulator.mechanisms import mechanism_pose

        robot = next(task.robot for task in self.machine.tasks if task.robot is not None)
        model, rides = self.machine.model, self.machine.scene.rides
        assert model is not None  # who makes a world for a robot has one
        flange = model.forward(robot.joints_array())
        if rides is not None:
            flange = mechanism_pose(rides, [value or 0.0 for value in robot.external_now()]) @ flange
        return self.base @ flange

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
        self.world.begins(self.robot, start_s, end_s)
