"""V+ postures: LEFTY or RIGHTY, ABOVE or BELOW, FLIP or NOFLIP, and the text of a location.

A location carries none of them: a move keeps the posture the arm is in, unless the step before asks for another one.
Flags: shoulder 0 RIGHTY, 1 LEFTY; elbow 0 ABOVE, 1 BELOW; wrist 0 NOFLIP, 1 FLIP (joint 5 negative). RIGHTY is the arm
with its elbow to the right of the line from shoulder to wrist: on a SCARA joint 2 positive, on a six-axis arm the wrist
in front of axis 1 (M: the vendor's table depends on the model). ABOVE is seen from outside, so behind axis 1 it is the
other side of the elbow's joint.
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.postures import sides
from rpl.emulator.rotations import FloatArray, IntArray, pose_matrix, zyx_to_matrix, zyz_to_matrix
from rpl.emulator.rotations import matrix_to_zyz as all_zyz
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError
from rpl.passes.rigid import angle_of

from .tables import FLAGS

_TRANS = re.compile(r"TRANS\s*\(([^()]*)\)", re.IGNORECASE)
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)?\s*")


def _only_elbow(model: RobotModel) -> bool:
    """Has the arm no other choice than its elbow (a SCARA)? That is its handedness."""
    return len({branch.shoulder for branch in model.arm.branches}) == 1


def _words(model: RobotModel, branch: IntArray) -> IntArray:
    """Flags (..., 3) of shoulder, elbow and wrist (..., 3)."""
    shoulder, elbow, wrist = branch[..., 0], branch[..., 1], branch[..., 2]
    if _only_elbow(model):
        return np.stack([elbow, 0 * elbow, 0 * elbow], axis=-1)
    return np.stack([shoulder, elbow ^ shoulder, wrist], axis=-1)


class VplusNotation:
    """Handedness, elbow, wrist."""

    name: Final = "vplus"
    fields: Final = ("shoulder", "elbow", "wrist")
    pose_fields: Final = ("x", "y", "z", "yaw", "pitch", "roll")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The posture of these joints (n,)."""
        return dict(zip(self.fields, map(int, self.encode_all(model, joints[None])[0]), strict=True))

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """Postures (k, 3) of joints (k, n)."""
        return _words(model, sides(model, joints))

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution in the posture asked for; what is not asked for stays as the arm has it, and each axis takes
        its shortest way. Without a reference everything not asked for is free."""
        found = self.select_all(model, flange[None], flag_row(self.fields, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the location is out of range")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        wanted = dict.fromkeys(self.fields) if reference is None else dict(self.encode(model, reference))
        wanted.update({name: value for name, value in flags.items() if value is not None and name in wanted})
        asked = " ".join(FLAGS[name][value] for name, value in wanted.items() if value is not None)
        return Selection(None, f"the location cannot be reached {asked}".rstrip())

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 3)."""
        near = joints_before(model, reference, len(flanges))
        wanted = flags
        if reference is not None and np.isnan(flags).any():
            wanted = np.where(np.isnan(flags), self.encode_all(model, near), flags)

        def fits(found: Candidates) -> BoolArray:
            met = np.isnan(wanted)[:, None] | (_words(model, found.sides)[None] == wanted[:, None])
            met[..., 2] |= found.straight
            return np.asarray(met.all(axis=-1))

        return choose(model, flanges, near, Rule(fits, lambda axis, values: None, near, "time"))

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`TRANS(x, y, z, yaw, pitch, roll)`; with joints the posture's words behind it, as a comment."""
        values = [*matrix[:3, 3], *matrix_to_zyz(matrix)]
        text = "TRANS(" + ", ".join(format_number(float(value), 6) for value in values) + ")"
        if joints is None:
            return text
        flags = self.encode(model, joints)
        used = ("shoulder",) if _only_elbow(model) else self.fields
        return f"{text} ;{' '.join(FLAGS[name][flags[name]] for name in used)}"

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of x, y, z, yaw, pitch, roll (k, 6)."""
        return pose_matrix(values[:, :3], zyz_to_matrix(values[:, 3:]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """x, y, z, yaw, pitch, roll (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], all_zyz(poses)])

    def parse_flags(self, text: str) -> dict[str, int | None]:
        """The posture of words such as `LEFTY ABOVE`."""
        given = set(text.upper().replace(";", " ").replace(",", " ").split())
        return {
            name: next((value for value, word in enumerate(words) if word in given), None)
            for name, words in FLAGS.items()
        }

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and posture of `TRANS(...) ;LEFTY ...`; `SourceError` when it is none."""
        found = _TRANS.search(text)
        if found is None:
            raise SourceError(f"'{text.strip()}' is no V+ location: expected TRANS(x, y, z, yaw, pitch, roll)")
        parts = found[1].split(",")
        numbers = [_NUMBER.fullmatch(part) for part in parts]
        if len(parts) > 6 or not all(numbers):
            raise SourceError(f"'{found[0]}' is no V+ location: up to six numbers are expected")
        values = [float(number[1] or 0.0) if number else 0.0 for number in numbers]
        x, y, z, yaw, pitch, roll = values + [0.0] * (6 - len(values))
        flags = self.parse_flags(text[found.end() :])
        turn = zyx_to_matrix([yaw, pitch, 0.0]) @ zyx_to_matrix([roll, 0.0, 0.0])
        return pose_matrix([x, y, z], turn), flags


def matrix_to_zyz(matrix: FloatArray) -> tuple[float, float, float]:
    """Yaw, pitch, roll of Rz(yaw)·Ry(pitch)·Rz(roll), degrees; pitch in [0, 180]. Where the pitch is 0 or 180 the yaw
    is 0 and the roll has all of the turn, as the controller shows it."""
    turn = matrix[:3, :3]
    sine = float(np.hypot(turn[0, 2], turn[1, 2]))
    if sine < 1e-9:
        down = bool(turn[2, 2] < 0.0)
        across = float(turn[0, 1] if down else -turn[0, 1])
        return 0.0, 180.0 if down else 0.0, angle_of(across, float(turn[1, 1]))
    yaw, roll = angle_of(float(turn[1, 2]), float(turn[0, 2])), angle_of(float(turn[2, 1]), -float(turn[2, 0]))
    return yaw, angle_of(sine, float(turn[2, 2])), roll


NOTATION: Final = VplusNotation()
__all__ = ["NOTATION", "VplusNotation", "matrix_to_zyz"]
