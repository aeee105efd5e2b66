"""`rpl status`: one look at a controller."""

from __future__ import annotations

from pathlib import Path

import click

from rpl.cli.controllers import config_option, connection, named
from rpl.cli.output import json_option, print_json, say


@click.command("status")
@click.argument("name", metavar="NAME|URL")
@config_option
@json_option
def command(name: str, config: Path | None, as_json: bool) -> int:
    """Show who a controller is and what it is doing: mode, running, program, where the robot stands, signals.

    Nothing is changed. What the controller's interfaces do not say is shown as not said.
    """
    from rpl.controllers.showing import Status
    from rpl.controllers.vendors import vendor

    profile = named(name, config)
    ask = vendor(profile.maker).status
    if ask is not None:
        found = ask(profile)
    else:
        with connection(profile) as link:
            found = Status(link.identity(), link.state())
    if as_json:
        print_json({"controller": profile.name, **found.as_json()})
    else:
        for line in found.lines():
            say(line)
    return 0
