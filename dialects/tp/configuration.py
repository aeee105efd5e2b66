"""FANUC's CONFIG string 'N U T, 0, 0, 0': which posture of the arm a position means, and the text of a position.

F (flip): J5 above zero. U: the elbow is above the line of the stretched arm, D below. T: wrist centre in front of axis
1, B behind it. The digits are the turns of J1, J4 and J6: 0 for angles between -180 and 180, both ends open, 1 from 180
(inclusive) to 540, -1 from -180 (inclusive) downwards. A SCARA has R or L alone (M: R is joint 2 positive). Sources:
joint/pose pairs of virtual controllers (CrossArm) and taught points of public backups; the pair N U T / F U T of an
R-2000iB published at onerobotics.com.
"""

import re
from typing import Final

import numpy as np

from rpl.emulator.arms import BoolArray
from rpl.emulator.configuration import Flags, Selection, flag_row, format_number
from rpl.emulator.model import RobotModel, Solution
from rpl.emulator.postures import UNKNOWN_BUILD, has_flags, sides
from rpl.emulator.rotations import FloatArray, IntArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.emulator.selection import Candidates, Chosen, Rule, choose, joints_before
from rpl.errors import SourceError

from .configtext import BRANCH, FIELDS, TURN_AXES, config_text, parse_config

# An angle this close to half a turn counts as exactly half a turn, degrees (measured by CrossArm).
SNAP_DEG: Final = 5e-4
# A wrist this close to straight is not flipped: rounding in double precision, degrees.
ON_LINE_DEG: Final = 1e-10
WRIST_AXIS: Final = 4
# M: three printed decimals of W, P and R leave an axis uncertain by this much, degrees.
ROUNDED_DEG: Final = 2e-3
_LISTED: Final = 6

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_COMPONENT = re.compile(rf"\bR?([XYZWPR])\s*[:=]\s*({_NUMBER})", re.IGNORECASE)
_EXTENDED = re.compile(rf"\bE([1-3])\s*=\s*({_NUMBER})", re.IGNORECASE)


def turns_of(angles: FloatArray) -> FloatArray:
    """The turn numbers of an axis at angles in degrees; half a turn belongs to the outer turn on both sides."""
    halves = np.round(angles / 180.0) * 180.0
    angle = np.where(np.abs(angles - halves) < SNAP_DEG, halves, angles)
    return np.asarray(np.floor((np.abs(angle) + 180.0) / 360.0) * np.sign(angle))


def _outside_turn(angles: FloatArray, turn: FloatArray) -> FloatArray:
    """0 where angles are in the turn asked for, little where rounding alone may have brought them out, else inf."""
    near = np.where(turns_of(angles + ROUNDED_DEG) == turn, ROUNDED_DEG, np.inf)
    near = np.where(turns_of(angles - ROUNDED_DEG) == turn, ROUNDED_DEG, near)
    halves = np.abs(np.remainder(angles, 360.0) - 180.0) < SNAP_DEG
    return np.where(turns_of(angles) == turn, 0.0, np.where(halves, np.inf, near))


def _flipped(model: RobotModel, angles: FloatArray) -> BoolArray:
    """By the pendant's J5 on FANUC's own arms; on another arm by the same posture of the wrist."""
    theta = angles * model.pendant_to_arm[WRIST_AXIS, WRIST_AXIS] - model.offsets[WRIST_AXIS]
    return np.asarray(theta < -ON_LINE_DEG)


