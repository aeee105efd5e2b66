"""`rpl prove`: do two programs mean the same? `--certificate` keeps the answer, `--check` asks again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpl.cli.files import force_option, refuse_others
from rpl.cli.limits import limit_options, limits_of
from rpl.cli.output import (
    STANDARD_INPUT,
    collector,
    dialect_exists,
    json_option,
    opened,
    print_diagnostics,
    print_json,
    robot_option,
    robots_exist,
    say,
    waiting,
    write_file,
)
from rpl.cli.verdicts import accepting, exploring, status_of
from rpl.diagnostics import Severity
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.project import ReadProgram
    from rpl.proof.certificate import Question
    from rpl.proof.tolerance import Accepted
    from rpl.proof.verdict import ProofResult

HOLDS, FAILS = 0, 1


@click.command("prove")
@click.argument("a", required=False)
@click.argument("b", required=False)
@robot_option
@click.option("--to-robot", metavar="R2", help="Arm that B was written for; else the same.")
@click.option("--cell", metavar="F.toml", help="Surroundings for both runs: inputs, parts, answers of the operator.")
@click.option("--entry", metavar="NAME", help="Routine to start with in A, and in B unless --to-entry says another.")
@click.option("--to-entry", metavar="NAME", help="Routine to start with in B.")
@click.option("--from", "language_a", metavar="D", help="Language of A; else seen from its content.")
@click.option("--to", "language_b", metavar="D", help="Language of B; else seen from its content.")
@click.option(
    "--controller",
    metavar="NAME|F.toml",
    default="plain",
    help="Who moves both robots: a language's controller or a file; else constant accelerations.",
)
@exploring
@accepting
@click.option(
    "--certificate",
    "kept",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.json",
    help="Write the question, the files' hashes and the verdict there.",
)
@click.option(
    "--check",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.json",
    help="Do the proof of a certificate again and say whether it still holds; takes no programs.",
)
@limit_options
@force_option
@json_option
def command(
    a: str | None,
    b: str | None,
    accepted: Accepted,
    kept: Path | None,
    check: Path | None,
    as_json: bool,
    **asked: Any,
) -> int:
    """Decide by running both whether the programs A and B (each a file, folder or archive) mean the same.

    The first line is the verdict: equal (exit status 0), alike (3: the same events in the same order, but measures
    deviate, each is named), different (1: the first difference is shown with both lines), or undecided (1: the runs do
    not show enough).
    """
    from rpl.proof.certificate import Question, as_bytes, certificate
    from rpl.proof.tolerance import accepted_kinds

    if check is not None:
        if a is not None or kept is not None:
            raise UsageError("--check takes no programs and no other certificate: what to prove stands in the file")
        return _checked(check, as_json)
    if a is None or b is None:
        raise UsageError("name two programs, A and B, or a certificate with --check")
    if kept is not None:
        if STANDARD_INPUT in (a, b):
            raise UsageError("--certificate takes files: what standard input gave cannot be read again")
        refuse_others([kept])
    words = tuple(sorted(accepted_kinds(accepted.kinds)))
    limits: dict[str, Any] = {
        "path_mm": accepted.path_mm,
        "corner_mm": accepted.corner_mm,
        "time_share": accepted.time_share,
    }
    question = Question(a, b, accept=words, **limits, **asked)
    result, programs = _answer(question)
    if kept is not None:
        document = certificate(question, [one.sources for one in programs], result, kept.absolute())
        write_file(kept, as_bytes(document))
    if as_json:
        print_json(result.as_json())
    else:
        say(result.as_text())
    return status_of(result)


def _checked(path: Path, as_json: bool) -> int:
    """Ask the question of a certificate again: 0 when it still holds, 1 when it does not."""
    from rpl.proof.certificate import certificate, changes
    from rpl.proof.kept import read_certificate

    question, then = read_certificate(path)
    try:
        result, programs = _answer(question)
    except UsageError as error:
        raise UsageError(f"{path}: the question cannot be asked again: {error}") from None
    now = certificate(question, [one.sources for one in programs], result, path.absolute())
    found = changes(then, now)
    if as_json:
        print_json({"holds": not found, "changes": found, "verdict": result.verdict, "proof": result.as_json()})
    else:
        say(f"the certificate {'does not hold any more' if found else 'holds'}: {result.headline()}")
        for line in found:
            say(f"  {line}")
    return FAILS if found else HOLDS


def _answer(question: Question) -> tuple[ProofResult, list[ReadProgram]]:
    """The verdict, and the programs as they were read."""
    from rpl.controllers import controller_named
    from rpl.proof.cellnames import report_unknown_signals
    from rpl.proof.explore import Budget
    from rpl.proof.prove import load_cell, prove_programs

    limits = limits_of(question.max_time, question.max_steps, question.max_events)
    driver = controller_named(question.controller)
    robots_exist(question.robot, question.to_robot)
    surroundings, unknown = load_cell(question.cell), collector()
    programs = _both((question.a, question.b), (question.language_a, question.language_b))
    report_unknown_signals(programs[0].program, surroundings, unknown)
    print_diagnostics(unknown, Severity.WARNING)
    with waiting("proving"):
        result = prove_programs(
            programs[0].program,
            programs[1].program,
            question.robot,
            question.to_robot or question.robot,
            surroundings,
            entry=question.entry,
            to_entry=question.to_entry or question.entry,
            accepted=question.accepted,
            controller=driver,
            limits=limits,
            budget=Budget() if question.explore else None,
        )
    return result, programs


def _both(paths: tuple[str, str], languages: tuple[str | None, str | None]) -> list[ReadProgram]:
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
        programs.append(read)
    return programs
