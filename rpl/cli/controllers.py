"""What the commands that speak to controllers share: which one is meant, its connection, progress of its files."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from rpl.controllers.link import Link
    from rpl.controllers.profile import Profile

config_option = click.option(
    "--config",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="rpl.toml",
    help="File with the controllers; else rpl.toml here or above.",
)


def named(name: str, config: Path | None) -> Profile:
    """The controller of that name or address. Raises UsageError."""
    from rpl.controllers.profiles import profile_named

    return profile_named(name, config)


def connect(profile: Profile) -> Link:
    """A connection to it. Raises LinkError, UsageError."""
    from rpl.controllers.vendors import vendor

    return vendor(profile.maker).connect(profile)


@contextmanager
def connection(profile: Profile) -> Iterator[Link]:
    """A connection that is closed at the end."""
    link = connect(profile)
    try:
        yield link
    finally:
        link.close()


@contextmanager
def files_shown(text: str) -> Iterator[Callable[[int, int], None]]:
    """A bar on a terminal: files done of all files. Elsewhere nothing is shown."""
    if not sys.stderr.isatty():
        yield lambda done, of: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(text, total=None)

        def show(done: int, of: int) -> None:
            progress.update(task, completed=done, total=of)

        yield show
