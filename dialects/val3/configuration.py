"""VAL3 configurations: shoulder, elbow and wrist of a point, each a side, `same` or `free`.

Flags: 0 righty, epositive, wpositive; 1 lefty, enegative, wnegative; 2 free. A flag without a value is `same`: the
axis stays on the side where it is. epositive is joint 3 at or above 0, wpositive joint 5 likewise (published
postprocessors agree); righty is the wrist in front of axis 1 (M). An arm without a shoulder and a wrist to choose
(SCARA) has its elbow in `shoulder`.
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.postures import sides
from rpl.emulator.rotations import FloatArray, IntArray, matrix_to_xyz_moving, pose_matrix, xyz_moving_to_matrix
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError
from rpl.registry import words

FREE: Final = 2
_ALL_WORDS: Final = {name: tuple(text.split()) for name, text in words("val3").pairs("configuration").items()}
WORDS: Final = {name: every[:3] for name, every in _ALL_WORDS.items()}
SAME: Final = tuple(every[3] for every in _ALL_WORDS.values())
_NUMBERS = re.compile(r"\{([^{}]*)\}")


def _words(model: RobotModel, branch: IntArray) -> IntArray:
    """Flags (..., 3) of shoulder, elbow and wrist (..., 3), the sides of rpl.emulator.arms.Branch."""
    shoulder, elbow, wrist = branch[..., 0], branch[..., 1], branch[..., 2]
    if len({one.shoulder for one in model.arm.branches}) == 1:
        return np.stack([elbow, 0 * elbow, 0 * elbow], axis=-1)
    return np.stack([shoulder, elbow, wrist], axis=-1)


class Val3Notation:
    """Shoulder, elbow, wrist."""

    name: Final = "val3"
    fields: Final = ("shoulder", "elbow", "wrist")
    pose_fields: Final = ("x", "y", "z", "rx", "ry", "rz")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The configuration of these joints (n,)."""
        return dict(zip(self.fields, map(int, self.encode_all(model, joints[None])[0]), strict=True))

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """Configurations (k, 3) of joints (k, n)."""
        return _words(model, sides(model, joints))

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution on the sides asked for; what is not asked for stays as the arm has it, what is free is as near
        as can be. Without a reference everything not asked for is free."""
        found = self.select_all(model, flange[None], flag_row(self.fields, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the point is out of reach")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        asked = " ".join(WORDS[name][value] for name, value in flags.items() if value is not None and name in WORDS)
        return Selection(None, f"the point cannot be reached {asked or 'in the configuration of the start'}")

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 3)."""
        near = joints_before(model, reference, len(flanges))
        wanted = flags
        if reference is not None and np.isnan(flags).any():
            wanted = np.where(np.isnan(flags), self.encode_all(model, near), flags)

        def fits(found: Candidates) -> BoolArray:
            open_ = np.isnan(wanted) | (wanted == FREE)
            met = open_[:, None] | (_words(model, found.sides)[None] == wanted[:, None])
            met[..., 2] |= found.straight
            return np.asarray(met.all(axis=-1))

        return choose(model, flanges, near, Rule(fits, lambda axis, values: None, near, "time"))

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`{{x,y,z,rx,ry,rz},{righty,epositive,wpositive}}`; without joints the configuration is `same`."""
        numbers = ",".join(format_number(float(value), 6) for value in self.values_of(matrix[None])[0])
        words = SAME
        if joints is not None:
            words = tuple(WORDS[name][value] for name, value in self.encode(model, joints).items())
        return f"{{{{{numbers}}},{{{','.join(words)}}}}}"

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of x, y, z, rx, ry, rz (k, 6)."""
        return pose_matrix(values[:, :3], xyz_moving_to_matrix(values[:, 3:]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """x, y, z, rx, ry, rz (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], matrix_to_xyz_moving(poses[:, :3, :3])])

    def parse_flags(self, text: str) -> dict[str, int | None]:
        """The configuration of words such as `{lefty,esame,wfree}`."""
        given = set(re.findall(r"[a-z]+", text))
        return {
            name: next((value for value, word in enumerate(words) if word in given), None)
            for name, words in WORDS.items()
        }

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and configuration of `{{x,y,z,rx,ry,rz},{...}}`; `SourceError` when it is none."""
        found = _NUMBERS.search(text)
        try:
            values = [float(part) for part in found[1].split(",")] if found else []
        except ValueError:
            values = []
        if found is None or len(values) != 6:
            raise SourceError(f"'{text.strip()}' is no VAL3 point: expected {{{{x,y,z,rx,ry,rz}},{{...}}}}")
        return self.poses_of(np.array([values]))[0], self.parse_flags(text[found.end() :])


NOTATION: Final = Val3Notation()
