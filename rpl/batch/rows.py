"""The rows of the result: one for each project, and where it is run one for each program that is started."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields

from rpl.batch.asked import RUN, TRANSLATE, Asked

Cell = str | int | float | None

# What came of a project.
GOOD = "good"
NO_PROGRAM = "no program"
ERRORS = "errors"
GUARDED, ALIKE = "guarded", "alike"
NO_ENTRY = "no entry"
NOT_WRITTEN = "not written"
TOO_LONG, LOST, FAILED = "too long", "lost", "failed"
# Nothing to do, and something to look at; all else is an answer `no`.
_FINE = (GOOD, NO_PROGRAM)
_TO_LOOK_AT = (GUARDED, ALIKE)
# A second try may give another answer.
PASSING = (TOO_LONG, LOST, NOT_WRITTEN)

_ALWAYS = ("project", "languages", "files", "statements", "unread", "errors", "warnings", "outcome", "reason")
_OF_A_RUN = ("robot", "entry", "status", "time_s", "moves", "fault", "place")
_OF_A_TRANSLATION = ("robot", "written", "losses", "stops", "ready")


@dataclass(frozen=True, slots=True)
class Row:
    """languages: joined by blanks. statements: read, `unread` those of them that could not be. errors, warnings:
    reports about the source. reason: of an outcome that is not good. entry, status, time_s (simulated), moves, fault,
    place: of a run. written: number of files; losses: reports of guarded stops, `stops` statements with one; ready:
    whether the result is; verdict: of the proof. seconds: how long it took."""

    project: str
    languages: str = ""
    files: int = 0
    statements: int = 0
    unread: int = 0
    errors: int = 0
    warnings: int = 0
    outcome: str = GOOD
    reason: str = ""
    robot: str | None = None
    entry: str | None = None
    status: str | None = None
    time_s: float | None = None
    moves: int | None = None
    fault: str | None = None
    place: str | None = None
    written: int | None = None
    losses: int | None = None
    stops: int | None = None
    ready: str | None = None
    verdict: str | None = None
    seconds: float | None = None

    def cells(self, columns: Iterable[str]) -> dict[str, Cell]:
        """The values of these columns."""
        return {name: getattr(self, name) for name in columns}


NUMBERS = {
    one.name: "float" if "float" in str(one.type) else "int" for one in fields(Row) if "str" not in str(one.type)
}


def columns(asked: Asked, timings: bool = False) -> tuple[str, ...]:
    """The columns of a batch: none that says how long something took here, unless it is asked for."""
    own = _OF_A_RUN if asked.kind == RUN else _OF_A_TRANSLATION if asked.kind == TRANSLATE else ()
    proof = ("verdict",) if asked.prove else ()
    return (*_ALWAYS, *own, *proof, *(("seconds",) if timings else ()))


def row_of(cells: Mapping[str, object]) -> Row:
    """The row that `cells` was made of; raises TypeError for another document."""
    return Row(**cells)  # type: ignore[arg-type]  # a document of JSON: other columns are a TypeError, which is asked for


def status(rows: Iterable[Row]) -> int:
    """Exit status: 0 all is good, 3 something is to be looked at, 1 some projects have errors."""
    outcomes = {row.outcome for row in rows}
    if outcomes.difference(_FINE, _TO_LOOK_AT):
        return 1
    return 3 if outcomes.intersection(_TO_LOOK_AT) else 0
