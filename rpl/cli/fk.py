"""`rpl fk`: joints to a pose."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpl.cli.kinematics import (
    chosen_notation,
    dialect_option,
    joint_list,
    joints_of,
    matrix_rows,
    notations,
    pose_of,
    required_robot,
    tool_option,
)
from rpl.cli.output import json_option, print_json, robot_named, say
from rpl.cli.points import (
    Outcome,
    chunks,
    joint_cells,
    joint_places,
    kept_columns,
    matrix_of,
    points_option,
    read_table,
    report,
    target_cells,
    target_columns,
)
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray


@click.command("fk")
@required_robot
@click.option("--joints", metavar="A,B,..", help="Joint values as the pendant shows them: deg, mm.")
@points_option
@tool_option
@dialect_option
@json_option
def command(
    robot: str, joints: str | None, points: str | None, tool: str | None, dialect: str | None, as_json: bool
) -> int:
    """Forward kinematics: joints to a pose in a dialect's notation, with its configuration flags.

    JSON: `matrix` is the flange in the robot's base frame (4x4, mm), `pose` the tool (without --tool the flange) in the
    chosen notation, `poses` the same in every notation, `outside_limits` the numbers of the axes beyond their limits.

    With --points a file of joints (columns j1, j2, ..) becomes a table of targets, as CSV or as `points` in JSON.
    """
    from rpl.emulator.postures import UNKNOWN_BUILD, has_flags

    model = robot_named(robot)
    if model is None:
        raise UsageError("--robot is needed")
    name, notation = chosen_notation(dialect, model)
    if notation.fields and not has_flags(model):
        say(f"rpl: {UNKNOWN_BUILD}: those shown for {model.name} say nothing", err=True)
    if (joints is None) == (points is None):
        raise UsageError("either --joints or --points is needed")
    if points is not None:
        tip_in_flange = pose_of(tool, "--tool", notation)[0] if tool else None
        return _table(model, name, notation, points, tip_in_flange, as_json)
    values = joints_of(joints or "", "--joints", model)
    flange = model.forward(values)
    tip = flange @ pose_of(tool, "--tool", notation)[0] if tool else flange
    poses = {other: kind.format_pose(model, tip, values) for other, kind in notations().items()}
    outside = [axis + 1 for axis in model.within_limits(values)]
    if as_json:
        document = {
            "robot": model.name,
            "joints_deg": joint_list(values),
            "matrix": matrix_rows(flange),
            "tool_matrix": matrix_rows(tip),
            "dialect": name,
            "pose": poses[name],
            "configuration": notation.encode(model, values),
            "poses": poses,
            "outside_limits": outside,
        }
        print_json(document)
    else:
        say(poses[name])
    if outside:
        say(f"rpl: beyond the limits of axis {', '.join(map(str, outside))}", err=True)
    return 0


def _table(model: RobotModel, name: str, notation: Notation, path: str, tool: FloatArray | None, as_json: bool) -> int:
    """Rows of joints to rows of targets."""
    table = read_table(path)
    places = joint_places(table, model.axes)
    made = target_columns(notation)
    joint_names = tuple(f"j{axis}" for axis in range(1, model.axes + 1))
    kept = kept_columns(table, made)
    outcome = Outcome(("line", *(table.columns[place] for place in kept), *joint_names, *made, "outside_limits"))
    for part in chunks(table.rows):
        rows, joints = matrix_of(table, part, places, outcome)
        flanges = model.forward(joints)
        cells = target_cells(model, notation, flanges if tool is None else flanges @ tool, joints)
        beyond = [" ".join(str(axis + 1) for axis in model.within_limits(one)) for one in joints]
        for row, one, more, outside in zip(rows, joint_cells(joints), cells, beyond, strict=True):
            aside = tuple(row.cells[place] if place < len(row.cells) else "" for place in kept)
            outcome.rows.append((row.line, (*aside, *one, *more, outside)))
    return report(table, outcome, {"robot": model.name, "dialect": name}, as_json)