class TpNotation:
    """flip, down, back (0 for N, U, T) and the turns of axes 1, 4 and 6."""

    name: Final = "tp"
    fields: Final = FIELDS
    pose_fields: Final = ("x", "y", "z", "w", "p", "r")

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The flags that the pendant shows at these joints (n,)."""
        return dict(zip(FIELDS, map(int, self.encode_all(model, joints[None])[0]), strict=True))

    def encode_all(self, model: RobotModel, joints: FloatArray) -> IntArray:
        """Flags (k, 6) at joints (k, n)."""
        branch = sides(model, joints)
        flags = np.zeros((len(joints), 6), dtype=np.int64)
        if model.axes > 4:
            flags[:, 0] = _flipped(model, joints[:, 4])
        flags[:, 1], flags[:, 2] = branch[:, 1], branch[:, 0]
        for place, axis in enumerate(TURN_AXES.values(), start=3):
            if axis < model.axes:
                flags[:, place] = turns_of(joints[:, axis])
        return flags

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a joint move to a Cartesian position: exactly the CONFIG asked for.

        Flags left out (a position register filled element by element) are kept from `reference`.
        """
        found = self.select_all(model, flange[None], flag_row(FIELDS, flags), reference)
        if not found.reachable[0]:
            return Selection(None, "the position is not reachable")
        if not np.isnan(found.joints[0, 0]):
            return Selection(found.joints[0])
        if not has_flags(model):
            return Selection(None, UNKNOWN_BUILD)
        wanted = dict(flags)
        if reference is not None:
            kept = self.encode(model, reference)
            wanted |= {name: kept[name] for name in BRANCH if wanted.get(name) is None}
        return Selection(None, self._refusal(model, model.inverse(flange, reference), wanted))

    def select_all(
        self, model: RobotModel, flanges: FloatArray, flags: FloatArray, reference: FloatArray | None
    ) -> Chosen:
        """As `select`, for flange poses (k, 4, 4) and flags (k, 6)."""
        near = joints_before(model, reference, len(flanges))
        wanted = flags.copy()
        if reference is not None and np.isnan(wanted[:, :3]).any():
            wanted[:, :3] = np.where(np.isnan(wanted[:, :3]), self.encode_all(model, near)[:, :3], wanted[:, :3])
        flip, down, back = (wanted[:, place, None] for place in range(3))
        absent = [3 + place for place, axis in enumerate(TURN_AXES.values()) if axis >= model.axes]
        turned = np.asarray(np.nan_to_num(wanted[:, absent]).any(axis=1))[:, None]  # turns of axes that it has not

        def fits(found: Candidates) -> BoolArray:
            shoulder, elbow = found.sides[None, :, 0], found.sides[None, :, 1]
            met = (np.isnan(back) | (shoulder == back)) & (np.isnan(down) | (elbow == down))
            return np.asarray(met & ~turned)

        def turn_cost(axis: int, values: FloatArray) -> FloatArray | None:
            if axis == WRIST_AXIS and model.axes > 4:
                asked, shown = flip[:, :, None], _flipped(model, values)
                met = np.isnan(asked) | (shown == asked) | (values == 0.0)
            elif axis in TURN_AXES.values():
                asked = wanted[:, 3 + list(TURN_AXES.values()).index(axis), None, None]
                return np.where(np.isnan(asked), 0.0, _outside_turn(values, asked))
            else:
                return None
            return np.where(met, 0.0, np.inf)

        return choose(model, flanges, near, Rule(fits, turn_cost, near))

    def _refusal(self, model: RobotModel, solutions: tuple[Solution, ...], wanted: Flags) -> str:
        shown = [self.encode(model, joints) for solution in solutions for joints in model.expand_turns(solution)]
        flat = model.kind == "scara"
        shown.sort(key=lambda flags: (sum(abs(flags[name]) for name in TURN_AXES), config_text(flags)))
        possible = list(dict.fromkeys(config_text(flags, flat) for flags in shown))
        asked = config_text(wanted, flat)
        if not possible:
            return f"'{asked}' cannot be reached: every solution exceeds a joint limit"
        listed = "; ".join(f"'{text}'" for text in possible[:_LISTED]) + (" ..." if len(possible) > _LISTED else "")
        return f"'{asked}' cannot be reached: the arm reaches this position with {listed}"

    def format_pose(self, model: RobotModel, matrix: FloatArray, joints: FloatArray | None) -> str:
        """`CONFIG : 'N U T, 0, 0, 0', X = 1 mm, Y = 2 mm, ...`; without joints no CONFIG."""
        r, p, w = matrix_to_zyx(matrix)
        values = (*matrix[:3, 3], w, p, r)
        parts = [
            f"{name} = {format_number(float(value), 6)} {unit}"
            for name, value, unit in zip("XYZWPR", values, ("mm",) * 3 + ("deg",) * 3, strict=True)
        ]
        if joints is not None:
            parts.insert(0, f"CONFIG : '{config_text(self.encode(model, joints), model.kind == 'scara')}'")
        return ", ".join(parts)

    def poses_of(self, values: FloatArray) -> FloatArray:
        """Poses (k, 4, 4) of X, Y, Z, W, P, R (k, 6)."""
        return pose_matrix(values[:, :3], zyx_to_matrix(values[:, :2:-1]))

    def values_of(self, poses: FloatArray) -> FloatArray:
        """X, Y, Z, W, P, R (k, 6) of poses (k, 4, 4)."""
        return np.hstack([poses[:, :3, 3], matrix_to_zyx(poses)[:, ::-1]])

    def external_axes(self, text: str) -> dict[str, float]:
        """E1 to E3 of a position with an extended axis."""
        return {f"E{number}": float(value) for number, value in _EXTENDED.findall(text)}

    def parse_flags(self, text: str) -> dict[str, int | None] | None:
        """The flags of a CONFIG text."""
        return parse_config(text)

    def parse_pose(self, text: str) -> tuple[FloatArray, dict[str, int | None]]:
        """Pose and flags of a Cartesian position; `SourceError` when it is none."""
        quoted = re.search(r"'([^']*)'", text)
        flags = parse_config(quoted[1] if quoted else text.partition("=")[0])
        rest = text.replace(quoted[0], " ") if quoted else text
        values = {name.upper(): float(number) for name, number in _COMPONENT.findall(rest)}
        missing = [name for name in "XYZWPR" if name not in values]
        if missing:
            raise SourceError(
                f"'{text.strip()}' is no FANUC position, it lacks {', '.join(missing)}: "
                "expected CONFIG : 'N U T, 0, 0, 0', X = .. mm, Y = .., Z = .., W = .. deg, P = .., R = .."
            )
        x, y, z, w, p, r = (values[name] for name in "XYZWPR")
        none: dict[str, int | None] = dict.fromkeys(FIELDS)
        return pose_matrix([x, y, z], zyx_to_matrix([r, p, w])), flags if flags is not None else none


NOTATION: Final = TpNotation()
