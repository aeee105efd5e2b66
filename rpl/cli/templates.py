"""`rpl templates`: how a target's statements look, macro by macro, and copies of the macros to begin with."""

from __future__ import annotations

from pathlib import Path

import click

from rpl import registry
from rpl.cli.files import force_option, write_files
from rpl.cli.output import json_option, print_json, say
from rpl.errors import UsageError


@click.command("templates")
@click.argument("target", required=False, metavar="[TARGET]")
@click.option(
    "-o", "--output", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help="Folder to write copies to."
)
@force_option
@json_option
def command(target: str | None, output: Path | None, as_json: bool) -> int:
    """List the macros that statements are written with, and the words that each gets.

    A plant puts its own in DIR/<target>/*.j2 and gives DIR to `rpl translate --templates`; those that it has not stay.
    """
    from rpl.writing.templates import macro_files, macro_texts

    names = [registry.target_called(target).name] if target else registry.target_names()
    packages = {name: registry.target_package(name) for name in names}
    if target and not macro_files(packages[names[0]]):
        raise UsageError(f"{names[0]} is written without templates")
    if output is not None:
        made = {
            output / name / file: text.encode("utf-8")
            for name, package in packages.items()
            for file, text in macro_files(package).items()
        }
        write_files(made)
        for path in made:
            say(f"wrote {path}", err=as_json)
    rows = [(name, one) for name, package in packages.items() for one in macro_texts(package).values()]
    if as_json:
        print_json([{"target": name, "macro": one.name, "words": one.words, "about": one.note} for name, one in rows])
    elif output is None:
        for name, one in rows:
            say(f"{name + ' ' if target is None else ''}{one.name}({', '.join(one.words)})\n    {one.note}")
    return 0
