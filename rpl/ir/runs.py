"""Runs: consecutive moves of one shape as one node, their numbers in columns.

Point programs are long lists of one line. A run keeps the first move as a sample, the numbers of all moves as an array,
and where each of them stands; any of them comes out again as the reader would have made it, with the spelling that its
numbers have in the source. Who does not know runs gets a program without them (`expanded`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import TYPE_CHECKING, TypeVar, cast

from rpl.ir.expressions import Expression, IntLiteral, RealLiteral, Unary
from rpl.ir.motion import Move
from rpl.source import NOWHERE, Origin, Source

if TYPE_CHECKING:  # who only starts the program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

# What a number in a column looks like: a sign, and so few digits that a float holds it.
CELL = r"(-?(?:[0-9]{1,12}\.[0-9]{0,12}|\.[0-9]{1,12}|[0-9]{1,12}))"

Spellings = tuple[str, ...]
Row = TypeVar("Row")
Make = Callable[[Row, Origin], object]  # what a node is in one move, which stands at that place


class Columns:
    """The numbers of a run, and where its moves stand in the text of the source. No node: a walk passes it by.

    cells: by identity the expressions in the sample that stand for the columns, in their order: a number, or the Unary
    of a negative one. line: matches one move, its groups are the spellings of the numbers. values[i, c]: number c of
    move i. starts, ends: the span of each move. placed: the sign in front of a number has the place of its statement
    (a matter of the reader). mixed: columns that hold whole numbers and others."""

    __slots__ = ("cells", "ends", "line", "mixed", "placed", "source", "starts", "values")

    def __init__(
        self,
        source: Source,
        line: re.Pattern[str],
        cells: tuple[Expression, ...],
        values: NDArray[np.float64],
        spans: tuple[NDArray[np.int64], NDArray[np.int64]],
        placed: bool,
        mixed: frozenset[int],
    ) -> None:
        self.source, self.line, self.cells, self.values, self.placed = source, line, cells, values, placed
        self.mixed = mixed
        self.starts, self.ends = spans

    def __len__(self) -> int:
        return len(self.starts)

    def spellings(self, at: int) -> Spellings:
        """The numbers of one move as they are written."""
        found = self.line.match(self.source.text, int(self.starts[at]))
        assert found is not None  # it was found by this pattern
        return found.groups()

    def origin(self, at: int) -> Origin:
        return Origin(self.source, int(self.starts[at]), int(self.ends[at]))


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """Moves of one shape in a row. sample: the first of them."""

    sample: Move
    columns: Columns = field(repr=False)
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)

    def __len__(self) -> int:
        return len(self.columns)

    def moves(self, first: int = 0) -> Iterator[Move]:
        """All of them from that one on, each as if it had been read alone."""
        columns, make = self.columns, self.maker()
        for at in range(first, len(columns)):
            yield make(columns.spellings(at), columns.origin(at))

    def maker(self) -> Callable[[Spellings, Origin], Move]:
        """make(spellings, origin): the move with these numbers, at that place."""
        sample, placed = self.sample, self.columns.placed
        cells: dict[int, Make[Spellings]] = {
            id(cell): _number_at(at, placed) for at, cell in enumerate(self.columns.cells)
        }
        made = maker_of(sample, cells, sample.origin)
        return cast(Callable[[Spellings, Origin], Move], made or (lambda spellings, origin: sample))

    def rewritten(self, sample: Move, rewrite: Callable[[Move], Move]) -> Run | None:
        """The run with a sample that `rewrite` has made of its own. None where a number is not there once, or where the
        numbers decide what is made."""
        wanted = {id(cell) for cell in self.columns.cells}
        found = [key for key in map(id, below(sample)) if key in wanted]
        if not len(found) == len(wanted) == len(set(found)):
            return None
        done, other = replace(self, sample=sample), self.other_kinds()
        return done if rewrite(self.with_cells(other)) == done.with_cells(other) else None

    def other_kinds(self) -> tuple[Expression, ...]:
        """Cells of another move: of the other kind, whole number or not, in columns that have both."""
        columns = self.columns
        whole = [(at in columns.mixed) == _is_real(cell) for at, cell in enumerate(columns.cells)]
        return tuple(literal("1" if one else "1.5") for one in whole)

    def with_cells(self, cells: tuple[Expression, ...], origin: Origin | None = None) -> Move:
        """The sample with other expressions in place of its numbers, at that place (its own without one)."""
        other: dict[int, Make[Spellings]] = {
            id(old): always(new) for old, new in zip(self.columns.cells, cells, strict=True)
        }
        made = maker_of(self.sample, other, self.sample.origin)
        return cast(Move, made((), origin or self.sample.origin)) if made is not None else self.sample


def _is_real(cell: Expression) -> bool:
    return isinstance(cell.operand if isinstance(cell, Unary) else cell, RealLiteral)


def literal(spelling: str, origin: Origin = NOWHERE) -> Expression:
    """The number of a spelling; `origin`: the place of its sign."""
    digits = spelling.removeprefix("-")
    number = RealLiteral(float(digits), digits) if "." in digits else IntLiteral(int(digits), digits)
    return number if digits is spelling else Unary("-", number, origin=origin)


def _number_at(column: int, placed: bool) -> Make[Spellings]:
    return lambda spellings, origin: literal(spellings[column], origin if placed else NOWHERE)


def maker_of(node: object, cells: Mapping[int, Make[Row]], origin: Origin) -> Make[Row] | None:
    """What makes the node of another move: other numbers, and that move's place where the node has the sample's. None:
    it is the same in all moves."""
    if node is origin:
        return lambda row, there: there
    if id(node) in cells:
        return cells[id(node)]
    if isinstance(node, tuple):
        return _maker_of_tuple(node, cells, origin)
    if isinstance(node, Origin | type) or not is_dataclass(node):
        return None
    kind: Callable[..., object] = node.__class__
    names = tuple(one.name for one in fields(node))
    made = [maker_of(getattr(node, name), cells, origin) for name in names]
    if not any(made):
        return None
    changing = tuple((name, make) for name, make in zip(names, made, strict=True) if make is not None)
    sample = {name: getattr(node, name) for name in names}

    def build(row: Row, there: Origin) -> object:
        given = sample.copy()
        for name, make in changing:
            given[name] = make(row, there)
        return kind(**given)

    return build


def always(node: object) -> Make[Row]:
    """The same in each move."""
    return lambda row, origin: node


def _maker_of_tuple(node: tuple[object, ...], cells: Mapping[int, Make[Row]], origin: Origin) -> Make[Row] | None:
    pairs = [part for part in node if isinstance(part, tuple) and len(part) == 2 and not is_dataclass(part[0])]
    if len(pairs) == len(
        node
    ):  # parts with their names: only these are made, most of what there is in a list of points
        inner = [(name, maker_of(value, cells, origin), (name, value)) for name, value in pairs]
        if not any(make for _, make, _ in inner):
            return None
        return lambda row, there: tuple(
            [pair if make is None else (name, make(row, there)) for name, make, pair in inner]
        )
    parts = [maker_of(part, cells, origin) for part in node]
    if not any(parts):
        return None
    made = tuple((make or always(part)) for make, part in zip(parts, node, strict=True))
    return lambda row, there: tuple([make(row, there) for make in made])


def below(node: object) -> Iterator[object]:
    """Every object of a node, tuples entered."""
    stack = [node]
    while stack:
        one = stack.pop()
        if isinstance(one, tuple):
            stack.extend(one)
            continue
        yield one
        if is_dataclass(one) and not isinstance(one, Origin | type):
            stack.extend(getattr(one, each.name) for each in fields(one))


def identical(one: object, other: object) -> bool:
    """Equal to the spelling, the place and the sign of a zero, which comparing nodes leaves out."""
    if one.__class__ is not other.__class__:
        return False
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(identical, one, other))
    if is_dataclass(one) and not isinstance(one, Source):
        return all(identical(getattr(one, each.name), getattr(other, each.name)) for each in fields(one))
    return one is other or (one == other and (one != 0 or str(one) == str(other)))
