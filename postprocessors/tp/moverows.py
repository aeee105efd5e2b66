"""Moves that differ in the number of their point: a few are written as any other, those between as they are."""

from __future__ import annotations

from typing import Protocol

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.columns import LooksInsideError
from rpl.writing.statements import CannotSayError

from .lines import Line
from .motion import Motion
from .positions import Points

_SHORTEST = 3


class Printing(Protocol):
    """What writes the lines of a program (see statements.Printer)."""

    lines: list[Line]
    diagnostics: Diagnostics
    points: Points
    motion: Motion

    def move(self, move: ir.Move) -> None: ...


def write_rows(printer: Printing, rows: ir.Rows) -> None:
    """The first two moves and the last are written one by one, those between as the second. Raises LooksInsideError
    where that is not what comes of each."""
    stretch, place, numbers = rows.cells.stretch, rows.cells.place, rows.numbers()
    if place is None or rows.sample.triggers or len(numbers) < _SHORTEST:
        raise LooksInsideError(stretch)
    first, second, last = rows.these((numbers[0], numbers[1], numbers[-1]))
    named, points = place.numbers.tolist(), printer.points
    try:
        printer.move(first)
        told, kept = len(printer.diagnostics), len(printer.lines)
        printer.move(second)
        printer.lines += lines_to(printer.lines[-1], [points.place(number) for number in named[2:-1]])
        points.used_as(points.order[-1], named[2:-1], map(stretch.run.columns.origin, numbers[2:-1]))
        printer.motion.last, printer.motion.place = None, ""
        printer.move(last)
    except CannotSayError:
        raise LooksInsideError(stretch) from None
    wanted = lines_to(printer.lines[kept], [points.place(named[-1])])
    alike = printer.lines[-1:] == wanted and len(printer.lines) == kept + len(numbers) - 1
    if not alike or len(printer.diagnostics) != told:
        raise LooksInsideError(stretch)


def lines_to(line: Line, targets: list[str]) -> list[Line]:
    """The line of a move (no circle) to other places."""
    words = dict(line.words or {})
    letter, settings = words["letter"], f"{words['speed']} {words['term']}{words['options']}    "
    return [Line(f"{letter} {one} {settings}", words={**words, "target": one}) for one in targets]
