"""`rpl ik`: a pose to all joint solutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpl.cli.kinematics import (
    chosen_notation,
    dialect_option,
    joint_list,
    joints_of,
    matrix_rows,
    pose_of,
    required_robot,
    tool_option,
)
from rpl.cli.output import json_option, print_json, robot_named
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation, Selection
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray

_SAME_DEG = 1e-6


@click.command("ik")
@required_robot
@click.option("--pose", required=True, metavar="TEXT", help="Pose in the dialect's notation, or x,y,z,a,b,c (mm, deg).")
@click.option("--near", metavar="A,B,..", help="Joints before the move: they decide what the flags leave open.")
@tool_option
@dialect_option
@json_option
def command(robot: str, pose: str, near: str | None, tool: str | None, dialect: str | None, as_json: bool) -> int:
    """Inverse kinematics: a pose to all joint solutions; the one that the pose's flags select is marked.

    Each posture of the arm is listed once, with the turns nearest to --near (else to the home position).
    """
    model = robot_named(robot)
    if model is None:
        raise UsageError("--robot is needed")
    name, notation = chosen_notation(dialect, model)
    target, flags = pose_of(pose, "--pose", notation)
    flange = target
    if tool:
        import numpy as np

        flange = target @ np.linalg.inv(pose_of(tool, "--tool", notation)[0])
    reference = joints_of(near, "--near", model) if near else None
    selection = None
    if reference is not None or any(value is not None for value in flags.values()):
        selection = notation.select(model, flange, flags, reference)
    rows = solutions(model, notation, flange, reference, selection)
    reason = selection.reason if selection is not None else "" if rows else "the pose is out of reach"
    if as_json:
        document = {
            "robot": model.name,
            "dialect": name,
            "matrix": matrix_rows(flange),
            "flags": flags,
            "solutions": rows,
            "reason": reason,
        }
        print_json(document)
    else:
        for row in rows:
            print_solution(row)
    if reason:
        click.echo(f"rpl: {reason}", err=True)
    return 0 if rows else 1


def solutions(
    model: RobotModel,
    notation: Notation,
    flange: FloatArray,
    reference: FloatArray | None,
    selection: Selection | None,
) -> list[dict[str, object]]:
    """One entry per posture; the selected joints stand in the place of their posture."""
    import numpy as np

    chosen = selection.joints if selection is not None else None
    near = model.home if reference is None else reference
    rows: list[dict[str, object]] = []
    marked = False
    for solution in model.inverse(flange, near):
        joints = model.nearest_turn(solution.joints, near)
        selected = False
        if chosen is not None and not marked:
            apart = model.canonical(chosen) - model.canonical(joints)
            selected = bool(np.abs((apart + 180.0) % 360.0 - 180.0).max() < _SAME_DEG)
            joints, marked = (chosen, True) if selected else (joints, False)
        rows.append(_row(model, notation, joints, selected, solution.singular))
    if chosen is not None and not marked:
        rows.append(_row(model, notation, chosen, True, True))
    return rows


def _row(
    model: RobotModel, notation: Notation, joints: FloatArray, selected: bool, singular: bool
) -> dict[str, object]:
    return {
        "joints_deg": joint_list(joints),
        "configuration": notation.encode(model, joints),
        "selected": selected,
        "within_limits": not model.within_limits(joints),
        "singular": singular,
    }


def print_solution(row: dict[str, object]) -> None:
    """One line: the mark, the joints, the flags."""
    joints, flags = row["joints_deg"], row["configuration"]
    assert isinstance(joints, list) and isinstance(flags, dict)
    mark = "*" if row["selected"] else " "
    angles = " ".join(f"{value:10.4f}" for value in joints)
    beyond = "" if row["within_limits"] else "  beyond limits"
    click.echo(f"{mark} {angles}   {' '.join(f'{key}={value}' for key, value in flags.items())}{beyond}")
