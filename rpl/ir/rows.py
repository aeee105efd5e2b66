"""Rows: what a stretch of a run has become in a translated program, as one node: one move and the numbers of all.

Where the places of moves are data with numbers, a move names its place (`Name("P17")`), and that name is a cell too."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, cast

from rpl.ir.columns import CHOSEN, KEPT, LooksInsideError, Stretch, column_of
from rpl.ir.expressions import Expression, IntLiteral, Name, RealLiteral, Unary
from rpl.ir.motion import Move
from rpl.ir.runs import Make, always, below, literal, maker_of
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:  # who reads no long program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

# How a number of a row is written as a node: with a point or whole, behind a sign or not.
REAL, WHOLE, NEGATIVE_REAL, NEGATIVE_WHOLE = range(4)


class Cell:
    """One number of the moves. literal: that of the sample; signed: a negative one that was calculated is a sign and a
    number."""

    __slots__ = ("choice", "column", "literal", "placed", "signed", "stretch", "values")

    def __init__(self, stretch: Stretch, literal: IntLiteral | RealLiteral, signed: bool) -> None:
        spelling, column = literal.spelling, column_of(literal.value)
        self.literal, self.stretch, self.signed = literal, stretch, signed
        self.placed = stretch.run.columns.placed
        self.values = None if column is None else column.values
        self.column = int(spelling[1:]) if spelling.startswith(KEPT) else -1
        self.choice = stretch.choices[int(spelling[1:])] if spelling.startswith(CHOSEN) else None

    def number(self, at: int, origin: Origin) -> Expression:
        """The number of move `at` of the run, which stands at that place."""
        if self.column >= 0:
            return literal(self.stretch.spellings[at][self.column], origin if self.placed else NOWHERE)
        if self.choice is not None:
            one = self.choice.options[int(self.choice.answers[self.stretch.row(at)])]
            if not isinstance(one, IntLiteral | RealLiteral) or column_of(one.value) is None:
                return one
            return Cell(self.stretch, one, self.signed).number(at, origin)
        assert self.values is not None  # only literals with columns are cells
        value = float(self.values[self.stretch.row(at)])
        if isinstance(self.literal, IntLiteral):
            return IntLiteral(int(value))
        if self.signed and value < 0.0:
            return Unary("-", RealLiteral(-value))
        return RealLiteral(value)

    def written(self, moves: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """How the numbers of these moves are written (REAL ...), and the number behind the sign that is written."""
        import numpy as np

        if self.choice is not None or self.values is None:
            raise LooksInsideError(self.stretch)
        whole = np.full(len(moves), isinstance(self.literal, IntLiteral))
        if self.column >= 0:
            columns = self.stretch.run.columns
            values = columns.values[moves, self.column]
            negative = np.signbit(values)
            if self.column in columns.mixed:
                spellings = self.stretch.spellings
                whole = np.array(["." not in spellings[at][self.column] for at in moves.tolist()])
        else:
            values = self.values[self.stretch.rows_of(moves)]
            negative = (values < 0.0) & ~whole if self.signed else np.zeros(len(moves), dtype=np.bool_)
        return negative * 2 + whole, np.where(negative, -values, values)

    def signed_numbers(self, moves: NDArray[np.int64]) -> NDArray[np.float64]:
        """The numbers of these moves, with their signs."""
        import numpy as np

        kinds, numbers = self.written(moves)
        return np.where(kinds >= NEGATIVE_REAL, -numbers, numbers)

    def texts(self, moves: Sequence[int], number: Callable[[float, str], str]) -> list[str]:
        """The numbers of these moves, written by `number(value, spelling)`; in front of it the sign."""
        if self.column >= 0:
            written = [self.stretch.spellings[at][self.column] for at in moves]
            return [f"-{_text(one[1:], number)}" if one[0] == "-" else _text(one, number) for one in written]
        if (
            self.choice is None
            and self.values is not None
            and not (self.signed or isinstance(self.literal, IntLiteral))
        ):
            return [number(value, "") for value in self.values[list(map(self.stretch.row, moves))].tolist()]
        return [_of_expression(self.number(at, NOWHERE), number) for at in moves]


def _text(digits: str, number: Callable[[float, str], str]) -> str:
    return number(float(digits) if "." in digits else int(digits), digits)


def _of_expression(one: Expression, number: Callable[[float, str], str]) -> str:
    if isinstance(one, Unary):
        return f"-{_of_expression(one.operand, number)}"
    assert isinstance(one, IntLiteral | RealLiteral)  # as `number` makes them
    return number(one.value, one.spelling)


class PlaceCell(Cell):
    """The name of the place that each move goes to: a stem and a number. node: the name in the sample; numbers: of the
    moves of the stretch. `placed`: the name has the place of its move."""

    __slots__ = ("node", "numbers", "stem")

    def __init__(self, stretch: Stretch, node: Name, stem: str, numbers: NDArray[np.int64], placed: bool) -> None:
        self.node, self.stem, self.numbers, self.placed = node, stem, numbers, placed
        self.stretch, self.literal, self.signed = stretch, IntLiteral(int(numbers[0])), False
        self.values, self.column, self.choice = None, -1, None

    def number(self, at: int, origin: Origin) -> Expression:
        number = self.numbers[at - self.stretch.first]
        return Name(f"{self.stem}{number}", origin=origin if self.placed else self.node.origin)

    def texts(self, moves: Sequence[int], number: Callable[[float, str], str]) -> list[str]:
        raise LooksInsideError(self.stretch)


class Cells:
    """The numbers of a stretch. No node: a walk passes it by. by_identity: of the literals in the sample, or in the
    name of its place."""

    __slots__ = ("by_identity", "stretch")

    def __init__(self, stretch: Stretch, sample: object, signed: bool) -> None:
        self.stretch = stretch
        self.by_identity: dict[int, Cell] = {}
        for node in below(sample):
            if isinstance(node, IntLiteral | RealLiteral) and column_of(node.value) is not None:
                self.by_identity[id(node)] = Cell(stretch, node, signed)

    @property
    def signed(self) -> bool:
        return any(cell.signed for cell in self.by_identity.values())

    def standing_in(self, sample: object) -> bool:
        """Is each cell in the sample still? A pass may have made it anew."""
        return self.by_identity.keys() <= set(map(id, below(sample)))

    @property
    def place(self) -> PlaceCell | None:
        """The one cell of moves whose place has a name, where that is the one thing in which they differ."""
        cells = list(self.by_identity.values())
        return cells[0] if len(cells) == 1 and isinstance(cells[0], PlaceCell) else None


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Moves of one shape in a row. sample: all of them, with column numbers."""

    sample: Move
    cells: Cells = field(repr=False)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)

    def __len__(self) -> int:
        return len(self.numbers())

    def numbers(self) -> range:
        """Of its moves, in the run that they are from."""
        return range(self.cells.stretch.first, self.cells.stretch.end)

    def moves(self) -> Iterator[Move]:
        return self.these(self.numbers())

    def these(self, numbers: Iterable[int]) -> Iterator[Move]:
        """Moves of the run, by their numbers in it, each as if it had been translated alone."""
        columns = self.cells.stretch.run.columns
        makes: dict[int, Make[int]] = {key: cell.number for key, cell in self.cells.by_identity.items()}
        make = maker_of(self.sample, makes, self.sample.origin)
        for at in numbers:
            yield cast(Move, make(at, columns.origin(at))) if make is not None else self.sample

    def naming(self, stem: str, numbers: NDArray[np.int64], first: int) -> Rows:
        """The moves with names for the places that they go to; first: whose name the sample gets."""
        old, stretch = self.sample.target, self.cells.stretch
        placed = old.origin is self.sample.origin
        name = Name(f"{stem}{numbers[first]}", origin=old.origin)
        cells = Cells(stretch, (), False)
        cells.by_identity[id(name)] = PlaceCell(stretch, name, stem, numbers, placed)
        return Rows(replace(self.sample, target=name), cells, origin=self.origin)

    def marked(self, marks: Sequence[Expression]) -> Move:
        """The move with other numbers, in the order of its cells."""
        makes: dict[int, Make[int]] = {
            key: always(mark) for key, mark in zip(self.cells.by_identity, marks, strict=True)
        }
        make = maker_of(self.sample, makes, self.sample.origin)
        return self.sample if make is None else cast(Move, make(0, self.origin))

    def groups(self, moves: Sequence[int]) -> Iterator[tuple[Rows, list[int]]]:
        """The moves by what is chosen in them, each group with rows in which nothing is left to choose."""
        choices = {key: cell.choice for key, cell in self.cells.by_identity.items() if cell.choice is not None}
        found: dict[tuple[int, ...], list[int]] = {}
        for at in moves:
            row = self.cells.stretch.row(at)
            found.setdefault(tuple(int(choice.answers[row]) for choice in choices.values()), []).append(at)
        for answers, some in found.items():
            makes: dict[int, Make[int]] = {
                key: always(choice.options[answer])
                for (key, choice), answer in zip(choices.items(), answers, strict=True)
            }
            make = maker_of(self.sample, makes, self.sample.origin)
            sample = self.sample if make is None else cast(Move, make(0, self.sample.origin))
            yield Rows(sample, Cells(self.cells.stretch, sample, self.cells.signed), origin=self.origin), some
