"""An arm as a product of exponentials: how each link is displaced from where it is with all arm variables zero.

A page can move an arm by this alone, whatever family it belongs to: per joint a point and a direction. Source:
Brockett, Robotic manipulators and the product of exponentials formula (1984); Lynch and Park, Modern Robotics (2017),
section 4.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_vector_to_matrix

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True, eq=False)
class Screws:
    """Per joint a point (n, 3) of its axis and the axis' direction (n, 3), mm in the robot's base, all variables zero;
    `sliding` (n,): along the axis, not about it. Variables (rad, mm) are `unit * (matrix @ pendant - offsets)`.
    `flange` (4, 4) is where it is at zero."""

    points: FloatArray
    directions: FloatArray
    sliding: tuple[bool, ...]
    matrix: FloatArray
    offsets: FloatArray
    unit: FloatArray
    flange: FloatArray

    def displacements(self, joints: FloatArray) -> FloatArray:
        """How far each link is from where it is at zero: (k, n + 1, 4, 4) for pendant joints (k, n); link 0 is the
        base, which stands still."""
        theta = (joints @ self.matrix.T - self.offsets) * self.unit
        found = [np.broadcast_to(np.eye(4), (len(theta), 4, 4))]
        for number, slides in enumerate(self.sliding):
            point, direction, amount = self.points[number], self.directions[number], theta[:, number]
            if slides:
                step = pose_matrix(amount[:, None] * direction)
            else:
                turn = rotation_vector_to_matrix(amount[:, None] * direction)
                step = pose_matrix(point - turn @ point, turn)
            found.append(found[-1] @ step)
        return np.stack(found, axis=1)


def screws_of(model: RobotModel) -> Screws:
    """The screws of an arm."""
    zero = np.zeros(model.axes)
    points, directions = model.arm.axes(zero)
    lengths = np.linalg.norm(directions, axis=-1, keepdims=True)
    return Screws(
        np.asarray(points, dtype=np.float64),
        np.asarray(directions / np.maximum(lengths, 1e-12)),
        tuple(not turning for turning in model.revolute.tolist()),
        model.pendant_to_arm,
        model.offsets,
        model.unit,
        model.arm.forward(zero),
    )
