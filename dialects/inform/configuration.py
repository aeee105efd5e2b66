"""RCONF: which posture of the arm a Cartesian point means, and the text of such a point.

Six flags, 1 meaning: no-flip, lower arm, rear, and R, T, S beyond 180 degrees (NX100 and DX100 data transmission
manuals). `RCONF` lines of newer controllers have 8 or 24 fields, the rest unused by six-axis arms.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.postures import UNKNOWN_BUILD, has_flags, sides
from rpl.emulator.rotations import FloatArray, IntArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.emulator.rounding import settled
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError

from . import tables

# M: what decides about flip. `b`: the sign of B (no-flip: B negative), as the points of newer jobs show it.
# `r`: R between -90 and 90 degrees is flip (NX100 operator's manual).
FLIP_BY = "b"
# M: what is so close to half a turn counts as just that, degrees.
ROUNDED_DEG: Final = 5e-4
TURN_AXES: Final = {"r180": 3, "t180": 5, "s180": 0}

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_POINT = re.compile(
    rf"(?:\w+\s*=\s*)?({_NUMBER}(?:\s*,\s*{_NUMBER}){{5,}})\s*(?:;?\s*RCONF\s+([\d,\s]+))?", re.IGNORECASE
)


def is_flip(joints: FloatArray, by: str = FLIP_BY) -> BoolArray:
    """Flip (...) of joints (..., n) by the sign of B, or by the quadrant of R."""
    if by == "b":  # arms whose wrist turns further: the sign within half a turn
        return np.asarray((settled(joints[..., 4]) + 180.0) % 360.0 >= 180.0)
    turned = settled(joints[..., 3]) % 360.0
    return np.asarray((turned <= 90.0) | (turned > 270.0))


def _branch_flags(model: RobotModel, branch: IntArray, joints: FloatArray) -> IntArray:
    """No-flip, lower and rear (..., 3) of sides (..., 3) and joints (..., n)."""
    noflip = ~is_flip(joints) if model.axes > 4 else np.zeros(branch.shape[:-1], dtype=np.bool_)
    # M: upper and lower arm as seen from outside, so that a rear posture mirrors them.
    return np.stack([noflip, branch[..., 1] ^ branch[..., 0], branch[..., 0]], axis=-1).astype(np.int64)


def _beyond(angles: FloatArray) -> BoolArray:
    """Whether angles lie outside of (-180, 180]; half a turn within rounding is half a turn."""
    return ~((angles > -180.0 + ROUNDED_DEG) & (angles <= 180.0 + ROUNDED_DEG))


class InformNotation:
    """noflip, lower, rear, r180, t180, s180."""

    name: Final = "inform"
    fields: Final = tables.POSTURE
    pose_fields: Final = ("x", "y", "z", "rx", "ry", "rz")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The RCONF fields that the controller shows at these joints (n,)."""
        return dict(zip(self.fields, map(int, self.encode_all(model, joints[None])[0]), strict=True))

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """RCONF fields (k, 6) at joints (k, n)."""
        flags = np.zeros((len(joints), 6), dtype=np.int64)
        flags[:, :3] = _branch_flags(model, sides(model, joints), joints)
        for place, axis in enumerate(TURN_AXES.values(), start=3):
            if axis < model.axes:
                flags[:, place] = _beyond(joints[:, axis])
        return flags

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a joint move: each given flag must be met; those left out stay as at `reference`."""
        found = self.select_all(model, flange[None], flag_row(self.fields, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the position is out of reach")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        if not has_flags(model):
            return Selection(None, UNKNOWN_BUILD)
        asked = ",".join("-" if flags.get(name) is None else str(flags[name]) for name in self.fields)
        shown = {
            tuple(self.encode(model, joints).values())
            for solution in model.inverse(flange, reference)
            for joints in model.expand_turns(solution)
        }
        if not shown:
            return Selection(None, f"RCONF {asked} cannot be reached: every solution exceeds a joint limit")
        listed = "; ".join(",".join(map(str, each)) for each in sorted(shown))
        return Selection(None, f"RCONF {asked} cannot be reached: the arm reaches this position with {listed}")

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 6)."""
        near = joints_before(model, reference, len(flanges))
        wanted = flags.copy()
        if reference is not None and np.isnan(wanted[:, :3]).any():
            wanted[:, :3] = np.where(np.isnan(wanted[:, :3]), self.encode_all(model, near)[:, :3], wanted[:, :3])

        def fits(found: Candidates) -> BoolArray:
            branch = np.broadcast_to(found.sides, (*found.valid.shape, 3))
            asked = wanted[:, None, :3]
            met = np.isnan(asked) | (_branch_flags(model, branch, found.joints) == asked)
            met[..., 0] |= found.straight
            return np.asarray(met.all(axis=-1))

        def turn_cost(axis: int, values: FloatArray) -> FloatArray | None:
            if axis not in TURN_AXES.values():
                return None
            asked = wanted[:, 3 + list(TURN_AXES.values()).index(axis), None, None]
            return np.where(np.isnan(asked) | (_beyond(values) == asked), 0.0, np.inf)

        return choose(model, flanges, near, Rule(fits, turn_cost, near))

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`x,y,z,Rx,Ry,Rz`, and with joints ` RCONF ...` behind it."""
        rz, ry, rx = matrix_to_zyx(matrix)
        values = [format_number(float(value), 6) for value in (*matrix[:3, 3], rx, ry, rz)]
        text = ",".join(values)
        if joints is None:
            return text
        return f"{text} RCONF {','.join(str(flag) for flag in self.encode(model, joints).values())}"

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of x, y, z, Rx, Ry, Rz (k, 6)."""
        return pose_matrix(values[:, :3], zyx_to_matrix(values[:, :2:-1]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """x, y, z, Rx, Ry, Rz (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], matrix_to_zyx(poses)[:, ::-1]])

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and flags of `[C00001=]x,y,z,Rx,Ry,Rz [RCONF l,m,n,o,p,q]`; `SourceError` when it is none."""
        found = _POINT.search(text)
        if found is None:
            raise SourceError(f"'{text.strip()}' is no INFORM position: x,y,z,Rx,Ry,Rz RCONF l,m,n,o,p,q")
        x, y, z, rx, ry, rz = (float(part) for part in found[1].split(",")[:6])
        flags: dict[str, int | None] = dict.fromkeys(self.fields)
        if found[2] is not None:
            given = [part.strip() for part in found[2].split(",")]
            if any(part.strip("0") for part in given[len(self.fields) :]):
                raise SourceError(f"'RCONF {found[2].strip()}' is of an arm of more than six axes: {UNKNOWN_BUILD}")
            for name, part in zip(self.fields, given, strict=False):
                flags[name] = int(part) if part else None
        return pose_matrix([x, y, z], zyx_to_matrix([rz, ry, rx])), flags


NOTATION: Final = InformNotation()
