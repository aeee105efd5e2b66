"""KRL's Status and Turn: which posture of the arm a POS means, and the text of a POS.

S bit 0: wrist centre behind axis 1. S bit 1: A3 at or above the stretched arm. S bit 2: A5 negative. T bit i: axis i+1
negative by its true angle, so also beyond a half turn (a negative zero is zero). S bit 4 marks a point taught on an
absolutely accurate robot and chooses nothing. Sources: KUKA Expert Programming KSS 5.2, tables 2 and 3; checked against
taught points of real controllers, of which 441 of 445 select exactly one branch by these rules.
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel, Solution
from rpl.emulator.postures import UNKNOWN_BUILD, has_flags, sides
from rpl.emulator.rotations import FloatArray, IntArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.emulator.rounding import NOISE, settled
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError

# The branch bits of S; bit 3 is unused, bit 4 (absolute accuracy) and above have no branch meaning.
BRANCH_BITS: Final = 0b111
WRIST_BIT: Final = 0b100
# The controller does not look at the T bit of an axis that is this close to zero, degrees (about 0.0349 rad).
TURN_IGNORED_DEG: Final = 2.0
# An axis that a singular end point leaves free is moved to zero: $SINGUL_POS is 0 as delivered (KR C2 operating
# handbook, machine data 2.1.151, https://manualshive.com/en/manual/kuka/kr-c2/2009633?page=74).
SINGULAR_AXIS_DEG: Final = 0.0
# No arm reaches further than this.
FARTHEST_MM: Final = 1e5
# X of a point that was declared by an inline form but never taught.
UNTAUGHT_MM: Final = 666666.688

_AGGREGATE = re.compile(r"\{\s*(?:(?P<type>[A-Za-z_]\w*)\s*:)?(?P<body>[^{}]*)\}")
_COMPONENT = re.compile(
    r"\s*(?P<name>[A-Za-z_]\w*)\s+(?P<value>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|'[BbHh][0-9A-Fa-f]+')\s*"
)
_EXTERNAL = re.compile(r"E[1-6]")
_AXES: Final = ("X", "Y", "Z", "A", "B", "C")


class KrlNotation:
    """S and T."""

    name: Final = "krl"
    fields: Final = ("s", "t")
    pose_fields: Final = ("x", "y", "z", "a", "b", "c")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """S and T that the controller shows at these joints (n,)."""
        status, turn = self.encode_all(model, joints[None])[0]
        return {"s": int(status), "t": int(turn)}

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """S and T (k, 2) at joints (k, n)."""
        turn = ((settled(joints) < 0.0) * (1 << np.arange(model.axes))).sum(axis=-1)
        return np.stack([_status(sides(model, joints)), turn], axis=-1)

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a PTP to a POS: S chooses the branch, T the revolution of each axis.

        Without S the status of `reference` is kept, without T each axis takes its shortest way from there; with neither
        a reference nor the flag there is no answer, as for the first motion of a program.
        """
        status, turn = flags.get("s"), flags.get("t")
        if reference is None and (status is None or turn is None):
            return Selection(None, "the first motion needs both S and T")
        if abs(float(flange[0, 3])) > FARTHEST_MM:
            return Selection(None, "the point is not taught" if is_untaught(flange) else "the pose is out of reach")
        found = self.select_all(model, flange[None], flag_row(self.fields, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the pose is out of reach")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        if status is None and reference is not None:
            status = self.encode(model, reference)["s"]
        if not has_flags(model):
            return Selection(None, UNKNOWN_BUILD)
        possible = model.inverse(flange, reference)
        return Selection(None, self._refusal(model, possible, (status or 0) & BRANCH_BITS, turn))

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 2); a point not taught is not reachable."""
        near = joints_before(model, reference, len(flanges))
        status, turn = flags.T
        if reference is not None and np.isnan(status).any():
            kept = self.encode_all(model, near)[:, 0]
            status = np.where(np.isnan(status), kept, status)
        missing = np.isnan(status) | (np.isnan(turn) & (reference is None))
        missing |= np.abs(flanges[:, 0, 3]) > FARTHEST_MM
        wanted = np.nan_to_num(status).astype(np.int64) & BRANCH_BITS
        bits = np.nan_to_num(turn).astype(np.int64)
        open_turn = np.isnan(turn)

        def fits(found: Candidates) -> BoolArray:
            differing = _status(found.sides)[None] ^ wanted[:, None]
            met = (differing == 0) | (found.straight & (differing == WRIST_BIT))
            return np.asarray(met & ~missing[:, None])

        def turn_cost(axis: int, values: FloatArray) -> FloatArray:
            negative = (bits >> axis & 1).astype(np.bool_)[:, None, None]
            met = ((values < 0.0) == negative) | (np.abs(values) <= TURN_IGNORED_DEG + NOISE) | open_turn[:, None, None]
            return np.where(met, 0.0, np.inf)

        free = np.full(model.axes, SINGULAR_AXIS_DEG)
        return choose(model, flanges, near, Rule(fits, turn_cost, free, half_turned=False))

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

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of X, Y, Z, A, B, C (k, 6)."""
        return pose_matrix(values[:, :3], zyx_to_matrix(values[:, 3:]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """X, Y, Z, A, B, C (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], matrix_to_zyx(poses)])

    def external_axes(self, text: str) -> dict[str, float]:
        """E1 to E6 that are not zero: every E6POS has all six."""
        found = _AGGREGATE.search(text)
        parts = map(_COMPONENT.fullmatch, found["body"].split(",")) if found is not None else ()
        values = {part["name"].upper(): _number(part["value"]) for part in parts if part is not None}
        return {name: value for name, value in values.items() if _EXTERNAL.fullmatch(name) and value != 0.0}

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


def _status(branch: IntArray) -> IntArray:
    """S (...) of shoulder, elbow and wrist (..., 3)."""
    return np.asarray(branch @ np.array([1, -2, 4]) + 2)


def _number(text: str) -> float:
    if text.startswith("'"):
        return float(int(text[2:-1], 2 if text[1] in "Bb" else 16))
    return float(text)


def is_untaught(matrix: FloatArray) -> bool:
    """Is this the placeholder of a point that was never taught?"""
    return bool(abs(float(matrix[0, 3]) - UNTAUGHT_MM) < 0.01)


NOTATION: Final = KrlNotation()
