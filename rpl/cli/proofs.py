"""Proofs as commands make them: the programs of a question, its answer, and the certificate that keeps both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.limits import limits_of
from rpl.cli.output import (
    arm_of,
    collector,
    dialect_exists,
    opened,
    print_diagnostics,
    robots_exist,
    waiting,
    write_file,
)
from rpl.diagnostics import Severity
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.project import ReadProgram
    from rpl.proof.certificate import Question
    from rpl.proof.teaching.retaught import Teaching
    from rpl.proof.verdict import ProofResult

certificate_option = click.option(
    "--certificate",
    "kept",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.json",
    help="Write the question of the proof, the files' hashes and the verdict there.",
)


def programs_of(question: Question) -> list[ReadProgram]:
    """The two programs that are compared, with warnings about them and about the cell on stderr. Raises UsageError for
    a path without one, and before anything is read for an unknown arm or controller."""
    from rpl.controllerfiles import controller_named
    from rpl.project import read_program
    from rpl.proof.cellnames import report_unknown_names
    from rpl.proof.prove import load_cell

    limits_of(question.max_time, question.max_steps, question.max_events)
    controller_named(question.controller)
    robots_exist(question.robot, question.to_robot)
    surroundings, unknown = load_cell(question.cell), collector()
    paths, programs = (question.a, question.b), []
    for path, source, language in zip(paths, opened(paths), (question.language_a, question.language_b), strict=True):
        diagnostics = collector()
        with waiting("reading"):
            read = read_program([source], dialect_exists(language), diagnostics)
        print_diagnostics(diagnostics, Severity.WARNING)
        if not read.files:
            raise UsageError(f"no robot program in {path}; name the language with --from or --to if there is one")
        programs.append(read)
    report_unknown_names([one.program for one in programs], surroundings, unknown)
    print_diagnostics(unknown, Severity.WARNING)
    return programs


def with_arms(question: Question, programs: Sequence[ReadProgram]) -> Question:
    """The question with the arms that the programs' backups name, where it names none."""
    if question.robot is not None:
        return question
    first, second = arm_of(programs[0]), question.to_robot or arm_of(programs[1])
    robot = first or (second if question.to_robot is None else None)
    return replace(question, robot=robot, to_robot=second if second != robot else None)


def answer(question: Question, programs: Sequence[ReadProgram]) -> ProofResult:
    """The verdict about its programs."""
    from rpl.controllerfiles import controller_named
    from rpl.proof.explore import Budget
    from rpl.proof.prove import load_cell, prove_programs
    from rpl.proof.wiring import with_names

    first, second = (one.program for one in programs)
    with waiting("proving"):
        result = prove_programs(
            first,
            with_names(second, question.signals),
            question.robot,
            question.to_robot or question.robot,
            load_cell(question.cell),
            entry=question.entry,
            to_entry=question.to_entry or question.entry,
            accepted=question.accepted,
            controller=controller_named(question.controller),
            limits=limits_of(question.max_time, question.max_steps, question.max_events),
            budget=Budget() if question.explore else None,
            kept=dict(question.names),
            teaching=_teaching(question),
        )
    return replace(result, approximations=question.approximations)


def _teaching(question: Question) -> Teaching | None:
    """What of the question is about re-teaching."""
    from rpl.proof.teaching.moving import Amount
    from rpl.proof.teaching.retaught import Teaching

    if question.teach is None:
        return None
    usual = Amount()
    amount = usual if question.teach_mm is None else usual.times(question.teach_mm / usual.mm)
    return Teaching(question.teach, amount, question.taught)


def keep(kept: Path, question: Question, programs: Sequence[ReadProgram], result: ProofResult) -> None:
    """Write the certificate. Raises UsageError when it cannot be written there."""
    from rpl.proof.certificate import as_bytes, certificate

    document = certificate(question, [one.sources for one in programs], result, kept.absolute())
    write_file(kept, as_bytes(document))


__all__ = ["answer", "certificate_option", "keep", "programs_of", "with_arms"]
