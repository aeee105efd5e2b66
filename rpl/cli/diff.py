"""`rpl diff`: what two versions of a program differ in, by what they say."""

from __future__ import annotations

import sys

import click

from rpl.cli.output import (
    dialect_exists,
    from_option,
    json_option,
    opened,
    print_diagnostics,
    print_json,
    verbose_option,
    waiting,
)
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import UsageError
from rpl.showing import printable

_COLOURS = {"added": "green", "removed": "red", "changed": "yellow"}


@click.command("diff")
@click.argument("a")
@click.argument("b")
@from_option
@click.option("--no-comments", "hide", is_flag=True, help="Leave comments out.")
@verbose_option
@json_option
def command(a: str, b: str, dialect: str | None, hide: bool, as_json: bool) -> int:
    """Show what changed from A to B by what it means.

    A and B are files, folders or archives in one language. Points are told by millimetres and degrees; dates, numbers
    of lines, blanks and comments mean nothing. Exit status 1 when the meaning differs.
    """
    from rpl.comparing import differences
    from rpl.comparing.shown import Shown, lines
    from rpl.project import read_program

    language = dialect_exists(dialect)
    reports = Diagnostics(), Diagnostics()
    with waiting("comparing"):
        old, new = (
            read_program(opened([path]), language, report) for path, report in zip((a, b), reports, strict=True)
        )
        for path, read, report in ((a, old, reports[0]), (b, new, reports[1])):
            if not read.files:
                print_diagnostics(report)
                raise UsageError(f"{path}: no robot program was found; name the language with --from if there is one")
        found = differences(old, new)
    for report in reports:
        print_diagnostics(report, Severity.ERROR)
    if as_json:
        print_json(found.as_json())
    else:
        paint = _painted if sys.stdout.isatty() else _plain
        for line in lines(found, Shown(paint, not hide)):
            click.echo(line)
    return 0 if found.same else 1


def _plain(text: str, what: str) -> str:
    return printable(text)


def _painted(text: str, what: str) -> str:
    if what not in _COLOURS:
        return click.style(printable(text), bold=what == "title")
    return click.style(printable(text), fg=_COLOURS[what])
