"""The options that say how much a run may do: the same for every command that runs programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import click

from rpl.errors import UsageError
from rpl.runtime.limits import DEFAULTS, Limits

Command = TypeVar("Command", bound=Callable[..., object])


def limit_options(command: Command) -> Command:
    """`--max-time`, `--max-steps` and `--max-events`."""
    for option in (
        click.option(
            "--max-events", type=int, metavar="N", help=f"End after so many entries of the trace ({DEFAULTS.events:,})."
        ),
        click.option(
            "--max-steps",
            type=int,
            metavar="N",
            help=f"End when so many statements take no time at all ({DEFAULTS.steps:,}).",
        ),
        click.option(
            "--max-time", type=float, metavar="S", help=f"End after so many simulated seconds ({DEFAULTS.time_s:g})."
        ),
    ):
        command = option(command)
    return command


def limits_of(max_time: float | None, max_steps: int | None, max_events: int | None) -> Limits:
    """The limits asked for; what was not given is as usual. Raises UsageError for one that is not above 0."""
    limits = DEFAULTS
    if max_time is not None:
        if not max_time > 0:
            raise UsageError(f"--max-time: {max_time:g} is not a time above 0 s")
        limits = replace(limits, time_s=max_time)
    if max_steps is not None:
        limits = replace(limits, steps=_number("--max-steps", max_steps))
    if max_events is not None:
        limits = replace(limits, events=_number("--max-events", max_events))
    return limits


def _number(option: str, given: int) -> int:
    if given <= 0:
        raise UsageError(f"{option}: {given} is not a number above 0")
    return given
