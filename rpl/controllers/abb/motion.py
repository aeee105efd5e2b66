"""Where the robot of a virtual ABB controller stands."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rpl import registry
from rpl.controllers.abb.inside import UNKNOWN, Inside, RefusalError
from rpl.controllers.abb.pages import Page, Thing

if TYPE_CHECKING:
    from rpl.controllers.abb.asked import Asked

_NO_AXIS = "9E+09"
_LETTERS = "abcdef"


def _joints(inside: Inside, unit: str) -> tuple[float, ...]:
    inside.cabinet.advance()
    joints = inside.cabinet.joints
    if unit.upper() != "ROB_1" or joints is None:
        raise RefusalError(404, UNKNOWN, f"there is no mechanical unit {unit}")
    return joints


def joint_target(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    """Degrees (mm for linear axes); axes that the arm has not are 0."""
    joints = (*_joints(inside, found[1]), *([0.0] * 6))[:6]
    values = {f"rax_{number}": f"{value:.6g}" for number, value in enumerate(joints, 1)}
    return Page((Thing("ms-jointtarget", found[1], values | {f"eax_{letter}": _NO_AXIS for letter in _LETTERS}),))


def robot_target(inside: Inside, request: Asked, found: re.Match[str]) -> Page:
    """The flange (tool0) in the robot's base (wobj0), whatever tool is asked for; mm, quaternion, confdata."""
    from rpl.emulator.rotations import matrix_to_quaternion

    joints = _joints(inside, found[1])
    flange, model = inside.cabinet.flange, inside.cabinet.model
    if flange is None or model is None:
        raise RefusalError(404, UNKNOWN, f"there is no mechanical unit {found[1]}")
    import numpy as np

    notation = registry.dialect(inside.cabinet.dialect).notation
    flags = notation().encode(model, np.array(joints)) if notation is not None else {}
    numbers = dict(zip(("x", "y", "z"), flange[:3, 3], strict=True))
    numbers |= dict(zip(("q1", "q2", "q3", "q4"), matrix_to_quaternion(flange[:3, :3]), strict=True))
    values = {name: f"{value:.8g}" for name, value in numbers.items()}
    values |= {name: str(flags.get(name, 0)) for name in ("cf1", "cf4", "cf6", "cfx")}
    return Page((Thing("ms-robtargets", found[1], values | {f"eax{letter}": _NO_AXIS for letter in _LETTERS}),))
