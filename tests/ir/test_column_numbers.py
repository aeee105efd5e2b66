"""Numbers of many moves in one: what they are calculated to, and when they refuse to answer."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from rpl import ir
from rpl.ir.columns import ColumnNumber, LooksInsideError, Stretch, as_float, by_row, column_of, in_next_row, in_row
from rpl.project import read_program
from rpl.source import source_from_text

VALUES = [1.5, 2.5, -0.0, 3.25]


def column(values: list[float]) -> float:
    text = "\n".join(["DEF p()", *[f"LIN {{X {at}.5,Y 1,Z 2,A 3,B 4,C 5}}" for at in range(40)], "END", ""])
    routine = read_program([source_from_text("p.src", text)]).reduced.modules[0].routines[0]
    run = next(one for one in routine.body if isinstance(one, ir.Run))
    last = len(run) - 1
    stretch = Stretch(run, 2, 5, (0, 1, 20, last), [])
    assert stretch.rows.tolist() == [0, 1, 2, 3, 4, 5, 19, 20, 21]
    number: object = ColumnNumber(stretch, np.resize(values, len(stretch.rows)))
    assert isinstance(number, float)  # so it says of itself
    return number


@pytest.mark.parametrize(
    "calculate",
    [
        lambda number: number + 0.1,
        lambda number: 0.1 - number,
        lambda number: number * number / 3,
        lambda number: -number,
        lambda number: abs(number) * 7,
        lambda number: as_float(number),
        by_row(lambda number: math.fmod(number, 0.7)),
    ],
)
def test_calculating_gives_the_bits_that_each_number_gives(calculate: Callable[[float], float]) -> None:
    found = column_of(calculate(column(VALUES)))
    assert found is not None
    assert list(map(repr, found.values[:4].tolist())) == [repr(calculate(one)) for one in VALUES]


def test_what_all_rows_answer_alike_is_answered() -> None:
    assert column(VALUES) < 4
    assert not column(VALUES) > 4
    assert column([2.0, 2.0]) == 2
    assert math.sin(column([2.0, 2.0])) == math.sin(2.0)


@pytest.mark.parametrize(
    "ask",
    [
        float,
        int,
        hash,
        str,
        round,
        math.sin,
        bool,
        lambda number: f"{number:.3f}",
        lambda number: number > 2,
        lambda number: number == 2.5,
        lambda number: 1 / number,
        lambda number: number % 2,
        lambda number: number**2,
        lambda number: number + column(VALUES),
        lambda number: np.array([number], dtype=np.float64),
        lambda number: in_next_row(0.5 - in_next_row(number, 1), -1),
        lambda number: in_next_row(by_row(math.sqrt)(abs(in_next_row(number, 1))), 1),
    ],
)
def test_what_they_answer_otherwise_is_refused(ask: Callable[[float], object]) -> None:
    with pytest.raises(LooksInsideError):
        ask(column(VALUES))


def test_a_row_and_the_rows_beside_it() -> None:
    assert in_row(column(VALUES), 3) == 3.25
    assert in_row(in_next_row(column(VALUES), -1), 1) == 1.5
    assert in_row(in_next_row(column(VALUES), 1), 1) == 0.0
    assert in_row(in_next_row(column(VALUES), -1), 0) == 2.5
    assert in_row(column(VALUES), 20) == 3.25
    assert in_row(in_next_row(column(VALUES), -1), 20) == 0.0
    assert in_row(in_next_row(column(VALUES), 1), 20) == 1.5
