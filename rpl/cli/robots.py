"""`rpl robots`: the robot models there are."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING

import click

from rpl.cli.output import json_option, print_json, say

if TYPE_CHECKING:
    from rpl.emulator.robotfile import RobotSummary


@click.command("robots")
@click.argument("words", nargs=-1, metavar="[FILTER]...")
@json_option
def command(words: Sequence[str], as_json: bool) -> int:
    """List the robot models that come with the package, with their reach and payload.

    FILTER: words that must all stand in name, maker or model (capitals, blanks and dashes do not count); then the
    limits of the joints are shown too. Exit status 1 when there is no such robot.
    """
    from rpl.emulator.robotfile import robot_summaries

    every = robot_summaries()
    robots = [robot for robot in every if _is_meant(robot, words)]
    if as_json:
        print_json([_document(robot) for robot in robots])
    else:
        _show(robots, bool(words))
    if not robots:
        close = get_close_matches("_".join(words).lower(), [robot.name for robot in every], 3, 0.4)
        hint = f"; the nearest are {', '.join(close)}" if close else ""
        say(f"rpl: there is no robot like {' '.join(words)!r}{hint}", err=True)
    return 0 if robots else 1


def _plain(text: str) -> str:
    return "".join(sign for sign in text.casefold() if sign.isalnum())


def _is_meant(robot: RobotSummary, words: Sequence[str]) -> bool:
    about = [_plain(text) for text in (robot.name, robot.maker, robot.title)]
    return all(any(_plain(word) in text for text in about) for word in words)


def _document(robot: RobotSummary) -> dict[str, object]:
    return {
        "name": robot.name,
        "maker": robot.maker,
        "model": robot.title,
        "axes": robot.axes,
        "kind": robot.kind,
        "reach_mm": None if robot.reach_mm is None else round(robot.reach_mm, 3),
        "payload_kg": robot.payload_kg,
        "limits": robot.limits,
    }


def _show(robots: Sequence[RobotSummary], with_limits: bool) -> None:
    """A line a robot; with limits a second one."""
    for robot in robots:
        reach = "-" if robot.reach_mm is None else f"{robot.reach_mm:.0f}"
        payload = "-" if robot.payload_kg is None else f"{robot.payload_kg:g}"
        about = f"{robot.name:<28} {robot.maker:<16} {robot.title:<32} {robot.axes} axes"
        say(f"{about} {reach:>5} mm {payload:>4} kg")
        if with_limits:
            say("    " + "  ".join(f"{low:g}..{high:g}" for low, high in robot.limits))
