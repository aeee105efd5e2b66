"""RPL's own way to say which posture of an arm a target means: the branch itself, not a brand's code for it.

`shoulder` 1: the wrist centre lies behind axis 1. `elbow` 1: the arm is bent backward over the stretched position.
`wrist` 1: axis 5 on the far side of the straight wrist. `t1`, `t4`, `t6`: whole turns of these axes away from
(-180, 180]. What is not said is free, and the robot takes what lies nearest to where it is.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from rpl.emulator.configuration import Flags, Selection, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.errors import SourceError

from .words import POSTURE_FLAGS

_BRANCH: Final = ("shoulder", "elbow", "wrist")
_TURNS: Final = {"t1": 0, "t4": 3, "t6": 5}
_AXES: Final = ("x", "y", "z", "a", "b", "c")
_AGGREGATE = re.compile(r"\{([^{}]*)\}")
_COMPONENT = re.compile(r"\s*([A-Za-z]\w*)\s*:\s*([+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*")


class RplNotation:
    """The branch of the arm and the turns of its axes."""

    name: Final = "rpl"
    fields: Final = POSTURE_FLAGS

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The flags of these joints (n,)."""
        branch = model.posture(joints).branch
        turns = model.turns(joints)
        flags = {"shoulder": branch.shoulder, "elbow": branch.elbow, "wrist": branch.wrist}
        return flags | {name: int(turns[axis]) if axis < model.axes else 0 for name, axis in _TURNS.items()}

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution nearest to `reference` (or the home position) among those that have the given flags."""
        near = model.home if reference is None else reference
        solutions = model.inverse(flange, near)
        if not solutions:
            return Selection(None, "the pose is out of reach")
        asked = {name: flags.get(name) for name in _BRANCH if flags.get(name) is not None}
        fitting = [s for s in solutions if all(getattr(s.branch, name) == value for name, value in asked.items())]
        fitting = fitting or [s for s in solutions if s.singular and self._but_wrist(s.branch, asked)]
        choices = [joints for s in fitting for joints in model.expand_turns(s) if self._turned(model, joints, flags)]
        if not choices:
            return Selection(None, self._refusal(model, flags))
        travel = [float(np.linalg.norm((joints - near) / model.speeds)) for joints in choices]
        return Selection(choices[int(np.argmin(travel))])

    def _but_wrist(self, branch: object, asked: dict[str, int | None]) -> bool:
        """In a singular posture the wrist's side means nothing."""
        return all(getattr(branch, name) == value for name, value in asked.items() if name != "wrist")

    def _turned(self, model: RobotModel, joints: FloatArray, flags: Flags) -> bool:
        turns = model.turns(joints)
        return all(
            flags.get(name) is None or axis >= model.axes or int(turns[axis]) == flags[name]
            for name, axis in _TURNS.items()
        )

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
