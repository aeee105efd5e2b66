"""Moves of one shape as text: the line is made once, with marks for its numbers, and filled in for each move.

The line is printed with the column numbers themselves, so that a printer which asks for their values (is this a zone
that has a name?) is told that the moves differ; then they are printed one by one, and so they are where a mark is
missing or where one of the moves that are checked comes out otherwise.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from rpl import ir
from rpl.ir.columns import LooksInsideError
from rpl.ir.rows import Cell

# The text of a number that is not negative, or has been calculated: its value and how the source spells it ("": not).
NumberText = Callable[[float, str], str]
Print = Callable[[ir.Move], list[str]]

_MARK = "\2"
_MARKS = re.compile(f"{_MARK}([0-9]+){_MARK}")


def mark_of(literal: ir.IntLiteral | ir.RealLiteral) -> str | None:
    """What a printer writes for a number that is filled in; None for any other one."""
    return literal.spelling if literal.spelling.startswith(_MARK) else None


def lines_of_rows(rows: ir.Rows, print: Print, number: NumberText) -> list[str]:
    """The lines of all moves. number: as numbers are written in the places where the rows have theirs."""
    checked = rows.cells.stretch.checked
    texts: dict[int, str] = {}
    for group, moves in rows.groups(rows.numbers()):
        texts.update(zip(moves, _filled(group, moves, print, number), strict=True))
    for group, moves in rows.groups(checked):
        if any(
            text != "\n".join(print(move))
            for text, move in zip(_filled(group, moves, print, number), group.these(moves), strict=True)
        ):
            return [line for move in rows.moves() for line in print(move)]
    return [line for at in rows.numbers() for line in texts[at].split("\n")]


def _filled(rows: ir.Rows, moves: Sequence[int], print: Print, number: NumberText) -> list[str]:
    """The texts of some of the moves."""
    cells = list(rows.cells.by_identity.values())
    try:
        pieces = _MARKS.split("\n".join(print(rows.marked([_marked(cell, at) for at, cell in enumerate(cells)]))))
    except LooksInsideError:
        pieces = []
    order = [int(mark) for mark in pieces[1::2]]
    if set(order) != set(range(len(cells))):
        return ["\n".join(print(move)) for move in rows.these(moves)]
    columns = [cell.texts(moves, number) for cell in cells]
    form = "%s".join(piece.replace("%", "%%") for piece in pieces[::2])
    return [form % row for row in zip(*(columns[at] for at in order), strict=True)]


def _marked(cell: Cell, at: int) -> ir.IntLiteral | ir.RealLiteral:
    literal, spelling = cell.literal, f"{_MARK}{at}{_MARK}"
    if isinstance(literal, ir.IntLiteral):
        return ir.IntLiteral(literal.value, spelling)
    return ir.RealLiteral(literal.value, spelling)
