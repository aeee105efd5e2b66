"""RAPID's confdata: which posture of the arm a robtarget means, and the text of a robtarget.

cf1, cf4 and cf6 are the quarter turns of axes 1, 4 and 6, floor(angle / 90) by strict signs: -0.00018 degrees is
quarter -1, exactly 90 is quarter 1. cfx = 4 (wrist centre behind axis 1) + 2 (wrist centre beyond the line through axes
2 and 3) + 1 (axis 5 negative). Sources: RAPID system data types, confdata and ConfJ; checked against `CalcRobT` of a
virtual controller (IRB 6700), where the elbow bit flips at -atan2(forearm, elbow offset).
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel, Solution
from rpl.emulator.postures import UNKNOWN_BUILD, has_flags, sides
from rpl.emulator.rotations import FloatArray, IntArray, matrix_to_quaternion, pose_matrix, quaternion_to_matrix
from rpl.emulator.rounding import NOISE, settled
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError

# With ConfJ \On an axis may lie this far outside its quarter turn and still counts as being in it, degrees.
QUARTER_SLACK_DEG: Final = 45.0
# What lies on the edge of a quarter turn from outside counts as this far from it, so that one inside is preferred.
LEAST_DEG: Final = 1e-6
# Arms whose parallelogram leaves no choice: their controller does not use cfx.
CFX_UNUSED: Final = frozenset({"abb_irb2400"})
QUARTERS: Final = {"cf1": 0, "cf4": 3, "cf6": 5}
# What shoulder, elbow and wrist count in cfx.
CFX_WEIGHTS: Final = np.array([4, 2, 1])
# A quaternion may be off unit length by the rounding of four printed decimals, not more.
UNIT_SLACK: Final = 0.01

# An external axis with 9E9 is not in use.
UNUSED: Final = 1e9

_NUMBER = r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*"
_LIST3 = r"\[" + ",".join([_NUMBER] * 3) + r"\]"
_LIST4 = r"\[" + ",".join([_NUMBER] * 4) + r"\]"
_LIST6 = r"\[" + ",".join([_NUMBER] * 6) + r"\]"
_POSE = re.compile(rf"\[\s*{_LIST3}\s*,\s*{_LIST4}\s*(?:,\s*{_LIST4}\s*(?:,\s*{_LIST6}\s*)?)?\]")


class RapidNotation:
    """cf1, cf4, cf6, cfx."""

    name: Final = "rapid"
    fields: Final = ("cf1", "cf4", "cf6", "cfx")
    pose_fields: Final = ("x", "y", "z", "q1", "q2", "q3", "q4")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The confdata that the controller shows at these joints (n,)."""
        return dict(zip(self.fields, map(int, self.encode_all(model, joints[None])[0]), strict=True))

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """Confdata (k, 4) at joints (k, n)."""
        flags = np.zeros((len(joints), 4), dtype=np.int64)
        for place, axis in enumerate(QUARTERS.values()):
            if axis < model.axes:
                flags[:, place] = np.floor(settled(joints[:, axis]) / 90.0)
        if model.name not in CFX_UNUSED:
            flags[:, 3] = sides(model, joints) @ CFX_WEIGHTS
        return flags

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a MoveJ to a robtarget.

        Given flags (ConfJ \\On) must be met: cfx exactly, each quarter turn within 45 degrees, an exact one preferred.
        Missing flags (ConfJ \\Off) keep the main-arm configuration of `reference` and take the nearest revolution.
        """
        found = self.select_all(model, flange[None], flag_row(self.fields, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the position is outside the reach")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        if not has_flags(model):
            return Selection(None, UNKNOWN_BUILD)
        return Selection(None, self._refusal(model, model.inverse(flange, reference), flags))

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 4)."""
        near = joints_before(model, reference, len(flanges))
        wanted = flags[:, 3]

        def fits(found: Candidates) -> BoolArray:
            if model.name in CFX_UNUSED:
                return np.ones(found.valid.shape, dtype=np.bool_)
            asked, missing = np.nan_to_num(wanted).astype(np.int64), np.isnan(wanted)
            differing = (found.sides @ CFX_WEIGHTS)[None] ^ asked[:, None]
            met = (differing == 0) | (found.straight & (differing == 1))
            if not missing.any():
                return np.asarray(met)
            kept = np.ones_like(met)
            if reference is not None:
                kept = (found.sides[None, :, :2] == sides(model, near)[:, None, :2]).all(axis=-1)
            return np.asarray(np.where(missing[:, None], kept, met))

        def turn_cost(axis: int, values: FloatArray) -> FloatArray | None:
            place = next((place for place, one in enumerate(QUARTERS.values()) if one == axis), None)
            return None if place is None else _outside_quarter(values, flags[:, place])

        return choose(model, flanges, near, Rule(fits, turn_cost, near, "time"))

    def _refusal(self, model: RobotModel, solutions: tuple[Solution, ...], flags: Flags) -> str:
        possible = set()
        for solution in solutions:
            for joints in model.expand_turns(solution):
                shown = self.encode(model, joints)
                possible.add(tuple(shown[field] for field in self.fields))
        asked = "[" + ",".join("-" if flags.get(f) is None else str(flags[f]) for f in self.fields) + "]"
        if not possible:
            return f"configuration {asked} cannot be reached: every solution exceeds a joint limit"
        listed = " ".join("[" + ",".join(map(str, conf)) + "]" for conf in sorted(possible))
        return f"configuration {asked} cannot be reached: the arm reaches this position with {listed}"

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """A robtarget without external axes; without joints its confdata is [0,0,0,0]."""
        position = ",".join(format_number(float(v), 6) for v in matrix[:3, 3])
        turn = ",".join(format_number(float(v), 9) for v in matrix_to_quaternion(matrix))
        flags = self.encode(model, joints) if joints is not None else dict.fromkeys(self.fields, 0)
        conf = ",".join(str(flags[field]) for field in self.fields)
        return f"[[{position}],[{turn}],[{conf}],[9E9,9E9,9E9,9E9,9E9,9E9]]"

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of positions and quaternions (k, 7); NaN where a quaternion is not of length 1."""
        length = np.linalg.norm(values[:, 3:], axis=1)
        bad = ~(np.abs(length - 1.0) <= UNIT_SLACK)
        poses = pose_matrix(values[:, :3], quaternion_to_matrix(np.where(bad[:, None], [1.0, 0, 0, 0], values[:, 3:])))
        poses[bad] = np.nan
        return poses

    def values_of(self, poses: FloatArray) -> FloatArray:
        """Positions and quaternions (k, 7) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], matrix_to_quaternion(poses)])

    def external_axes(self, text: str) -> dict[str, float]:
        """eax_a to eax_f that are in use: not 9E9."""
        found = _POSE.search(text)
        values = [] if found is None else [float(group) for group in found.groups()[11:] if group is not None]
        return {f"eax_{letter}": value for letter, value in zip("abcdef", values, strict=False) if value < UNUSED}

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and flags of a robtarget, or of a pose (no flags); `SourceError` when it is neither."""
        found = _POSE.search(text)
        if found is None:
            raise SourceError(f"'{text.strip()}' is no RAPID robtarget: [[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],...]")
        numbers = [None if group is None else float(group) for group in found.groups()]
        position = [n for n in numbers[:3] if n is not None]
        quaternion = [n for n in numbers[3:7] if n is not None]
        length = float(np.linalg.norm(quaternion))
        if abs(length - 1.0) > UNIT_SLACK:
            raise SourceError(f"the orientation in '{found[0]}' has length {length:.4f}, but must have length 1")
        flags = {f: None if n is None else int(n) for f, n in zip(self.fields, numbers[7:11], strict=True)}
        return pose_matrix(position, quaternion_to_matrix(quaternion)), flags


def _outside_quarter(angles: FloatArray, quarter: FloatArray) -> FloatArray:
    """How many degrees angles (k, b, t) lie outside the quarter turn (k,) asked for, inf where that is too far."""
    low = 90.0 * quarter[:, None, None]
    exact = np.floor(settled(angles) / 90.0) == quarter[:, None, None]
    outside = np.maximum(np.maximum(low - angles, angles - (low + 90.0)), LEAST_DEG)
    cost = np.where(exact | np.isnan(low), 0.0, outside)
    return np.where(cost > QUARTER_SLACK_DEG + NOISE, np.inf, cost)


NOTATION: Final = RapidNotation()
