"""`rpl fk`: joints to a pose."""

from __future__ import annotations

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
from rpl.cli.output import json_option, print_json, robot_named
from rpl.errors import UsageError


@click.command("fk")
@required_robot
@click.option("--joints", required=True, metavar="A,B,..", help="Joint values as the pendant shows them: deg, mm.")
@tool_option
@dialect_option
@json_option
def command(robot: str, joints: str, tool: str | None, dialect: str | None, as_json: bool) -> int:
    """Forward kinematics: joints to a pose in a dialect's notation, with its configuration flags.

    JSON: `matrix` is the flange in the robot's base frame (4x4, mm), `pose` the tool (without --tool the flange) in the
    chosen notation, `poses` the same in every notation, `outside_limits` the numbers of the axes beyond their limits.
    """
    model = robot_named(robot)
    if model is None:
        raise UsageError("--robot is needed")
    values = joints_of(joints, "--joints", model)
    name, notation = chosen_notation(dialect, model)
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
        click.echo(poses[name])
    if outside:
        click.echo(f"rpl: beyond the limits of axis {', '.join(map(str, outside))}", err=True)
    return 0
