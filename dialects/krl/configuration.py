"""KRL's Status and Turn: which posture of the arm a POS means, and the text of a POS.

S bit 0: wrist centre behind axis 1. S bit 1: A3 at or above the stretched arm. S bit 2: A5 negative. T bit i: axis i+1
negative by its true angle, so also beyond a half turn (a negative zero is zero). S bit 4 marks a point taught on an
absolutely accurate robot and chooses nothing. Sources: KUKA Expert Programming KSS 5.2, tables 2 and 3; checked against
taught points of real controllers, of which 441 of 445 select exactly one branch by these rules.
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.configuration import Flags, Selection, format_number
from rpl.emulator.model import RobotModel, Solution
from rpl.emulator.rotations import FloatArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.errors import SourceError

# The branch bits of S; bit 3 is unused, bit 4 (absolute accuracy) and above have no branch meaning.
BRANCH_BITS: Final = 0b111
WRIST_BIT: Final = 0b100
# The controller does not look at the T bit of an axis that is this close to zero, degrees (about 0.0349 rad).
TURN_IGNORED_DEG: Final = 2.0
# X of a point that was declared by an inline form but never taught.
UNTAUGHT_MM: Final = 666666.688

_AGGREGATE = re.compile(r"\{\s*(?:(?P<type>[A-Za-z_]\w*)\s*:)?(?P<body>[^{}]*)\}")
_COMPONENT = re.compile(
    r"\s*(?P<name>[A-Za-z_]\w*)\s+(?P<value>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|'[BbHh][0-9A-Fa-f]+')\s*"
)
_AXES: Final = ("X", "Y", "Z", "A", "B", "C")


class KrlNotation:
    """S and T."""

    name: Final = "krl"
    fields: Final = ("s", "t")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """S and T that the controller shows at these joints (n,)."""
        posture = model.posture(joints)
        status = posture.behind_axis1 + 2 * posture.elbow_above_stretched + 4 * posture.wrist_negative
        turn = sum(1 << axis for axis, angle in enumerate(joints) if angle < 0.0)
        return {"s": status, "t": turn}

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a PTP to a POS: S chooses the branch, T the revolution of each axis.

        Without S the status of `reference` is kept, without T each axis takes its shortest way from there; with neither
        a reference nor the flag there is no answer, as for the first motion of a program.
        """
        status, turn = flags.get("s"), flags.get("t")
        if reference is None and (status is None or turn is None):
            return Selection(None, "the first motion needs both S and T")
        if abs(float(flange[0, 3])) > 1e5:
            return Selection(None, "the point is not taught" if is_untaught(flange) else "the pose is out of reach")
        solutions = model.inverse(flange, reference)
        if not solutions:
            return Selection(None, "the pose is out of reach")
        if status is None and reference is not None:
            status = self.encode(model, reference)["s"]
        wanted = (status or 0) & BRANCH_BITS
        chosen = [s for s in solutions if self._has_status(model, s, wanted)]
        choices = [c for s in chosen for c in (self._turned(model, s, turn, reference),) if c is not None]
        if choices:
            near = model.home if reference is None else reference
            return Selection(min(choices, key=lambda c: float(np.abs(c - near).max())))
        return Selection(None, self._refusal(model, solutions, wanted, turn))

    def _has_status(self, model: RobotModel, solution: Solution, wanted: int) -> bool:
        differing = self.encode(model, solution.joints)["s"] ^ wanted
        straight = solution.singular and model.axes > 4 and solution.joints[4] == 0.0
        return differing == 0 or (straight and differing == WRIST_BIT)

    def _turned(
        self, model: RobotModel, solution: Solution, turn: int | None, reference: FloatArray | None
    ) -> FloatArray | None:
        """The revolution of each axis that T asks for; None when the limits leave none."""
        if turn is None and reference is not None:
            joints = model.nearest_turn(solution.joints, reference)
            return None if model.within_limits(joints) else joints
        wanted = np.array([bool((turn or 0) >> axis & 1) for axis in range(model.axes)])
        choices = model.expand_turns(solution)
        fits = ((choices < 0.0) == wanted) | (np.abs(choices) <= TURN_IGNORED_DEG)
        choices = choices[fits.all(axis=1)]
        if len(choices) == 0:
            return None
        near = np.zeros(model.axes) if reference is None else reference
        return np.asarray(choices[np.argmin(np.abs(choices - near).sum(axis=1))])

    def _refusal(self, model: RobotModel, solutions: tuple[Solution, ...], status: int, turn: int | None) -> str:
        possible = set()
        for solution in solutions:
            for joints in model.expand_turns(solution):
                flags = self.encode(model, joints)
                possible.add((flags["s"], flags["t"]))
        asked = f"S {status}" + ("" if turn is None else f", T {turn}")
        if not possible:
            return f"{asked} cannot be reached: every solution exceeds a joint limit"
        listed = "; ".join(f"S {s}, T {t}" for s, t in sorted(possible))
        return f"{asked} cannot be reached: the arm reaches this pose with {listed}"

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`{X 1,Y 2,Z 3,A 4,B 5,C 6,S 2,T 35}`; without joints no S and T."""
        values = [*matrix[:3, 3], *matrix_to_zyx(matrix)]
        parts = [f"{axis} {format_number(float(value), 6)}" for axis, value in zip(_AXES, values, strict=True)]
        if joints is not None:
            flags = self.encode(model, joints)
            parts += [f"S {flags['s']}", f"T {flags['t']}"]
        return "{" + ",".join(parts) + "}"

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and flags of a FRAME, POS or E6POS; external axes are read over. `SourceError` when it is none."""
        found = _AGGREGATE.search(text)
        if found is None:
            raise SourceError(f"'{text.strip()}' is no KRL pose: expected {{X ..,Y ..,Z ..,A ..,B ..,C ..,S ..,T ..}}")
        values: dict[str, float] = {}
        for part in found["body"].split(","):
            component = _COMPONENT.fullmatch(part)
            if component is None:
                raise SourceError(f"'{part.strip()}' is no component of a KRL pose")
            values[component["name"].upper()] = _number(component["value"])
        missing = [axis for axis in _AXES if axis not in values]
        if missing:
            raise SourceError(f"the KRL pose {found[0]} lacks {', '.join(missing)}")
        x, y, z, a, b, c = (values[axis] for axis in _AXES)
        flags = {key.lower(): int(values[key]) if key in values else None for key in ("S", "T")}
        return pose_matrix([x, y, z], zyx_to_matrix([a, b, c])), flags


def _number(text: str) -> float:
    if text.startswith("'"):
        return float(int(text[2:-1], 2 if text[1] in "Bb" else 16))
    return float(text)


def is_untaught(matrix: FloatArray) -> bool:
    """Is this the placeholder of a point that was never taught?"""
    return bool(abs(float(matrix[0, 3]) - UNTAUGHT_MM) < 0.01)


NOTATION: Final = KrlNotation()
