"""`rpl watch`: values of a controller as they change."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import click

from rpl.cli.controllers import config_option, named
from rpl.cli.output import json_option, print_json, say
from rpl.errors import UsageError


@click.command("watch")
@click.argument("name", metavar="NAME|URL")
@click.argument("values", nargs=-1, metavar="[VALUE]...")
@click.option("--period", "period_s", type=float, default=0.1, show_default=True, metavar="S", help="Time between two.")
@click.option("--count", type=click.IntRange(1), metavar="N", help="End after N samples; else with Ctrl-C.")
@config_option
@json_option
def command(
    name: str, values: Sequence[str], period_s: float, count: int | None, config: Path | None, as_json: bool
) -> int:
    """Show values of a controller live, as its maker calls them; --json: one document a line.

    Without a VALUE the usual ones of the maker are shown. Nothing is changed.
    """
    from rpl.controllers.vendors import vendor

    profile = named(name, config)
    watch = vendor(profile.maker).watch
    if watch is None:
        raise UsageError(f"{profile.maker}: no interface of it gives values while they change; rpl status takes a look")
    if not 0.0 < period_s <= 3600.0:
        raise UsageError(f"--period: {period_s:g} is no time between two samples in s")
    for sample in islice(watch(profile, values, period_s), count):
        if as_json:
            print_json({"t": round(sample.t, 6), "values": dict(sample.values)})
        else:
            shown = ", ".join(f"{word} {_said(value)}" for word, value in sample.values.items())
            say(f"{sample.t:9.3f} s  {shown}")
    return 0


def _said(value: object) -> str:
    if isinstance(value, tuple):
        return "(" + ", ".join(f"{one:.4f}" for one in value) + ")"
    return f"{value:.4f}" if isinstance(value, float) else str(value)
