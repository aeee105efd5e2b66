"""Literals of URScript: numbers in its units, poses as metres and rotation vectors, texts in ASCII.

Constants are folded so that they read back within half a unit of the last place written; what is not zero never
becomes zero. R = exp([r]): the rotation vector is the axis times the angle in radians.
"""

from __future__ import annotations

import math
import re
import unicodedata
from decimal import Decimal

from rpl.passes import rigid
from rpl.writing.text import NumberStyle, number_text

_PLAIN = NumberStyle(smallest_plain=1e-6, exponent="E")
_POINT = NumberStyle(always_point=True, smallest_plain=1e-6, exponent="E")
_REAL = re.compile(r"\d+\.\d+(?:[eE][+-]?\d+)?")
METRE_PLACES = 9  # a millionth of a millimetre
RADIAN_PLACES = 9
_NOISE = 1e-13  # of sums of products of numbers near 1: what is smaller was zero


def real_text(value: float, spelling: str = "") -> str:
    """A real number with a point, as it was spelled where URScript reads that as the same number."""
    if _REAL.fullmatch(spelling) and float(spelling) == value:
        return spelling
    return number_text(float(value), style=_POINT)


def plain_text(value: float, places: int | None = None) -> str:
    """A number where whole and real ones mean the same (inside of poses, as arguments of moves)."""
    return number_text(float(value), places, style=_PLAIN)


def metres(millimetres: float) -> str:
    """A length in mm as a number in m; shifting the point loses nothing."""
    return plain_text(float(Decimal(repr(float(millimetres))).scaleb(-3)), METRE_PLACES)


def radians(degrees: float, point: bool = False) -> str:
    """An angle in degrees as a number in rad."""
    style = _POINT if point else _PLAIN
    return number_text(math.radians(degrees), RADIAN_PLACES, style=style)


def rotation_vector(rotation: rigid.Rotation) -> tuple[float, float, float]:
    """Axis times angle (rad), the angle in [0, pi]. At pi the first component that is not zero is positive."""
    w, x, y, z = rotation.quaternion
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < _NOISE:
        return 2.0 * x, 2.0 * y, 2.0 * z
    factor = 2.0 * math.atan2(sine, w) / sine
    return _quiet(x * factor), _quiet(y * factor), _quiet(z * factor)


def _quiet(value: float) -> float:
    return 0.0 if abs(value) < _NOISE else value


def pose_text(pose: rigid.Pose) -> str:
    """`p[x, y, z, rx, ry, rz]` of a pose in mm."""
    place = [metres(value) for value in (pose.position.x, pose.position.y, pose.position.z)]
    turn = [plain_text(value, RADIAN_PLACES) for value in rotation_vector(pose.rotation)]
    return f"p[{', '.join((*place, *turn))}]"


def ascii_text(text: str) -> str:
    """The text in ASCII: accents dropped, other signs as `?`."""
    plain = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    return "".join(
        sign if " " <= sign <= "~" else "?" for sign in plain.replace("\t", " ") if not unicodedata.combining(sign)
    )
