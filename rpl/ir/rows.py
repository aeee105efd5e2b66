"""Rows: what a stretch of a run has become in a translated program, as one node: one move and the numbers of all."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import cast

from rpl.ir.columns import CHOSEN, KEPT, Stretch, column_of
from rpl.ir.expressions import Expression, IntLiteral, RealLiteral, Unary
from rpl.ir.motion import Move
from rpl.ir.runs import Make, always, below, literal, maker_of
from rpl.source import NOWHERE, Origin


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


class Cells:
    """The numbers of a stretch. No node: a walk passes it by. by_identity: of the literals in the sample."""

    __slots__ = ("by_identity", "stretch")

    def __init__(self, stretch: Stretch, sample: Move, signed: bool) -> None:
        self.stretch = stretch
        self.by_identity: dict[int, Cell] = {}
        for node in below(sample):
            if isinstance(node, IntLiteral | RealLiteral) and column_of(node.value) is not None:
                self.by_identity[id(node)] = Cell(stretch, node, signed)


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
            signed = any(cell.signed for cell in self.cells.by_identity.values())
            yield Rows(sample, Cells(self.cells.stretch, sample, signed), origin=self.origin), some
