"""Literals of V+: numbers, texts in ASCII, transformations with angles about z, new y, new z."""

from __future__ import annotations

import math
import re
import unicodedata

from rpl import ir
from rpl.passes import rigid
from rpl.writing.text import NumberStyle, number_text

_STYLE = NumberStyle(smallest_plain=1e-6, exponent="E")
_NUMBER = re.compile(r"\d+(?:\.\d*)?(?:[eE][+-]?\d+)?|\.\d+")
PLACES = 6  # of calculated mm and degrees


def number(value: float, places: int | None = None) -> str:
    """A number; whole ones without a point."""
    return number_text(float(value), places, style=_STYLE)


def literal(value: float, spelled: str) -> str:
    """A number as it was spelled where V+ reads that as the same one."""
    if _NUMBER.fullmatch(spelled) and float(spelled) == value:
        return spelled
    return number(value)


def zyz(rotation: rigid.Rotation) -> tuple[float, float, float]:
    """Yaw, pitch, roll in degrees of Rz(yaw)·Ry(pitch)·Rz(roll), the pitch in [0, 180]. Where the pitch is 0 or 180 the
    roll has all of the turn, as controllers show it."""
    (_, xy, xz), (_, yy, yz), (zx, zy, zz) = rotation.rows
    sine = math.hypot(xz, yz)
    if sine < rigid.GIMBAL:
        down = zz < 0.0
        return 0.0, 180.0 if down else 0.0, rigid.angle_of(xy if down else -xy, yy)
    return rigid.angle_of(yz, xz), rigid.angle_of(sine, zz), rigid.angle_of(zy, -zx)


def components(pose: rigid.Pose) -> list[str]:
    """x, y, z, yaw, pitch, roll."""
    place = (pose.position.x, pose.position.y, pose.position.z)
    return [number(rigid.clean(value), PLACES) for value in (*place, *zyz(pose.rotation))]


def trans(values: list[str]) -> str:
    """`TRANS(...)` without the zeros at its end."""
    given = list(values)
    while given and given[-1] == "0":
        given.pop()
    return f"TRANS({', '.join(given)})" if given else "NULL"


def ascii_text(text: str) -> str:
    """The text in ASCII: accents dropped, other signs as `?`."""
    plain = unicodedata.normalize("NFKD", text.replace("ß", "ss").replace("\t", " "))
    return "".join(sign if " " <= sign <= "~" else "?" for sign in plain if not unicodedata.combining(sign))


def pieces(text: str) -> tuple[list[str], bool]:
    """The operands of `+` that make a text: quoted runs, and $CHR for what cannot stand between quotes. Second: did it
    lose signs that are not ASCII?"""
    shown: list[str] = []
    lost = False
    for part in re.split(r'(["\n\r])', text):
        if part in ('"', "\n", "\r"):
            shown.append(f"$CHR({ord(part)})")
        elif part:
            plain = ascii_text(part)
            lost = lost or plain != part
            shown.append(f'"{plain}"')
    return shown or ['""'], lost


def sigil(type: ir.Type | None) -> str:
    """The sign in front of names of variables of a type."""
    while isinstance(type, ir.ArrayType):
        type = type.element
    match type:
        case ir.StringType():
            return "$"
        case ir.JointsType():
            return "#"
    return ""


def spelled(name: str, type: ir.Type | None) -> str:
    """A variable's name with its sign."""
    plain = name.lstrip("$#%") if name[:1] in "$#" else name
    return (sigil(type) + plain if name[:1] != "%" else name).lower()
