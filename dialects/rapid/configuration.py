"""RAPID's confdata: which posture of the arm a robtarget means, and the text of a robtarget.

cf1, cf4 and cf6 are the quarter turns of axes 1, 4 and 6, floor(angle / 90) by strict signs: -0.00018 degrees is
quarter -1, exactly 90 is quarter 1. cfx = 4 (wrist centre behind axis 1) + 2 (wrist centre beyond the line through axes
2 and 3) + 1 (axis 5 negative). Sources: RAPID system data types, confdata and ConfJ; checked against `CalcRobT` of a
virtual controller (IRB 6700), where the elbow bit flips at -atan2(forearm, elbow offset).
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.configuration import Flags, Selection, format_number
from rpl.emulator.model import RobotModel, Solution
from rpl.emulator.rotations import FloatArray, matrix_to_quaternion, pose_matrix, quaternion_to_matrix
from rpl.errors import SourceError

# With ConfJ \On an axis may lie this far outside its quarter turn and still counts as being in it, degrees.
QUARTER_SLACK_DEG: Final = 45.0
# Arms whose parallelogram leaves no choice: their controller does not use cfx.
CFX_UNUSED: Final = frozenset({"abb_irb2400"})
QUARTERS: Final = {"cf1": 0, "cf4": 3, "cf6": 5}
# A quaternion may be off unit length by the rounding of four printed decimals, not more.
UNIT_SLACK: Final = 0.01

_NUMBER = r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*"
_LIST3 = r"\[" + ",".join([_NUMBER] * 3) + r"\]"
_LIST4 = r"\[" + ",".join([_NUMBER] * 4) + r"\]"
_LIST6 = r"\[" + ",".join([_NUMBER] * 6) + r"\]"
_POSE = re.compile(rf"\[\s*{_LIST3}\s*,\s*{_LIST4}\s*(?:,\s*{_LIST4}\s*(?:,\s*{_LIST6}\s*)?)?\]")


class RapidNotation:
    """cf1, cf4, cf6, cfx."""

    name: Final = "rapid"
    fields: Final = ("cf1", "cf4", "cf6", "cfx")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The confdata that the controller shows at these joints (n,)."""
        flags = {
            name: int(np.floor(joints[axis] / 90.0)) if axis < model.axes else 0 for name, axis in QUARTERS.items()
        }
        posture = model.posture(joints)
        cfx = 4 * posture.behind_axis1 + 2 * posture.behind_lower_arm + posture.wrist_negative
        return {**flags, "cfx": 0 if model.name in CFX_UNUSED else cfx}

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a MoveJ to a robtarget.

        Given flags (ConfJ \\On) must be met: cfx exactly, each quarter turn within 45 degrees, an exact one preferred.
        Missing flags (ConfJ \\Off) keep the main-arm configuration of `reference` and take the nearest revolution.
        """
        solutions = model.inverse(flange, reference)
        if not solutions:
            return Selection(None, "the position is outside the reach")
        near = model.home if reference is None else reference
        best: tuple[float, float] = (np.inf, np.inf)
        joints: FloatArray | None = None
        for solution in solutions:
            if not self._has_main_configuration(model, solution, flags, reference):
                continue
            for choice in model.expand_turns(solution):
                outside = _outside_quarters(model, choice, flags)
                rank = (outside, float(np.linalg.norm((choice - near) / model.speeds)))
                if outside <= QUARTER_SLACK_DEG and rank < best:
                    best, joints = rank, choice
        return Selection(joints) if joints is not None else Selection(None, self._refusal(model, solutions, flags))

    def _has_main_configuration(
        self, model: RobotModel, solution: Solution, flags: Flags, reference: FloatArray | None
    ) -> bool:
        wanted = flags.get("cfx")
        if model.name in CFX_UNUSED:
            return True
        if wanted is None:
            if reference is None:
                return True
            now, then = model.posture(reference).branch, model.posture(solution.joints).branch
            return (now.shoulder, now.elbow) == (then.shoulder, then.elbow)
        differing = self.encode(model, solution.joints)["cfx"] ^ wanted
        straight = solution.singular and model.axes > 4 and solution.joints[4] == 0.0
        return differing == 0 or (straight and differing == 1)

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


def _outside_quarters(model: RobotModel, joints: FloatArray, flags: Flags) -> float:
    """How many degrees the worst axis lies outside the quarter turn asked of it; 0 when all are inside."""
    worst = 0.0
    for name, axis in QUARTERS.items():
        quarter = flags.get(name)
        if quarter is None or axis >= model.axes:
            continue
        angle = float(joints[axis])
        if int(np.floor(angle / 90.0)) != quarter:
            low = 90.0 * quarter
            worst = max(worst, low - angle, angle - (low + 90.0), 1e-12)
    return worst


NOTATION: Final = RapidNotation()
