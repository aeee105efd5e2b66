"""How far a translation is from a robot: the line that stands before everything else about it.

It says what has to be done by hand, in moves and in statements of the source, and never more than the reports behind it
say: with a stop nothing is ready, with an approximation neither, and who has not proved is told so.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rpl import ir
from rpl.diagnostics import Diagnostic, Severity
from rpl.ir.walk import statements
from rpl.project import ReadProgram
from rpl.showing import counted

READY, WORKABLE, NOT_READY = "ready", "workable", "not ready"
# Verdicts of a proof that leave a translation as ready as its reports, and those that do not.
_EQUAL, _DIFFERENT = "equal", "different"

_Place = tuple[str, int]


@dataclass(frozen=True, slots=True)
class Readiness:
    """What needs somebody. moves, statements: of the source; open_moves, open_statements: those of them with an error
    or a guarded stop; unplaced: stops that belong to no statement; remarks: places with a warning. `proved`: verdict of
    a proof, empty without one. `written`: there is a result."""

    moves: int
    open_moves: int
    statements: int
    open_statements: int
    unplaced: int
    remarks: int
    written: bool = True
    proved: str = ""

    @property
    def word(self) -> str:
        """ready, workable or not ready. Where more is stopped than carried over, nobody works with the result."""
        stopped = self.open_statements + self.unplaced
        if not self.written or self.proved == _DIFFERENT:
            return NOT_READY
        if 2 * self.open_moves > self.moves or 2 * self.open_statements > self.statements:
            return NOT_READY
        return WORKABLE if stopped or self.remarks or self.proved not in ("", _EQUAL) else READY

    def as_text(self) -> str:
        """`workable: 3 of 412 moves need you; 1198 of 1203 statements written (99.5 %); ...; not proved`."""
        said = [f"{self.open_moves} of {counted(self.moves, 'move')} need you"] if self.open_moves else []
        if not self.written:
            return "; ".join([f"{self.word}: nothing was written, the errors come first: {self._open()}", *said])
        carried = self.statements - self.open_statements
        share = f" ({_floored(carried, self.statements)} %)" if self.open_statements else ""
        said.append(f"{carried} of {counted(self.statements, 'statement')} written{share}")
        if self.open_statements or self.unplaced:
            said.append(f"{self._open()} stop{'s' * (self.open_statements + self.unplaced == 1)} the program")
        if self.remarks:
            said.append(f"{counted(self.remarks, 'place')} to look at")
        said.append(f"the proof says {self.proved}" if self.proved else "not proved")
        return f"{self.word}: {'; '.join(said)}"

    def _open(self) -> str:
        places = [counted(self.open_statements, "statement")] if self.open_statements else []
        places += [counted(self.unplaced, "report") + " without a place"] if self.unplaced else []
        return " and ".join(places)

    def as_json(self) -> dict[str, object]:
        """A stable document."""
        return {
            "verdict": self.word,
            "moves": self.moves,
            "moves_open": self.open_moves,
            "statements": self.statements,
            "statements_open": self.open_statements,
            "unplaced": self.unplaced,
            "remarks": self.remarks,
            "proof": self.proved or None,
        }


def readiness(read: ReadProgram, reports: Iterable[Diagnostic], proved: str = "", written: bool = True) -> Readiness:
    """What the reports of a translation leave to do."""
    paths = {source.path for source in read.sources}
    placed: dict[_Place, None] = {}
    remarks: set[tuple[str, int, int]] = set()
    unplaced = 0
    for item in reports:
        origin = item.origin
        if item.severity >= Severity.LOSS:
            if origin.file in paths:
                placed[origin.file, origin.start] = None
            else:
                unplaced += 1
        elif item.severity == Severity.WARNING:
            remarks.add((origin.file, origin.start, origin.end))
    total, stopped = _moves(read, placed)
    return Readiness(
        total,
        stopped,
        sum(file.statements for file in read.files),
        min(len(placed), sum(file.statements for file in read.files)),
        unplaced,
        len(remarks),
        written,
        proved,
    )


def _moves(read: ReadProgram, stops: Iterable[_Place]) -> tuple[int, int]:
    """The moves of the source, and those in whose text a report stands."""
    starts: dict[str, list[int]] = {}
    for path, start in sorted(stops):
        starts.setdefault(path, []).append(start)
    total = stopped = 0
    for path, spans in _spans(read):
        known = starts.get(path, [])
        for start, end in spans:
            at = bisect_left(known, start)
            stopped += at < len(known) and known[at] < max(end, start + 1)
            total += 1
    return total, stopped


def _spans(read: ReadProgram) -> Iterator[tuple[str, Iterable[tuple[int, int]]]]:
    """File and spans of the moves; each place once, although the normal form may have made two moves of one."""
    seen: set[_Place] = set()
    paths = {source.path for source in read.sources}
    for node in statements(read.reduced):
        match node:
            case ir.Run() if node.origin.file in paths:
                columns = node.columns
                seen.add((node.origin.file, int(columns.starts[0])))  # its sample is the next node
                yield node.origin.file, zip(columns.starts.tolist(), columns.ends.tolist(), strict=True)
            case ir.Move() | ir.MoveExternal():
                place = node.origin.file, node.origin.start
                if node.origin.file in paths and place not in seen:
                    seen.add(place)
                    yield node.origin.file, [(node.origin.start, node.origin.end)]


def _floored(part: int, whole: int) -> str:
    """A share in percent that is never more than the truth."""
    return f"{1000 * part // whole / 10:g}" if whole else "0"
