"""An arm as a product of exponentials: the numbers with which a page moves it, whatever family it belongs to.

Per joint a point and a direction: `rpl.cell.armbodies.link_poses` does the same with the arm itself. Source: Lynch and
Park, Modern Robotics (2017), section 4.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray

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


def screws_document(screws: Screws) -> dict[str, object]:
    """The numbers for a page: lengths to a micrometre; variables (rad, mm) are `matrix @ pendant - offsets` there."""
    return {
        "points": np.round(screws.points, 6).tolist(),
        "directions": np.round(screws.directions, 9).tolist(),
        "sliding": list(screws.sliding),
        "matrix": (screws.unit[:, None] * screws.matrix).tolist(),
        "offsets": (screws.unit * screws.offsets).tolist(),
        "flange": row_of(screws.flange),
    }


def row_of(pose: FloatArray) -> list[float]:
    """The upper rows of a pose (4, 4): twelve numbers, lengths to a micrometre."""
    rows = np.hstack([np.round(pose[:3, :3], 7), np.round(pose[:3, 3:], 3)]) + 0.0
    return [int(value) if value == int(value) else value for value in rows.ravel().tolist()]
