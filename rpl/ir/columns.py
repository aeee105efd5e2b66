"""Numbers of many moves in one: what stands in the literals of a move that stands for a stretch of a run.

A column number is calculated with like a number, row by row, and gives the same bits: the same operations on the same
doubles. Asked something that not all rows answer alike, or for its value, it raises LooksInsideError, and whoever began
this goes on with the moves one by one. It says of itself that it is a float, so that no branch is taken otherwise than
for a float; but it is none, so that no function in C reads a value that it has not.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator
from functools import wraps
from typing import TYPE_CHECKING, TypeVar, TypeVarTuple, cast

from rpl.ir.expressions import Expression, IntLiteral, RealLiteral
from rpl.source import Origin

if TYPE_CHECKING:  # who reads no long program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

    from rpl.ir.runs import Run

# What the spellings of numbers in a stretch begin with, and then its number: of a column of the source that nothing has
# changed (who takes the spelling along takes that column), of a choice.
KEPT, CHOSEN = "\0", "\1"

_T = TypeVarTuple("_T")
_R = TypeVar("_R")


class Stretch:
    """Moves first..end-1 of a run, for which one move stands. No node: a walk passes it by.

    ordinary: moves of the run for which no stretch stands. checked: those of them that have to be what the stretch
    gives for their numbers. odd: those that have answered a question otherwise than most. rows: of which moves of the
    run a column number has the numbers, ascending: those of the stretch, those that are checked, and the moves beside
    these, but none that is odd. A run of many stretches is so calculated about once. asked: which rows have to answer
    alike; of those that stand beside nothing is written by this stretch."""

    __slots__ = (
        "_apart",
        "_own",
        "asked",
        "checked",
        "choices",
        "end",
        "first",
        "odd",
        "ordinary",
        "origin",
        "rows",
        "run",
        "spellings",
    )

    def __init__(
        self,
        run: Run,
        first: int,
        end: int,
        ordinary: tuple[int, ...],
        spellings: list[tuple[str, ...]],
        checked: tuple[int, ...] | None = None,
        odd: frozenset[int] = frozenset(),
    ) -> None:
        """spellings: of the numbers of each move of the run. checked: without it all ordinary moves but the first and
        the last."""
        import numpy as np

        columns = run.columns
        self.checked = ordinary[1:-1] if checked is None else checked
        beside = {one for at in self.checked for one in (at - 1, at, at + 1)} | {first - 1, end}
        apart = sorted(one for one in beside - odd if 0 <= one < len(run) and not first <= one < end)
        self._own = sum(one < first for one in apart)
        self.rows = np.array([*apart[: self._own], *range(first, end), *apart[self._own :]], dtype=np.int64)
        self._apart = {at: row for row, at in enumerate(self.rows.tolist()) if not first <= at < end}
        self.asked = np.zeros(len(self.rows), dtype=np.bool_)
        self.asked[[*range(self._own, self._own + end - first), *map(self._apart.__getitem__, self.checked)]] = True
        self.run, self.first, self.end, self.ordinary, self.spellings = run, first, end, ordinary, spellings
        self.odd = odd
        self.choices: list[Choice] = []
        self.origin = Origin(columns.source, int(columns.starts[first]), int(columns.ends[end - 1]))

    def row(self, at: int) -> int:
        """Where in its columns the numbers of move `at` of the run are."""
        return at - self.first + self._own if self.first <= at < self.end else self._apart[at]

    def rows_of(self, moves: NDArray[np.int64]) -> NDArray[np.int64]:
        """`row` of each of these moves."""
        return self.rows.searchsorted(moves)

    def alike(self, answers: NDArray[np.bool_]) -> bool:
        """What each row answers. Raises LooksInsideError where they do not answer alike, with those that answer
        otherwise than most."""
        asked = answers[self.asked]
        yes = int(asked.sum())
        if 0 < yes < len(asked):
            raise LooksInsideError(self, self.moves_where(answers if 2 * yes <= len(asked) else ~answers))
        return yes > 0

    def moves_where(self, answers: NDArray[np.bool_]) -> tuple[int, ...]:
        """The moves of the run, of those that are asked, for which the answer is yes."""
        return tuple(self.rows[answers & self.asked].tolist())


class Choice:
    """What is one of a few expressions in each row. answers: which of the options."""

    __slots__ = ("answers", "options")

    def __init__(self, answers: NDArray[np.int64], options: tuple[Expression, ...]) -> None:
        self.answers, self.options = answers, options


class LooksInsideError(Exception):
    """A question that the rows of a stretch do not answer alike. odd: the moves of the run that answer otherwise than
    most, where that is known."""

    def __init__(self, stretch: Stretch, odd: tuple[int, ...] = ()) -> None:
        super().__init__("the moves of a run are told apart")
        self.stretch, self.odd = stretch, odd


class ColumnNumber:
    """A number for each of the rows of a stretch: those of moves outside of it answer questions too. kind: what it says
    that it is, float or int (of which only the value as a float can be taken). shifted: it comes of the numbers of
    neighbours, which the outermost rows have not."""

    __slots__ = ("kind", "shifted", "stretch", "values")

    def __init__(
        self, stretch: Stretch, values: NDArray[np.float64], kind: type = float, shifted: bool = False
    ) -> None:
        self.stretch, self.values, self.kind, self.shifted = stretch, values, kind, shifted

    def __getattribute__(self, name: str) -> object:
        return object.__getattribute__(self, "kind" if name == "__class__" else name)

    # ---- arithmetic

    def _with(self, other: object, calculate: Callable[[object, object], object]) -> float:
        import numpy as np

        if self._whole(other):
            raise LooksInsideError(self.stretch)
        with np.errstate(all="ignore"):
            values = np.asarray(calculate(self.values, self._operand(other)), dtype=np.float64)
        return _number(self.stretch, values, shifted=_shifted((self, other)))

    def _operand(self, other: object) -> float | NDArray[np.float64]:
        if type(other) is ColumnNumber and other.stretch is self.stretch:
            return other.values
        if type(other) is float or type(other) is int:
            return float(other)
        raise LooksInsideError(self.stretch)

    def _whole(self, other: object) -> bool:
        """Are both whole numbers, whose sums no double may hold?"""
        return self.kind is int and other.__class__ is int

    def __add__(self, other: object) -> float:
        return self._with(other, operator.add)

    def __radd__(self, other: object) -> float:
        return self._with(other, lambda one, given: operator.add(given, one))

    def __sub__(self, other: object) -> float:
        return self._with(other, operator.sub)

    def __rsub__(self, other: object) -> float:
        return self._with(other, lambda one, given: operator.sub(given, one))

    def __mul__(self, other: object) -> float:
        return self._with(other, operator.mul)

    def __rmul__(self, other: object) -> float:
        return self._with(other, lambda one, given: operator.mul(given, one))

    def __truediv__(self, other: object) -> float:
        divisor = self._operand(other)
        if divisor == 0.0 if isinstance(divisor, float) else self.stretch.alike(divisor == 0.0):
            raise LooksInsideError(self.stretch)
        return self._with(other, operator.truediv)

    def __rtruediv__(self, other: object) -> float:
        if self.stretch.alike(self.values == 0.0):
            raise LooksInsideError(self.stretch)
        return self._with(other, lambda one, given: operator.truediv(given, one))

    def __neg__(self) -> float:
        # A whole number has no negative zero.
        return _number(self.stretch, 0.0 - self.values if self.kind is int else -self.values, self.kind, self.shifted)

    def __pos__(self) -> float:
        return cast(float, self)

    def __abs__(self) -> float:
        return _number(self.stretch, abs(self.values), self.kind, self.shifted)

    # ---- questions

    def __eq__(self, other: object) -> bool:
        if other is None or isinstance(other, str | tuple):
            return False
        return other is self or self.stretch.alike(self.values == self._operand(other))

    def __lt__(self, other: object) -> bool:
        return self.stretch.alike(self.values < self._operand(other))

    def __le__(self, other: object) -> bool:
        return self.stretch.alike(self.values <= self._operand(other))

    def __gt__(self, other: object) -> bool:
        return self.stretch.alike(self.values > self._operand(other))

    def __ge__(self, other: object) -> bool:
        return self.stretch.alike(self.values >= self._operand(other))

    def __bool__(self) -> bool:
        return self.stretch.alike(self.values != 0.0)

    def _value(self) -> float:
        """What all rows have, to the sign of a zero."""
        import numpy as np

        stretch, asked = self.stretch, self.values[self.stretch.asked]
        first = float(asked[0])
        if (asked != first).any():
            first = float(np.sort(asked)[len(asked) // 2])  # what most have, if most have one
            raise LooksInsideError(stretch, stretch.moves_where(self.values != first))
        return first if first != 0.0 else -0.0 if stretch.alike(np.signbit(self.values)) else 0.0

    def __hash__(self) -> int:
        return hash(self._value())

    def __float__(self) -> float:
        return self._value()

    def __int__(self) -> int:
        return int(self._value())

    def __trunc__(self) -> int:
        return int(self._value())

    def __round__(self, digits: int | None = None) -> float:
        return round(self._value(), digits)

    def __format__(self, form: str) -> str:
        return format(self._value(), form)

    def __str__(self) -> str:
        return str(self._value())

    def __repr__(self) -> str:
        return repr(self._value())

    def __reduce__(self) -> str:
        raise LooksInsideError(self.stretch)

    def _refused(self, *_: object) -> float:
        raise LooksInsideError(self.stretch)

    __floordiv__ = __rfloordiv__ = __mod__ = __rmod__ = __divmod__ = __rdivmod__ = __pow__ = __rpow__ = _refused
    __floor__ = __ceil__ = __index__ = is_integer = as_integer_ratio = hex = _refused
    __copy__ = __deepcopy__ = __getstate__ = _refused


def _number(stretch: Stretch, values: NDArray[np.float64], kind: type = float, shifted: bool = False) -> float:
    return cast(float, ColumnNumber(stretch, values, kind, shifted))


def _shifted(values: Iterable[object]) -> bool:
    """Does any of these come of the numbers of neighbours?"""
    return any(one.shifted for one in map(column_of, values) if one is not None)


def column_of(value: object) -> ColumnNumber | None:
    """The column number that a value is, whatever it says of itself."""
    return value if type(value) is ColumnNumber else None


def stretch_of(values: Iterable[object]) -> Stretch | None:
    """The stretch whose rows these numbers are of; None for numbers alone."""
    return next((one.stretch for one in map(column_of, values) if one is not None), None)


def as_float(value: float) -> float:
    """float(value), of a column number too."""
    column = column_of(value)
    if column is None:
        return float(value)
    if column.kind is Choice:
        raise LooksInsideError(column.stretch)
    return _number(column.stretch, column.values, shifted=column.shifted)


def as_whole(value: float) -> int:
    """int(value), of a column of whole numbers too."""
    column = column_of(value)
    return int(value) if column is None or column.kind is not int else cast(int, value)


def whole_column(stretch: Stretch, values: NDArray[np.int64]) -> int:
    """The whole numbers of the rows; a plain one where all have the same."""
    if (values == values[0]).all():
        return int(values[0])
    return cast(int, _number(stretch, values.astype("float64"), int))


def in_each_row(value: float) -> NDArray[np.float64] | float:
    """The numbers of the rows, or the one number."""
    column = column_of(value)
    return value if column is None else column.values


def in_row(value: float, at: int) -> float:
    """The number in one move of the run."""
    column = column_of(value)
    return value if column is None else column.kind(column.values[column.stretch.row(at)])


def in_next_row(value: float, step: int) -> float:
    """The number of the next move (1) or the one before (-1) in each; at the end of the run that of the other side,
    from where the way is as long. So it is in the rows whose neighbour is in no column: these are neither of the
    stretch nor ordinary, and nothing that comes of them is asked for a neighbour again."""
    import numpy as np

    column = column_of(value)
    if column is None:
        return value
    if column.shifted:
        raise LooksInsideError(column.stretch)
    rows = column.stretch.rows
    missing = np.roll(rows, -step) != rows + step
    numbers = np.where(missing, np.roll(column.values, step), np.roll(column.values, -step))
    return _number(column.stretch, numbers, column.kind, shifted=True)


def chosen(answer: float, yes: Expression, no: Expression) -> Expression:
    """The one number where the answer is not zero, else the other one; in a column for each row."""
    column = column_of(answer)
    if column is None:
        return yes if answer else no
    answers = column.values != 0.0
    if answers.all() or not answers.any():
        return yes if answers[0] else no
    one, other = (_values(each, column.stretch) for each in (yes, no))
    import numpy as np

    column.stretch.choices.append(Choice(np.where(answers, 0, 1), (yes, no)))
    shifted = _shifted((answer, *(each.value for each in (yes, no) if isinstance(each, IntLiteral | RealLiteral))))
    number = _number(column.stretch, np.where(answers, one, other), shifted=shifted)
    return RealLiteral(number, f"{CHOSEN}{len(column.stretch.choices) - 1}")


def selected(stretch: Stretch, answers: NDArray[np.int64], options: tuple[Expression, ...]) -> Expression:
    """One of the options, which are the same in all rows where they are: in each row the one of that number. The
    literal that stands for it says of itself that it is no number."""
    if (answers == answers[0]).all():
        return options[int(answers[0])]
    stretch.choices.append(Choice(answers, options))
    number = _number(stretch, answers.astype("float64"), Choice)
    return RealLiteral(number, f"{CHOSEN}{len(stretch.choices) - 1}")


def _values(expression: Expression, stretch: Stretch) -> float | NDArray[np.float64]:
    if not isinstance(expression, IntLiteral | RealLiteral):
        raise LooksInsideError(stretch)
    column = column_of(expression.value)
    return float(expression.value) if column is None else column.values


def by_row(function: Callable[[*_T], _R]) -> Callable[[*_T], _R]:
    """The function of numbers, and of tuples of numbers, for column numbers too: calculated for each row, so that each
    has the very bits that it has alone. What it gives are numbers, or tuples of as many numbers for each row."""

    @wraps(function)
    def lifted(*arguments: *_T) -> _R:
        stretch = stretch_of(_flat(arguments))
        if stretch is None:
            return function(*arguments)
        rows = zip(*(_rows(one, stretch) for one in arguments), strict=True)
        alone = cast(Callable[..., object], function)
        return cast(_R, _gathered(stretch, [alone(*row) for row in rows], _shifted(_flat(arguments))))

    return lifted


def _flat(arguments: Iterable[object]) -> Iterator[object]:
    for one in arguments:
        if type(one) is tuple:
            yield from one
        else:
            yield one


def _rows(value: object, stretch: Stretch) -> list[object]:
    if type(value) is ColumnNumber:
        if value.stretch is not stretch or value.kind is not float:
            raise LooksInsideError(stretch)
        return cast(list[object], value.values.tolist())
    if type(value) is tuple:
        return list(zip(*(_rows(one, stretch) for one in value), strict=True))
    return [value] * len(stretch.rows)


def _gathered(stretch: Stretch, results: list[object], shifted: bool) -> object:
    import numpy as np

    first = results[0]
    if type(first) is tuple:
        columns = zip(*cast(list[tuple[object, ...]], results), strict=True)
        return tuple(_gathered(stretch, list(column), shifted) for column in columns)
    if set(map(type, results)) != {float}:
        raise LooksInsideError(stretch)
    return _number(stretch, np.array(results, dtype=np.float64), shifted=shifted)
