"""`rpl prove`: do two programs mean the same?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpl.cli.limits import limit_options, limits_of
from rpl.cli.output import (
    collector,
    dialect_exists,
    json_option,
    opened,
    print_diagnostics,
    print_json,
    robot_option,
    robots_exist,
    waiting,
)
from rpl.cli.verdicts import accepting, status_of
from rpl.diagnostics import Severity
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl import ir
    from rpl.proof.tolerance import Accepted


@click.command("prove")
@click.argument("a")
@click.argument("b")
@robot_option
@click.option("--to-robot", metavar="R2", help="Arm that B was written for; else the same.")
@click.option("--cell", metavar="F.toml", help="Surroundings for both runs: inputs, parts, answers of the operator.")
@click.option("--entry", metavar="NAME", help="Routine to start with in A, and in B unless --to-entry says another.")
@click.option("--to-entry", metavar="NAME", help="Routine to start with in B.")
@click.option("--from", "dialect", metavar="D", help="Language of A; else seen from its content.")
@click.option("--to", "other", metavar="D", help="Language of B; else seen from its content.")
@click.option(
    "--controller",
    metavar="NAME|F.toml",
    default="plain",
    help="Who moves both robots: a language's controller or a file; else constant accelerations.",
)
@accepting
@limit_options
@json_option
def command(
    a: str,
    b: str,
    robot: str | None,
    to_robot: str | None,
    cell: str | None,
    entry: str | None,
    to_entry: str | None,
    dialect: str | None,
    other: str | None,
    controller: str,
    accepted: Accepted,
    max_time: float | None,
    max_steps: int | None,
    max_events: int | None,
    as_json: bool,
) -> int:
    """Decide by running both whether the programs A and B (each a file, folder or archive) mean the same.

    The first line is the verdict: equal (exit status 0), alike (3: the same events in the same order, but measures
    deviate, each is named), different (1: the first difference is shown with both lines), or undecided (1: the runs do
    not show enough).
    """
    from rpl.controllers import controller_named
    from rpl.proof.cellnames import report_unknown_signals
    from rpl.proof.prove import load_cell, prove_programs
    from rpl.proof.tolerance import accepted_kinds

    accepted_kinds(accepted.kinds)
    limits, driver = limits_of(max_time, max_steps, max_events), controller_named(controller)
    robots_exist(robot, to_robot)
    surroundings, unknown = load_cell(cell), collector()
    programs = _both((a, b), (dialect, other))
    report_unknown_signals(programs[0], surroundings, unknown)
    print_diagnostics(unknown, Severity.WARNING)
    with waiting("proving"):
        result = prove_programs(
            programs[0],
            programs[1],
            robot,
            to_robot or robot,
            surroundings,
            entry=entry,
            to_entry=to_entry or entry,
            accepted=accepted,
            controller=driver,
            limits=limits,
        )
    if as_json:
        print_json(result.as_json())
    else:
        click.echo(result.as_text())
    return status_of(result)


def _both(paths: tuple[str, str], languages: tuple[str | None, str | None]) -> list[ir.Program]:
    """The programs that are compared. Raises UsageError for a path without one."""
    from rpl.project import read_program

    programs = []
    for path, source, language in zip(paths, opened(paths), languages, strict=True):
        diagnostics = collector()
        with waiting("reading"):
            read = read_program([source], dialect_exists(language), diagnostics)
        print_diagnostics(diagnostics, Severity.WARNING)
        if not read.files:
            raise UsageError(f"no robot program in {path}; name the language with --from or --to if there is one")
        programs.append(read.program)
    return programs
