"""URScript has no flags for the posture of the arm: a pose is reached by the solution nearest to where the arm is.

A pose is `p[x, y, z, rx, ry, rz]` in metres with the rotation vector in radians (script manual 5.2, section 1.3).
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from rpl.emulator.configuration import Flags, Selection, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import (
    FloatArray,
    IntArray,
    matrix_to_rotation_vector,
    pose_matrix,
    rotation_vector_to_matrix,
)
from rpl.emulator.selection import Chosen, Rule, choose, joints_before
from rpl.errors import SourceError

_POSE = re.compile(r"p?\s*\[([^\[\]]*)\]")


class UrscriptNotation:
    """No flags."""

    name: Final = "urscript"
    fields: Final = ()
    pose_fields: Final = ("x", "y", "z", "rx", "ry", "rz")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """There is nothing to say about joints (n,)."""
        return {}

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """No columns for joints (k, n)."""
        return np.zeros((len(joints), 0), dtype=np.int64)

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4)."""
        near = joints_before(model, reference, len(flanges))
        return choose(model, flanges, near, Rule(lambda found: found.valid, lambda axis, values: None, near, "time"))

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution nearest to the joints before the move; without any to the home position."""
        near = model.home if reference is None else reference
        joints = model.nearest(flange, near)
        if joints is None:
            return Selection(None, "getInverseKin: no solution found")
        return Selection(joints)

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`p[0.1, 0.2, 0.3, 0, 3.141593, 0]`"""
        vector = matrix_to_rotation_vector(matrix[:3, :3])
        values = [*(matrix[:3, 3] / 1000.0), *vector]
        return "p[" + ", ".join(format_number(float(value), 9) for value in values) + "]"

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) in mm of positions in m and rotation vectors (k, 6)."""
        return pose_matrix(1000.0 * values[:, :3], rotation_vector_to_matrix(values[:, 3:]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """Positions in m and rotation vectors (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3] / 1000.0, matrix_to_rotation_vector(poses)])

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose of `p[...]`; `SourceError` when it is none."""
        found = _POSE.search(text)
        try:
            values = [float(part) for part in found[1].split(",")] if found is not None else []
        except ValueError:
            values = []
        if len(values) != 6:
            raise SourceError(f"'{text.strip()}' is no pose: expected p[x, y, z, rx, ry, rz] in metres and radians")
        rotation = rotation_vector_to_matrix(np.array(values[3:]))
        return pose_matrix([1000.0 * value for value in values[:3]], rotation), {}


NOTATION: Final = UrscriptNotation()
