"""`rpl serve`: a virtual controller behind its maker's own interfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.output import print_json, robot_named, say
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.controllers.virtual.store import Store


@click.command("serve")
@click.argument("maker", metavar="MAKER")
@click.argument("programs", nargs=-1, metavar="[PROGRAMS]...")
@click.option("--robot", metavar="R", help="Arm of the controller: a name or a .toml file.")
@click.option("--host", default="127.0.0.2", show_default=True, metavar="ADDRESS", help="Address to listen at.")
@click.option("--anywhere", is_flag=True, help="Allow an address that others can reach; the controller asks nobody.")
@click.option("--port", "ports", multiple=True, metavar="INTERFACE=N", help="Another port for an interface.")
@click.option("--any-port", is_flag=True, help="Take any free port for each interface that is given none.")
@click.option("--time-scale", type=float, default=1.0, metavar="S", help="Simulated seconds of one real second.")
@click.option("--fault", metavar="NAME[:N][+]", help="Misbehave; a wrong name lists the faults.")
@click.option("--password", default="robot", show_default=True, metavar="TEXT", help="What lets clients in.")
@click.option("--transcript", type=click.Path(dir_okay=False, path_type=Path), metavar="F", help="Keep requests.")
@click.option(
    "--save", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help="Keep the files at the end."
)
def command(
    maker: str,
    programs: Sequence[str],
    robot: str | None,
    host: str,
    anywhere: bool,
    ports: Sequence[str],
    any_port: bool,
    time_scale: float,
    fault: str | None,
    password: str,
    transcript: Path | None,
    save: Path | None,
) -> int:
    """Stand in for a controller: it holds programs, runs them in real or scaled time, and answers as the maker's does.

    One JSON line {vendor, host, ports} on stdout says that it is ready; it ends with SIGTERM or Ctrl-C.
    """
    from rpl.controllers.vendors import vendor
    from rpl.controllers.virtual.cabinet import Cabinet
    from rpl.controllers.virtual.endpoints import Endpoints, checked_host
    from rpl.controllers.virtual.faults import fault_of
    from rpl.controllers.virtual.serving import serve
    from rpl.controllers.virtual.store import Store
    from rpl.controllers.virtual.transcript import Transcript

    made, faults = vendor(maker), fault_of(fault)
    if made.start is None or made.dialect is None:
        raise UsageError(f"there is no virtual controller of {made.name}")
    if not 0.0 < time_scale <= 1e6:
        raise UsageError(f"--time-scale: {time_scale:g} is no scale of time")
    if transcript is not None:
        transcript.write_text("", encoding="utf-8")
    cabinet = Cabinet(
        made.name,
        made.dialect,
        robot_named(robot),
        Store(faults),
        faults,
        Transcript(transcript),
        time_scale=time_scale,
        password=password,
    )
    cabinet.store.may_write = cabinet.may_write
    cabinet.store.put(_files(programs))
    endpoints = Endpoints(checked_host(host, anywhere), _ports(ports, made.ports), any_port)
    serve(made, cabinet, endpoints, print_json)
    if save is not None:
        _keep(save, cabinet.store)
    say("rpl: switched off", err=True)
    return 0


def _files(programs: Sequence[str]) -> list[tuple[str, bytes]]:
    """The files of the paths by their names on the controller: those of a folder as they stand below it."""
    found = []
    for given in map(Path, programs):
        if not given.exists():
            raise UsageError(f"{given}: there is no such file or folder")
        below = sorted(path for path in given.rglob("*") if path.is_file()) if given.is_dir() else [given]
        base = given if given.is_dir() else given.parent
        found += [(path.relative_to(base).as_posix(), path.read_bytes()) for path in below]
    return found


def _ports(given: Sequence[str], known: Mapping[str, int]) -> dict[str, int]:
    """`INTERFACE=N` of the command line. Raises UsageError."""
    found = {}
    for each in given:
        name, sign, number = each.partition("=")
        if not sign or not number.isdigit() or int(number) >= 2**16:
            raise UsageError(f"--port {each}: write INTERFACE=NUMBER")
        if name not in known:
            raise UsageError(f"--port {each}: there is no interface {name}; there are {', '.join(known)}")
        found[name] = int(number)
    return found


def _keep(folder: Path, store: Store) -> None:
    """Write what the controller holds at the end."""
    from rpl.controllers.rules import safe_name

    for name in store.names():
        path = folder / safe_name(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(store.kept(name))
