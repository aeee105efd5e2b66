"""`rpl prove`: do two programs mean the same? `--certificate` keeps the answer, `--check` asks again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpl.cli.files import force_option, refuse_others
from rpl.cli.limits import limit_options
from rpl.cli.output import STANDARD_INPUT, json_option, print_json, robot_option, say, verbose_option
from rpl.cli.proofs import answer, certificate_option, keep, programs_of, with_arms
from rpl.cli.verdicts import accepting, exploring, status_of, teaching
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.proof.tolerance import Accepted

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
@teaching
@accepting
@certificate_option
@click.option(
    "--check",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.json",
    help="Do the proof of a certificate again and say whether it still holds; takes no programs.",
)
@limit_options
@force_option
@verbose_option
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
    from rpl.proof.certificate import Question
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
    programs = programs_of(question)
    question = with_arms(question, programs)
    result = answer(question, programs)
    if kept is not None:
        keep(kept, question, programs, result)
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
        programs = programs_of(question)
        result = answer(question, programs)
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
