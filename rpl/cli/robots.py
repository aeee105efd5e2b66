"""`rpl robots`: the robot models there are."""

from __future__ import annotations

import click

from rpl.cli.output import json_option, print_json


@click.command("robots")
@json_option
def command(as_json: bool) -> int:
    """List the robot models that come with the package."""
    from rpl.emulator.robotfile import robot_summaries

    robots = robot_summaries()
    if as_json:
        print_json(
            [{"name": r.name, "maker": r.maker, "model": r.title, "axes": r.axes, "kind": r.kind} for r in robots]
        )
        return 0
    for robot in robots:
        click.echo(f"{robot.name:<32} {robot.maker:<12} {robot.title:<32} {robot.axes} axes")
    return 0
