"""`rpl check`: read programs and report, also what their controllers refuse to load, without kinematics."""

from __future__ import annotations

from collections.abc import Sequence

import click

from rpl.cli.output import (
    accept_option,
    collector,
    dialect_exists,
    from_option,
    json_option,
    opened,
    paths_argument,
    print_diagnostics,
    print_json,
    say,
    verbose_option,
    waiting,
)
from rpl.diagnostics import Diagnostic, Diagnostics, Severity, sarif
from rpl.reading.ledger import FileReport


@click.command("check")
@paths_argument
@from_option
@accept_option
@verbose_option
@json_option
@click.option("--sarif", "as_sarif", is_flag=True, help="One SARIF 2.1.0 log on stdout, for code hosts and editors.")
def command(paths: Sequence[str], dialect: str | None, accepted: Sequence[str], as_json: bool, as_sarif: bool) -> int:
    """Read programs together and report what cannot be read, makes no sense or does not load.

    A PATH is a file, a folder, an archive, or - for standard input.
    """
    from rpl.project import check_loading, read_program

    diagnostics, language = collector(accepted), dialect_exists(dialect)
    with waiting("reading"):
        read = read_program(opened(paths), language, diagnostics)
        check_loading(read, diagnostics)
    print_diagnostics(diagnostics)
    if as_sarif:
        click.echo(sarif(diagnostics))
    elif as_json:
        for line in file_lines(read.files, diagnostics):
            print_json(line)
    else:
        print_summary(read.files, diagnostics)
    if not read.files:
        say("rpl: no robot program was found; name the language with --from if there is one", err=True)
        return 2
    return 1 if diagnostics.has_errors else 0


def file_lines(files: Sequence[FileReport], diagnostics: Diagnostics) -> list[dict[str, object]]:
    """One document per file, those that were not read included."""
    by_file: dict[str, list[Diagnostic]] = {report.path: [] for report in files}
    for item in diagnostics:
        by_file.setdefault(item.origin.file, []).append(item)
    reports = {report.path: report for report in files}
    lines: list[dict[str, object]] = []
    for path, items in by_file.items():
        report = reports.get(path)
        found = []
        for item in items:
            shape = item.as_json()
            del shape["file"]
            found.append(shape)
        lines.append(
            {
                "file": path,
                "dialect": report.dialect if report else None,
                "statements": report.statements if report else 0,
                "opaque": report.opaque if report else 0,
                "diagnostics": found,
            }
        )
    return lines


def print_summary(files: Sequence[FileReport], diagnostics: Diagnostics) -> None:
    """One line per file and one for all."""
    for report in files:
        unread = f", {report.opaque} not readable" if report.opaque else ""
        say(f"{report.path}: {report.dialect}, {report.statements} statements{unread}")
    errors, warnings = len(diagnostics.of(Severity.ERROR)), len(diagnostics.of(Severity.WARNING))
    losses = len(diagnostics.of(Severity.LOSS))
    say(f"{len(files)} files, {errors} errors, {f'{losses} losses, ' if losses else ''}{warnings} warnings")
