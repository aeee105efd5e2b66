"""FANUC's CONFIG string 'N U T, 0, 0, 0': which posture of the arm a position means, and the text of a position.

F (flip): J5 above zero. U: the elbow is above the line of the stretched arm, D below. T: wrist centre in front of axis
1, B behind it. The digits are the turns of J1, J4 and J6: 0 for angles between -180 and 180, both ends open, 1 from 180
(inclusive) to 540, -1 from -180 (inclusive) downwards. Sources: joint/pose pairs of virtual controllers (CrossArm) and
taught points of public backups; the pair N U T / F U T of an R-2000iB published at onerobotics.com.
"""

import re
from functools import lru_cache
from typing import Final

import numpy as np

from rpl.emulator.configuration import Flags, Selection, format_number
from rpl.emulator.model import RobotModel, Solution
from rpl.emulator.rotations import FloatArray, matrix_to_zyx, pose_matrix, zyx_to_matrix
from rpl.errors import SourceError

FIELDS: Final = ("flip", "down", "back", "t1", "t4", "t6")
BRANCH: Final = ("flip", "down", "back")
TURN_AXES: Final = {"t1": 0, "t4": 3, "t6": 5}
# An angle this close to half a turn counts as exactly half a turn, degrees (measured by CrossArm).
SNAP_DEG: Final = 5e-4
_LISTED: Final = 6

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_COMPONENT = re.compile(rf"\bR?([XYZWPR])\s*[:=]\s*({_NUMBER})", re.IGNORECASE)
_CONFIG = re.compile(
    r"'?\s*([NF])?\s*([LR])?\s*([UD])?\s*([TB])?\s*,\s*(-?\d+)\s*,\s*(-?\d+)\s*,\s*(-?\d+)\s*'?", re.IGNORECASE
)
_LETTERS: Final = {"flip": "NF", "down": "UD", "back": "TB"}


def turn_of(angle: float) -> int:
    """The turn number of an axis at an angle in degrees; half a turn belongs to the outer turn on both sides."""
    nearest = round(angle / 180.0) * 180.0
    if abs(angle - nearest) < SNAP_DEG:
        angle = nearest
    return int((abs(angle) + 180.0) // 360.0) * (1 if angle >= 0.0 else -1)


def parse_config(text: str) -> dict[str, int | None] | None:
    """The flags of a CONFIG text such as `N U T, 0, 0, 0`; None when it is none."""
    flags = _parsed(text)
    return None if flags is None else dict(flags)


@lru_cache(maxsize=1000)
def _parsed(text: str) -> dict[str, int | None] | None:
    found = _CONFIG.search(text)
    if found is None:
        return None
    wrist, _, elbow, shoulder, *turns = found.groups()
    flags: dict[str, int | None] = {}
    for name, letter in zip(BRANCH, (wrist, elbow, shoulder), strict=True):
        flags[name] = None if letter is None else _LETTERS[name].index(letter.upper())
    for name, turn in zip(TURN_AXES, turns, strict=True):
        flags[name] = int(turn)
    return flags


def config_text(flags: Flags) -> str:
    """`N U T, 0, 0, 0`; a flag that is not known is written as the usual posture."""
    letters = " ".join(_LETTERS[name][1 if flags.get(name) else 0] for name in BRANCH)
    turns = ", ".join(str(flags.get(name) or 0) for name in TURN_AXES)
    return f"{letters}, {turns}"


class TpNotation:
    """flip, down, back (0 for N, U, T) and the turns of axes 1, 4 and 6."""

    name: Final = "tp"
    fields: Final = FIELDS

    def encode(self, model: RobotModel, joints: FloatArray) -> dict[str, int]:
        """The flags that the pendant shows at these joints (n,)."""
        posture = model.posture(joints)
        flags = {
            "flip": int(model.axes > 4 and self._flipped(model, joints)),
            "down": int(not posture.elbow_above_stretched),
            "back": int(posture.behind_axis1),
        }
        for name, axis in TURN_AXES.items():
            flags[name] = turn_of(float(joints[axis])) if axis < model.axes else 0
        return flags

    @staticmethod
    def _flipped(model: RobotModel, joints: FloatArray) -> bool:
        """By the pendant's J5 on FANUC's own arms; on another arm by the same posture of the wrist."""
        theta = float(model.theta(joints)[4])
        return theta < -1e-12

    def select(self, model: RobotModel, flange: FloatArray, flags: Flags, reference: FloatArray | None) -> Selection:
        """The solution of a joint move to a Cartesian position: exactly the CONFIG asked for.

        Flags left out (a position register filled element by element) are kept from `reference`.
        """
        solutions = model.inverse(flange, reference)
        if not solutions:
            return Selection(None, "the position is not reachable")
        wanted = dict(flags)
        if reference is not None:
            kept = self.encode(model, reference)
            wanted |= {name: kept[name] for name in BRANCH if wanted.get(name) is None}
        near = model.home if reference is None else reference
        choices = [
            choice
            for solution in solutions
            if self._has_branch(model, solution, wanted)
            for choice in model.expand_turns(solution)
            if self._has_turns(model, choice, wanted)
        ]
        if not choices:
            return Selection(None, self._refusal(model, solutions, wanted))
        return Selection(min(choices, key=lambda joints: float(np.abs(joints - near).max())))

    def _has_branch(self, model: RobotModel, solution: Solution, wanted: Flags) -> bool:
        shown = self.encode(model, solution.joints)
        differing = [name for name in BRANCH if wanted.get(name) is not None and wanted[name] != shown[name]]
        straight = solution.singular and model.axes > 4 and abs(float(solution.joints[4])) < 1e-9
        return not differing or (straight and differing == ["flip"])

    def _has_turns(self, model: RobotModel, joints: FloatArray, wanted: Flags) -> bool:
        return all(
            wanted.get(name) is None or axis >= model.axes or turn_of(float(joints[axis])) == wanted[name]
            for name, axis in TURN_AXES.items()
        )

    def _refusal(self, model: RobotModel, solutions: tuple[Solution, ...], wanted: Flags) -> str:
        shown = [self.encode(model, joints) for solution in solutions for joints in model.expand_turns(solution)]
        shown.sort(key=lambda flags: (sum(abs(flags[name]) for name in TURN_AXES), config_text(flags)))
        possible = list(dict.fromkeys(config_text(flags) for flags in shown))
        asked = config_text(wanted)
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
            parts.insert(0, f"CONFIG : '{config_text(self.encode(model, joints))}'")
        return ", ".join(parts)

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
