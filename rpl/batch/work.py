"""What is done with one project: it is read, and checked, run or translated. Everything that can go wrong is a row."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rpl.batch import rows
from rpl.batch.asked import RUN, TRANSLATE, Asked
from rpl.batch.finding import Project
from rpl.batch.rows import Row
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.errors import RplError

if TYPE_CHECKING:
    from rpl.project import ReadProgram
    from rpl.proof.verdict import ProofResult
    from rpl.runtime.trace import RunResult
    from rpl.translation import Translation

# What a damaged or hostile project makes of its reader; a fault of ours ends the process and is reported as that.
_EXPECTED = (RplError, RecursionError, MemoryError, OSError)


@dataclass(frozen=True, slots=True)
class Answer:
    """The rows of a project and the files that were written for it, by their path in the project's own folder. digest:
    of what was read (Project.digest). seconds: how long it took."""

    rows: tuple[Row, ...]
    files: tuple[tuple[str, bytes], ...] = ()
    digest: str = ""
    seconds: float = 0.0


@dataclass(slots=True)
class _Work:
    project: Project
    asked: Asked
    diagnostics: Diagnostics = field(default_factory=Diagnostics)
    files: list[tuple[str, bytes]] = field(default_factory=list)
    robot: str | None = None

    def rows(self) -> Iterator[Row]:
        empty = Row(self.project.name)
        try:
            read = self._read()
            yield from self._rows(read, self._base(read))
        except _EXPECTED as error:
            yield replace(empty, outcome=rows.FAILED, reason=self._here(_said(error)))

    def _read(self) -> ReadProgram:
        from rpl.inventory.robots import arm_of
        from rpl.project import check_loading, read_program

        read = read_program(self.project.paths, self.asked.dialect, self.diagnostics)
        if self.asked.kind not in (RUN, TRANSLATE):
            check_loading(read, self.diagnostics)
        self.robot = self.asked.robot or (named.robot if (named := arm_of(read)) is not None else None)
        return read

    def _base(self, read: ReadProgram) -> Row:
        """What was read. Files with the ending of a program that are none are strangers, as in any folder."""
        from rpl.project import NOT_A_PROGRAM, SIDE_FILE

        strangers, errors = list[Diagnostic](), list[Diagnostic]()
        for one in self.diagnostics.of(Severity.ERROR):
            (strangers if one.code in (NOT_A_PROGRAM, SIDE_FILE) else errors).append(one)
        if not read.files and not errors:
            return Row(self.project.name, outcome=rows.NO_PROGRAM, reason=self._told(strangers[0]) if strangers else "")
        base = Row(
            self.project.name,
            " ".join(read.dialects),
            len(read.files),
            sum(one.statements for one in read.files),
            sum(one.opaque for one in read.files),
            len(errors),
            len(self.diagnostics.of(Severity.WARNING)),
        )
        return replace(base, outcome=rows.ERRORS, reason=self._told(errors[0])) if errors else base

    def _rows(self, read: ReadProgram, base: Row) -> Iterator[Row]:
        if base.outcome != rows.GOOD or self.asked.kind not in (RUN, TRANSLATE):
            yield base
        elif self.asked.kind == RUN:
            yield from self._runs(read, replace(base, robot=self.robot))
        else:
            yield self._translation(read, replace(base, robot=self.robot))

    # ---- running

    def _runs(self, read: ReadProgram, base: Row) -> Iterator[Row]:
        from rpl.simulation import run_program

        entries = _entries(read, self.diagnostics)
        if not entries:
            yield replace(base, outcome=rows.NO_ENTRY, reason="no routine of it can be started")
        for entry in entries:
            begun = replace(base, entry=entry)
            try:
                result = run_program(read.program, self.robot, None, entry, limits=self.asked.limits)
            except _EXPECTED as error:
                yield replace(begun, outcome=rows.FAILED, reason=self._here(_said(error)))
                continue
            yield self._ran(begun, result)

    def _ran(self, begun: Row, result: RunResult) -> Row:
        fault, ended = result.fault, result.status in ("finished", "stopped")
        return replace(
            begun,
            outcome=rows.GOOD if ended else result.status,
            reason=self._here(fault.message) if fault is not None else "",
            status=result.status,
            time_s=round(result.time_s, 6),
            moves=result.moves,
            fault=fault.code if fault is not None else None,
            place=self._place(fault.origin.file, fault.origin.line) if fault is not None else None,
        )

    # ---- translating

    def _translation(self, read: ReadProgram, base: Row) -> Row:
        from rpl.report.readiness import readiness
        from rpl.translation import translate_program

        reports = Diagnostics()
        made = translate_program(read, self.asked.target, self.robot, self.asked.to_robot, reports)
        proof = _proof(read, made, self.asked, self.robot) if self.asked.prove and not reports.has_errors else None
        verdict = proof.verdict if proof is not None else ""
        ready = readiness(read, reports, verdict)
        outcome, reason = self._outcome(reports, verdict, proof.headline() if proof is not None else "")
        if outcome != rows.ERRORS:
            self.files = [(file.path, file.data) for file in (*made.files, *made.setup)]
        return replace(
            base,
            outcome=outcome,
            reason=reason,
            written=len(self.files),
            losses=len(reports.of(Severity.LOSS)),
            stops=ready.open_statements + ready.unplaced,
            ready=ready.word if outcome != rows.ERRORS else "not ready",
            verdict=verdict or None,
        )

    def _outcome(self, reports: Diagnostics, verdict: str, headline: str) -> tuple[str, str]:
        errors, losses = reports.of(Severity.ERROR), reports.of(Severity.LOSS)
        if errors:
            return rows.ERRORS, self._told(errors[0])
        if verdict in ("different", "undecided"):
            return verdict, headline
        if losses:
            return rows.GUARDED, self._told(losses[0])
        return (rows.ALIKE, headline) if verdict == rows.ALIKE else (rows.GOOD, "")

    # ---- words

    def _told(self, item: Diagnostic) -> str:
        return (
            f"{self._place(item.origin.file, item.origin.line)}: {item.message}" if item.origin.file else item.message
        )

    def _here(self, text: str) -> str:
        """The text without the place of the archive, which may be another tomorrow."""
        return text.replace(f"{self.project.root}/", "")

    def _place(self, file: str, line: int) -> str:
        return f"{self.project.inside(file)}:{line}" if file else ""


def answer(project: Project, asked: Asked) -> Iterator[Row | Answer]:
    """Each row as soon as it is known, and at the end the whole answer."""
    started = time.perf_counter()
    digest = project.digest()
    work, found = _Work(project, asked), list[Row]()
    for row in work.rows():
        found.append(row)
        yield row
    yield Answer(tuple(found), tuple(work.files), digest, time.perf_counter() - started)


def _entries(read: ReadProgram, diagnostics: Diagnostics) -> Sequence[str | None]:
    """The routine that a run begins with, or every program that people can start where that is not clear."""
    from rpl.inventory.contents import contents
    from rpl.simulation import MOTION_TASK, entry_name

    program = read.program
    if any(task.kind == MOTION_TASK for task in program.tasks):
        return (None,)
    clear = entry_name(program)
    return (clear,) if clear is not None else tuple(one.name for one in contents(read, diagnostics).entries)


def _proof(read: ReadProgram, made: Translation, asked: Asked, robot: str | None) -> ProofResult:
    """What was written is read back, and both are run."""
    from rpl.project import read_sources
    from rpl.proof.prove import prove_programs
    from rpl.proof.wiring import with_signal_names
    from rpl.simulation import entry_name
    from rpl.source import source_from_bytes

    sources = [source_from_bytes(file.path, file.data) for file in made.files]
    back = read_sources(sources, asked.target, Diagnostics()).program
    entry = entry_name(read.program)
    to_entry = back.entry or made.renamed.get(entry, entry) if entry else None
    arms = robot, asked.to_robot or robot
    second = with_signal_names(back, made.program)
    return prove_programs(read.program, second, *arms, entry=entry, to_entry=to_entry, limits=asked.limits)


def _said(error: BaseException) -> str:
    if isinstance(error, RecursionError | MemoryError):
        return f"the project is too large or too deeply nested ({type(error).__name__})"
    return " ".join(str(error).split())
