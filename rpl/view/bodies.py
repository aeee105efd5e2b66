"""What is drawn of a cell: each body with its form, its colour, and what carries it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from rpl.cell.armbodies import arm_bodies
from rpl.cell.shapes import Box, Shape, bounds_at
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix
from rpl.workcell.sweeping.scene import NAMELESS

if TYPE_CHECKING:
    from rpl.cell.layout import Gripper
    from rpl.emulator.model import RobotModel
    from rpl.workcell.record import CellRun

Kind = Literal["arm", "tool", "jaw", "fixture", "bin", "part", "sensor"]
Colour = tuple[int, int, int]

# Robots, parts: told apart also by who sees colours otherwise (after Okabe and Ito, Color Universal Design, 2008).
ROBOTS: tuple[Colour, ...] = ((232, 119, 34), (58, 124, 190), (46, 148, 108), (190, 110, 160))
PARTS: tuple[Colour, ...] = (
    (86, 180, 233),
    (0, 158, 115),
    (240, 200, 60),
    (204, 121, 167),
    (213, 94, 0),
    (0, 114, 178),
)
TOOL: Colour = (96, 108, 120)
FIXTURE: Colour = (186, 194, 202)
BIN: Colour = (150, 166, 182)
SENSOR: Colour = (220, 60, 60)
JAW_MM = (24.0, 6.0, 36.0)


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """A body, by the name that it has where collisions are told.

    It is carried by a link of a robot (0: the base, the last one: the flange), by a part, or by nothing. `at` (4, 4) is
    its place there: of a link where the arm's variables are all zero, in the robot's base. `way` (3,) of a jaw: where
    it goes when the gripper opens; it is drawn where it is `rest_mm` from the middle."""

    name: str
    kind: Kind
    shape: Shape
    at: FloatArray
    colour: Colour
    robot: int = -1
    link: int = -1
    part: int = -1
    gripper: int = -1
    way: FloatArray | None = None
    rest_mm: float = 0.0


def bodies_of(run: CellRun) -> tuple[Drawn, ...]:
    """All bodies of a cell, those that stand first."""
    layout = run.layout
    found = [
        Drawn(one.name, "bin" if one.inside else "fixture", body.shape, body.at, BIN if one.inside else FIXTURE)
        for one in layout.fixtures
        for body in one.bodies
    ]
    for number, robot in enumerate(run.robots):
        if robot.model is not None:
            found += arm_drawn(robot.model, number, robot.place.name or NAMELESS)
            for place, gripper in enumerate(layout.grippers):
                if robot_of(run, gripper.robot) == number:
                    found += _gripper(gripper, place, number, robot.model)
    for number, part in enumerate(layout.parts):
        found.append(Drawn(part.name, "part", part.shape, np.eye(4), PARTS[number % len(PARTS)], part=number))
    found += [Drawn(one.name, "sensor", one.body.shape, one.body.at, SENSOR) for one in layout.sensors]
    return tuple(found)


def robot_of(run: CellRun, name: str) -> int:
    """Which robot a row of the cell means; "" is the only one."""
    names = [one.place.name for one in run.robots]
    return names.index(name) if name in names else 0


def arm_drawn(model: RobotModel, number: int, name: str) -> list[Drawn]:
    """The links of an arm; every second one a little lighter, so that one sees them turn."""
    found = []
    for body in arm_bodies(model):
        colour = ROBOTS[number % len(ROBOTS)]
        if body.link % 2:
            colour = (_lighter(colour[0]), _lighter(colour[1]), _lighter(colour[2]))
        label = f"{name}.link{body.link}" if body.link else f"{name}.base"
        found.append(Drawn(label, "arm", body.shape, body.at, colour, number, body.link))
    return found


def _lighter(value: int) -> int:
    return value + (255 - value) // 4


def _gripper(gripper: Gripper, place: int, robot: int, model: RobotModel) -> list[Drawn]:
    """Its bodies. Those of jaws move: bodies that lie wholly to one side of the grip, as they stand when it is open;
    without any, thin plates show how far it is open."""
    flange = flange_at_zero(model)
    across = (flange @ gripper.grip)[:3, 1]
    found, sides = [], 0
    for body in gripper.bodies:
        low, high = bounds_at(body.shape, invert_pose(gripper.grip) @ body.at)[:, 1]
        if gripper.kind == "jaws" and (side := int(low > 0.0) - int(high < 0.0)):
            sides += 1
            rest = gripper.opening[1] / 2.0
            found.append(_jaw(gripper.name, body.shape, flange @ body.at, side * across, rest, place, robot, model))
        else:
            found.append(Drawn(gripper.name, "tool", body.shape, flange @ body.at, TOOL, robot, model.axes))
    if gripper.kind == "jaws" and not sides:
        for side in (1, -1):
            here = flange @ gripper.grip @ pose_matrix(np.array([0.0, side * JAW_MM[1] / 2.0, 0.0]))
            found.append(_jaw(gripper.name, Box(JAW_MM), here, side * across, 0.0, place, robot, model))
    return found


def _jaw(
    name: str, shape: Shape, at: FloatArray, way: FloatArray, rest: float, place: int, robot: int, model: RobotModel
) -> Drawn:
    return Drawn(name, "jaw", shape, at, TOOL, robot, model.axes, gripper=place, way=way, rest_mm=rest)


def flange_at_zero(model: RobotModel) -> FloatArray:
    """The flange (4, 4) in the robot's base where all variables of the arm are zero."""
    return model.arm.forward(np.zeros(model.axes))
