"""`rpl project`: what a backup or a folder holds, before anything is run or translated."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from rpl.cli.files import force_option, write_files
from rpl.cli.output import (
    accept_option,
    collector,
    dialect_exists,
    from_option,
    json_option,
    opened,
    print_diagnostics,
    print_json,
    say,
    verbose_option,
    waiting,
)
from rpl.diagnostics import Severity


@click.command("project")
@click.argument("paths", nargs=-1, required=True, metavar="PATH...")
@from_option
@click.option("--html", "page_file", metavar="F.html", help="Write a page with the graph of calls.")
@accept_option
@force_option
@verbose_option
@json_option
def command(
    paths: Sequence[str],
    dialect: str | None,
    page_file: str | None,
    accepted: Sequence[str],
    as_json: bool,
) -> int:
    """Show programs, who calls whom, what is missing, signals, points, frames and tools.

    A PATH is a file, a folder or an archive, such as the backup of a controller; the arm that its files name is
    proposed for --robot. Exit status 1 when something cannot be read.
    """
    from rpl.inventory.contents import contents
    from rpl.inventory.robots import arms_of
    from rpl.inventory.shown import lines
    from rpl.project import read_program

    diagnostics, language = collector(accepted), dialect_exists(dialect)
    with waiting("reading"):
        read = read_program(opened(paths), language, diagnostics)
        found, arms = contents(read, diagnostics), arms_of(read)
    if not read.files:
        print_diagnostics(diagnostics)
        say("rpl: no robot program was found; name the language with --from if there is one", err=True)
        return 2
    if page_file is not None:
        from rpl.inventory.page import page

        title = ", ".join(Path(one).name or one for one in paths)
        write_files({Path(page_file): page(title, found, arms).encode("utf-8")})
    print_diagnostics(diagnostics, Severity.WARNING if not as_json else Severity.INFO)
    if as_json:
        document = found.as_json()
        document["arms"] = [
            {"called": one.called, "file": one.file, "robot": one.robot or None, "near": list(one.near)} for one in arms
        ]
        document["diagnostics"] = [item.as_json() for item in diagnostics]
        print_json(document)
    else:
        for line in lines(found, arms):
            say(line)
        if page_file is not None:
            say(f"wrote {page_file}")
    return 1 if diagnostics.has_errors else 0
