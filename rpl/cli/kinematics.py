"""What `fk` and `ik` share: joints, poses and tools from the command line, and each dialect's notation of a pose."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import click

from rpl import registry
from rpl.cli.output import numbers
from rpl.errors import SourceError, UsageError
from rpl.tomlfile import FARTHEST

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray

required_robot = click.option("--robot", required=True, metavar="R", help="A robot's name (rpl robots) or .toml file.")
dialect_option = click.option("--dialect", metavar="D", help="Language whose notation of a pose is used.")
# Numbers and commas alone; everything else is in the notation of a language.
_PLAIN = re.compile(r"[-+0-9.eE,;\s]*")
tool_option = click.option(
    "--tool", metavar="POSE", help="Tool in the flange: a pose, or x,y,z or x,y,z,a,b,c (mm, deg)."
)


def notations() -> dict[str, Notation]:
    """The pose notations there are, by dialect."""
    found = {}
    for name in registry.dialect_names():
        maker = registry.dialect(name).notation
        if maker is not None:
            found[name] = maker()
    return found


def chosen_notation(dialect: str | None, model: RobotModel) -> tuple[str, Notation]:
    """The dialect asked for; else the one whose title names the robot's maker; else the first there is."""
    if dialect is not None:
        return named_notation(dialect)
    known = notations()
    for name, notation in known.items():
        if model.maker and model.maker.lower() in registry.dialect(name).title.lower():
            return name, notation
    if not known:
        raise UsageError("no language with a notation of poses is installed")
    first = next(iter(known))
    return first, known[first]


def named_notation(dialect: str) -> tuple[str, Notation]:
    """A dialect's notation of poses. Raises UsageError when it has none."""
    name, known = registry.dialect_called(dialect).name, notations()
    if name not in known:
        raise UsageError(f"{name} has no notation of poses: there are {', '.join(known)}")
    return name, known[name]


def joints_of(text: str, what: str, model: RobotModel) -> FloatArray:
    """Joint values for the model. Raises UsageError for a wrong count or what is no number."""
    import numpy as np

    return np.array(numbers(text, what, model.axes))


def pose_of(text: str, what: str, notation: Notation) -> tuple[FloatArray, dict[str, int | None]]:
    """A pose (4, 4, mm) and its flags: the dialect's notation, or x,y,z or x,y,z,a,b,c with ZYX angles."""
    if _PLAIN.fullmatch(text) is None:
        try:
            pose, flags = notation.parse_pose(text)
        except SourceError as error:
            raise UsageError(f"{what}: {error}") from None
        if not abs(pose).max() <= FARTHEST:
            raise UsageError(f"{what}: a place is beyond {FARTHEST:,.0f} mm")
        return pose, flags
    from rpl.emulator.rotations import pose_matrix, zyx_to_matrix

    values = numbers(text, what)
    if len(values) not in (3, 6):
        raise UsageError(f"{what}: write it as the dialect does, or as x,y,z or x,y,z,a,b,c; {len(values)} are given")
    return pose_matrix(values[:3], zyx_to_matrix([*values[3:], *[0.0] * (6 - len(values))])), {}


def matrix_rows(matrix: FloatArray) -> list[list[float]]:
    """Rows of a matrix without noise in the last bits and without negative zeros."""
    return [[round(float(value), 9) + 0.0 for value in row] for row in matrix]


def joint_list(joints: FloatArray) -> list[float]:
    return [round(float(value), 9) + 0.0 for value in joints]
