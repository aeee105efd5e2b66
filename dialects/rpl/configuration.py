"""RPL's own way to say which posture of an arm a target means: the branch itself, not a brand's code for it.

`shoulder` 1: the wrist centre lies behind axis 1. `elbow` 1: the arm is bent backward over the stretched position.
`wrist` 1: axis 5 on the far side of the straight wrist. `t1`, `t4`, `t6`: whole turns of these axes away from
(-180, 180]. What is not said is free, and the robot takes what lies nearest to where it is.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.postures import sides
from rpl.emulator.rotations import FloatArray, IntArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError

from .words import POSTURE_FLAGS

_BRANCH: Final = ("shoulder", "elbow", "wrist")
_TURNS: Final = {"t1": 0, "t4": 3, "t6": 5}
_AXES: Final = ("x", "y", "z", "a", "b", "c")
# What is so close to half a turn counts as just that, degrees.
ROUNDED_DEG: Final = 5e-4
_AGGREGATE = re.compile(r"\{([^{}]*)\}")
_COMPONENT = re.compile(r"\s*([A-Za-z]\w*)\s*:\s*([+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*")


def _turns(angles: FloatArray) -> FloatArray:
    """Whole turns of angles away from (-180, 180]."""
    return np.asarray(np.ceil((angles - 180.0 - ROUNDED_DEG) / 360.0))


class RplNotation:
    """The branch of the arm and the turns of its axes."""

    name: Final = "rpl"
    fields: Final = POSTURE_FLAGS
    pose_fields: Final = _AXES

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The flags of these joints (n,)."""
        return dict(zip(self.fields, map(int, self.encode_all(model, joints[None])[0]), strict=True))

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """Flags (k, 6) of joints (k, n)."""
        columns = [_turns(joints[:, axis]) if axis < model.axes else np.zeros(len(joints)) for axis in _TURNS.values()]
        return np.column_stack([sides(model, joints), *columns]).astype(np.int64)

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution nearest to `reference` (or the home position) among those that have the given flags."""
        found = self.select_all(model, flange[None], flag_row(self.fields, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the pose is out of reach")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        return Selection(None, self._refusal(model, flags))

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 6)."""
        near = joints_before(model, reference, len(flanges))

        def fits(found: Candidates) -> BoolArray:
            asked = flags[:, None, :3]
            met = np.isnan(asked) | (found.sides[None] == asked)
            met[..., 2] |= found.straight | found.singular  # in a singular posture the wrist's side means nothing
            return np.asarray(met.all(axis=-1))

        def turn_cost(axis: int, values: FloatArray) -> FloatArray | None:
            if axis not in _TURNS.values():
                return None
            asked = flags[:, 3 + list(_TURNS.values()).index(axis), None, None]
            return np.where(np.isnan(asked) | (_turns(values) == asked), 0.0, np.inf)

        return choose(model, flanges, near, Rule(fits, turn_cost, near, "time"))

    def _refusal(self, model: RobotModel, flags: Flags) -> str:
        asked = ", ".join(f"{name} {flags[name]}" for name in self.fields if flags.get(name) is not None)
        return f"{model.name} reaches this pose, but not with {asked}" if asked else "every solution exceeds a limit"

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`{x: 1, y: 2, z: 3, a: 4, b: 5, c: 6, shoulder: 0, ...}`; without joints no flags."""
        values = [*matrix[:3, 3], *matrix_to_zyx(matrix)]
        parts = [f"{axis}: {format_number(float(value), 6)}" for axis, value in zip(_AXES, values, strict=True)]
        if joints is not None:
            parts += [f"{name}: {value}" for name, value in self.encode(model, joints).items()]
        return "{" + ", ".join(parts) + "}"

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of x, y, z, a, b, c (k, 6)."""
        return pose_matrix(values[:, :3], zyx_to_matrix(values[:, 3:]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """x, y, z, a, b, c (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], matrix_to_zyx(poses)])

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and flags of a written target. `SourceError` when it is none."""
        found = _AGGREGATE.search(text)
        if found is None:
            raise SourceError(f"'{text.strip()}' is no pose: expected {{x: .., y: .., z: .., a: .., b: .., c: ..}}")
        values: dict[str, float] = {}
        for part in found[1].split(","):
            component = _COMPONENT.fullmatch(part)
            if component is None:
                raise SourceError(f"'{part.strip()}' is no component of a pose")
            values[component[1].lower()] = float(component[2])
        missing = [axis for axis in _AXES if axis not in values]
        if missing:
            raise SourceError(f"the pose {found[0]} lacks {', '.join(missing)}")
        x, y, z, a, b, c = (values[axis] for axis in _AXES)
        flags = {name: int(values[name]) if name in values else None for name in self.fields}
        return pose_matrix([x, y, z], zyx_to_matrix([a, b, c])), flags


NOTATION: Final = RplNotation()
