"""The points of moves of one shape, numbered all at once as `points` numbers them one by one.

Equal positions share a number, whichever way they came; so each position has a key, by what it says and not by who says
it. A point that a move by itself goes to later is declared by itself then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import repeat
from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.rows import NEGATIVE_REAL, NEGATIVE_WHOLE, REAL, WHOLE, Cell, Cells

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Key = tuple[object, ...]
_KINDS = 4
_MARK = "\1"


@dataclass(slots=True)
class Keys:
    """Keys of written positions: the number of their shape, and their numbers."""

    shapes: dict[tuple[object, ...], int] = field(default_factory=dict)

    def key(self, value: ir.Aggregate) -> Key:
        shape, numbers = list[object](), list[float | None]()
        _said(value, shape, numbers, {})
        return self.shapes.setdefault(tuple(shape), len(self.shapes)), *numbers

    def keys(self, value: ir.Aggregate, cells: Cells, moves: NDArray[np.int64]) -> list[Key]:
        """Those of some moves of a stretch."""
        import numpy as np

        shape, numbers = list[object](), list[float | None]()
        found: list[tuple[int, Cell]] = []  # cells with the place of their kind in the shape
        _said(value, shape, numbers, cells.by_identity, found)
        written = [cell.written(moves) for _, cell in found]
        kinds = np.stack([one for one, _ in written]) if written else np.zeros((0, len(moves)), dtype=np.int64)
        sums = _KINDS ** np.arange(len(written), dtype=np.int64) @ kinds
        combinations, firsts, which = np.unique(sums, return_index=True, return_inverse=True)
        of_kinds = []
        for first in firsts[: len(combinations)].tolist():
            for (place, _), kind in zip(found, kinds[:, first].tolist(), strict=True):
                shape[place] = kind
            of_kinds.append(self.shapes.setdefault(tuple(shape), len(self.shapes)))
        columns: Iterator[list[float]] = iter([one.tolist() for _, one in written])
        parts = [next(columns) if number is None else repeat(number) for number in numbers]
        return list(zip(np.array(of_kinds)[which].tolist(), *parts, strict=False))


def _said(
    value: ir.Expression,
    shape: list[object],
    numbers: list[float | None],
    cells: dict[int, Cell],
    found: list[tuple[int, Cell]] | None = None,
) -> None:
    """What a position says besides its numbers, and these; None for a cell."""
    cell = cells.get(id(value))
    if cell is not None and found is not None:
        found.append((len(shape), cell))
        shape.append(REAL)
        numbers.append(None)
        return
    match value:
        case ir.Aggregate(entries=entries, type_name=word):
            shape += ("(", word)
            for name, one in entries:
                shape.append(name)
                _said(one, shape, numbers, cells, found)
            shape.append(")")
        case ir.Unary(op="-", operand=ir.IntLiteral(value=number)):
            shape.append(NEGATIVE_WHOLE)
            numbers.append(number)
        case ir.Unary(op="-", operand=ir.RealLiteral(value=number)):
            shape.append(NEGATIVE_REAL)
            numbers.append(number)
        case ir.IntLiteral(value=number):
            shape.append(WHOLE)
            numbers.append(number)
        case ir.RealLiteral(value=number):
            shape.append(REAL)
            numbers.append(number)
        case _:
            shape.append(value)


def shown_in_rows(value: ir.Aggregate, cells: Cells, moves: NDArray[np.int64]) -> list[str]:
    """The positions of some moves in few signs, as `shown` does it."""
    columns: list[list[str]] = []

    def marked(part: ir.Expression) -> str | None:
        cell = cells.by_identity.get(id(part))
        if cell is None:
            return None
        columns.append([one.removesuffix(".0") for one in map(repr, cell.signed_numbers(moves).tolist())])
        return _MARK

    form = shown(value, marked).replace("%", "%%").replace(_MARK, "%s")
    return [form % row for row in zip(*columns, strict=True)]


def shown(value: ir.Expression, marked: Callable[[ir.Expression], str | None] = lambda _: None) -> str:
    """A written position in few signs: `x 450, y -350, ...`; marked: what stands for some of its numbers."""
    if (mark := marked(value)) is not None:
        return mark
    match value:
        case ir.Aggregate(entries=entries):
            parts = ((name, shown(one, marked)) for name, one in entries)
            return ", ".join(f"{name} {one}" if name else one for name, one in parts)
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return repr(number).removesuffix(".0")
        case ir.Unary(op="-", operand=operand):
            return f"-{shown(operand, marked)}"
        case ir.TextLiteral(value=text):
            return text
        case ir.BoolLiteral(value=truth):
            return str(truth).lower()
    return type(value).__name__


def of_one_shape(rows: ir.Rows) -> bool:
    """Do the moves differ in nothing but the numbers of the position that they go to?"""
    own = Cells(rows.cells.stretch, rows.sample.target, rows.cells.signed).by_identity
    return own.keys() == rows.cells.by_identity.keys() and all(cell.choice is None for cell in own.values())
