"""Bodies of an arm where nothing better is known: capsules along its axes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell.shapes import Capsule, Shape
from rpl.emulator.rotations import FloatArray
from rpl.view.screws import screws_of

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True, eq=False)
class LinkBody:
    """A form that moves with a link, `at` (4, 4) in the frame of the link."""

    link: int
    shape: Shape
    at: FloatArray


def zero_poses(model: RobotModel) -> FloatArray:
    """The frames (links + 1, 4, 4) of the links where all variables of the arm are zero, in the robot's base."""
    return np.broadcast_to(np.eye(4), (model.axes + 1, 4, 4))


def arm_bodies(model: RobotModel) -> tuple[LinkBody, ...]:
    """Capsules from each axis to the next one."""
    screws = screws_of(model)
    points = [np.zeros(3), *screws.points, screws.flange[:3, 3]]
    if float(np.ptp(screws.points[0])) < 1.0 and model.axes > 1:  # axis 1 stands at the origin: up to axis 2's height
        points[1] = np.array([0.0, 0.0, screws.points[1][2] * 0.5])
    reach = max(float(np.linalg.norm(points[-1])), 300.0)
    found = []
    for link, (start, end) in enumerate(pairwise(points)):
        diameter = reach * (0.13 - 0.013 * min(link, 5))
        found.append(_capsule(link, start, end, diameter))
    return tuple(found)


def _capsule(link: int, start: FloatArray, end: FloatArray, diameter: float) -> LinkBody:
    along = end - start
    length = float(np.linalg.norm(along))
    pose = np.eye(4)
    if length > 1e-6:
        z = along / length
        x = np.cross(z, [0.0, 0.0, 1.0] if abs(z[2]) < 0.9 else [1.0, 0.0, 0.0])
        x /= np.linalg.norm(x)
        pose[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    pose[:3, 3] = (start + end) / 2.0
    return LinkBody(link, Capsule(diameter, length), pose)
