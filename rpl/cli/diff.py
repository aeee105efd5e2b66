"""`rpl diff`: what two versions of a program differ in, by what they say."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

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
from rpl.source import source_from_bytes

if TYPE_CHECKING:
    from rpl.comparing import Differences
    from rpl.comparing.shown import Paint
    from rpl.project import ReadProgram

_COLOURS = {"added": "green", "removed": "red", "changed": "yellow"}


@click.command("diff")
@click.argument("paths", nargs=-1, required=True, metavar="A B")
@from_option
@click.option("--no-comments", "hide", is_flag=True, help="Leave comments out.")
@click.option("--git", "by_git", is_flag=True, help="Take what Git gives to its diff drivers, and end with status 0.")
@verbose_option
@json_option
def command(paths: Sequence[str], dialect: str | None, hide: bool, by_git: bool, as_json: bool) -> int:
    """Show what changed from A to B by what it means.

    A and B are files, folders or archives in one language. Points are told by millimetres and degrees; dates, numbers
    of lines, blanks and comments mean nothing. Exit status 1 when the meaning differs.
    """
    from rpl.comparing import differences

    language = dialect_exists(dialect)
    if by_git:
        return _for_git(paths, language, hide)
    if len(paths) != 2:
        raise UsageError("two versions are needed: rpl diff A B")
    reports = Diagnostics(), Diagnostics()
    with waiting("comparing"):
        old, new = (_read(path, language, report) for path, report in zip(paths, reports, strict=True))
        found = differences(old, new)
    for report in reports:
        print_diagnostics(report, Severity.ERROR)
    if as_json:
        print_json(found.as_json())
    else:
        _show(found, hide)
    return 0 if found.same else 1


def _read(path: str, language: str | None, report: Diagnostics) -> ReadProgram:
    """What is read of a path. Raises UsageError, behind the reports, when that is no program."""
    from rpl.project import read_program

    read = read_program(opened([path]), language, report)
    if not read.files:
        print_diagnostics(report)
        raise UsageError(f"{path}: no robot program was found; name the language with --from if there is one")
    return read


def _for_git(words: Sequence[str], language: str | None, hide: bool) -> int:
    """One file of `git diff`: path old-file old-hex old-mode new-file new-hex new-mode, behind a rename also the new
    path and what Git says of it; the path alone where a merge has left it open. The files have other names than in the
    project, and one that a version has not is /dev/null."""
    from rpl.comparing import differences
    from rpl.comparing.versions import files_of
    from rpl.project import read_program

    if len(words) == 1:
        click.echo(f"* unmerged {printable(words[0])}")
        return 0
    if len(words) not in (7, 9):
        raise UsageError("--git takes the seven words that Git gives: path old-file old-hex old-mode new-file ...")
    path, new_path = words[0], words[7] if len(words) == 9 else words[0]
    click.echo(_paint()(f"rpl diff a/{path} b/{new_path}", "title"))
    sides = []
    for file, name in ((words[1], path), (words[4], new_path)):
        sources = [source_from_bytes(name, data) for data in files_of(file).values() if data.strip()]
        sides.append(read_program(sources, language, Diagnostics()))
    if not any(side.files for side in sides):
        click.echo("no robot program, and no difference of meaning to tell")
        return 0
    for side, word in zip(sides, ("new file", "deleted file"), strict=True):
        if not side.files:
            click.echo(f"{word} {path}")
    _show(differences(*sides), hide)
    return 0


def _show(found: Differences, hide: bool) -> None:
    from rpl.comparing.shown import Shown, lines

    for line in lines(found, Shown(_paint(), not hide)):
        click.echo(line)


def _paint() -> Paint:
    """Colours on a terminal, and in the pager that Git shows it in."""
    return _painted if sys.stdout.isatty() or os.environ.get("GIT_PAGER_IN_USE") else _plain


def _plain(text: str, what: str) -> str:
    return printable(text)


def _painted(text: str, what: str) -> str:
    if what not in _COLOURS:
        return click.style(printable(text), bold=what == "title")
    return click.style(printable(text), fg=_COLOURS[what])
