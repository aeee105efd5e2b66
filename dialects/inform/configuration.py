"""RCONF: which posture of the arm a Cartesian point means, and the text of such a point.

Six flags, 1 meaning: no-flip, lower arm, rear, and R, T, S beyond 180 degrees (NX100 and DX100 data transmission
manuals). `RCONF` lines of newer controllers have 8 or 24 fields, the rest unused by six-axis arms.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from rpl.emulator.configuration import Flags, Selection, format_number
from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.errors import SourceError

from .rules import FIELDS

# M: what decides about flip. `b`: the sign of B (no-flip: B negative), as the points of newer jobs show it.
# `r`: R between -90 and 90 degrees is flip (NX100 operator's manual).
FLIP_BY = "b"
TURN_AXES: Final = {"r180": 3, "t180": 5, "s180": 0}

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_POINT = re.compile(
    rf"(?:\w+\s*=\s*)?({_NUMBER}(?:\s*,\s*{_NUMBER}){{5,}})\s*(?:;?\s*RCONF\s+([\d,\s]+))?", re.IGNORECASE
)


def is_flip(joints: FloatArray, by: str = FLIP_BY) -> bool:
    """Flip by the sign of B, or by the quadrant of R."""
    if by == "b":
        return float(joints[4] + 180.0) % 360.0 >= 180.0  # arms whose wrist turns further: the sign within half a turn
    turned = float(joints[3]) % 360.0
    return turned <= 90.0 or turned > 270.0


class InformNotation:
    """noflip, lower, rear, r180, t180, s180."""

    name: Final = "inform"
    fields: Final = FIELDS

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The RCONF fields that the controller shows at these joints (n,)."""
        posture = model.posture(joints)
        # M: upper and lower arm as seen from outside, so that a rear posture mirrors them.
        flags = {
            "noflip": int(model.axes > 4 and not is_flip(joints)),
            "lower": int(posture.behind_lower_arm != posture.behind_axis1),
            "rear": int(posture.behind_axis1),
        }
        for name, axis in TURN_AXES.items():
            angle = float(joints[axis]) if axis < model.axes else 0.0
            flags[name] = int(not -180.0 < angle <= 180.0)
        return flags

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a joint move: each given flag must be met; those left out stay as at `reference`."""
        solutions = model.inverse(flange, reference)
        if not solutions:
            return Selection(None, "the position is out of reach")
        near = model.home if reference is None else reference
        now = self.encode(model, near) if reference is not None else {}
        wanted = {name: flags.get(name) for name in self.fields}
        for name in ("noflip", "lower", "rear"):
            if wanted[name] is None:
                wanted[name] = now.get(name)
        choices: list[FloatArray] = []
        shown: set[tuple[int, ...]] = set()
        for solution in solutions:
            straight = solution.singular and model.axes > 4 and solution.joints[4] == 0.0
            for joints in model.expand_turns(solution):
                found = self.encode(model, joints)
                shown.add(tuple(found.values()))
                differing = [name for name, flag in wanted.items() if flag is not None and found[name] != flag]
                if not differing or (straight and differing == ["noflip"]):
                    choices.append(joints)
        if choices:
            return Selection(min(choices, key=lambda joints: float(np.abs(joints - near).max())))
        asked = ",".join("-" if flags.get(name) is None else str(flags[name]) for name in self.fields)
        if not shown:
            return Selection(None, f"RCONF {asked} cannot be reached: every solution exceeds a joint limit")
        listed = "; ".join(",".join(map(str, each)) for each in sorted(shown))
        return Selection(None, f"RCONF {asked} cannot be reached: the arm reaches this position with {listed}")

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`x,y,z,Rx,Ry,Rz`, and with joints ` RCONF ...` behind it."""
        rz, ry, rx = matrix_to_zyx(matrix)
        values = [format_number(float(value), 6) for value in (*matrix[:3, 3], rx, ry, rz)]
        text = ",".join(values)
        if joints is None:
            return text
        return f"{text} RCONF {','.join(str(flag) for flag in self.encode(model, joints).values())}"

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and flags of `[C00001=]x,y,z,Rx,Ry,Rz [RCONF l,m,n,o,p,q]`; `SourceError` when it is none."""
        found = _POINT.search(text)
        if found is None:
            raise SourceError(f"'{text.strip()}' is no INFORM position: x,y,z,Rx,Ry,Rz RCONF l,m,n,o,p,q")
        x, y, z, rx, ry, rz = (float(part) for part in found[1].split(",")[:6])
        flags: dict[str, int | None] = dict.fromkeys(self.fields)
        if found[2] is not None:
            given = [part.strip() for part in found[2].split(",")]
            for name, part in zip(self.fields, given, strict=False):
                flags[name] = int(part) if part else None
        return pose_matrix([x, y, z], zyx_to_matrix([rz, ry, rx])), flags


NOTATION: Final = InformNotation()
