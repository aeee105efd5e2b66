"""`rpl fetch`: the programs of a controller into a folder."""

from __future__ import annotations

from pathlib import Path

import click

from rpl.cli.controllers import config_option, connection, files_shown, named
from rpl.cli.files import force_option, write_files
from rpl.cli.output import json_option, print_json, say
from rpl.showing import counted


@click.command("fetch")
@click.argument("name", metavar="NAME|URL")
@click.option(
    "-o",
    "--output",
    "folder",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Folder to write to.",
)
@click.option("--all", "everything", is_flag=True, help="All files that the controller lists, not only programs.")
@config_option
@force_option
@json_option
def command(name: str, folder: Path, everything: bool, config: Path | None, as_json: bool) -> int:
    """Fetch the programs of a controller, byte for byte. Nothing on the controller is changed.

    NAME is one of rpl.toml, or an address: ur://HOST, abb://HOST:80, ftp://USER@HOST/path. Exit status 1 when a file
    could not be fetched; those that could are there.
    """
    from rpl.controllers import journal
    from rpl.controllers.fetching import fetched
    from rpl.controllers.link import LinkError

    profile = named(name, config)
    got: dict[str, bytes] = {}
    missing: dict[str, str] = {}
    lost: LinkError | None = None
    identity: dict[str, str] = {}
    try:
        with connection(profile) as link, files_shown(f"fetching from {profile.name}") as show:
            identity = link.identity().said()
            for one in fetched(link, profile, everything, show):
                if one.data is None:
                    missing[one.name] = one.reason
                else:
                    got[one.name] = one.data
    except LinkError as error:
        lost = error
    if got:
        write_files({folder / path: data for path, data in got.items()})
        hashes = {path: journal.hash_of(data) for path, data in got.items()}
        journal.log(profile.state_folder, "fetched", profile.name, identity, {"to": str(folder), "files": hashes})
    if as_json:
        print_json(
            {
                "controller": profile.name,
                "identity": identity,
                "files": [{"name": path, "size": len(data)} for path, data in got.items()],
                "missing": missing,
                "error": str(lost) if lost is not None else None,
            }
        )
    else:
        say(f"fetched {counted(len(got), 'file')} from {profile.name} to {folder}")
    for name_there, reason in missing.items():
        say(f"rpl: {name_there}: {reason}", err=True)
    if lost is not None:
        say(f"rpl: {lost}", err=True)
    return 1 if missing or lost is not None else 0
