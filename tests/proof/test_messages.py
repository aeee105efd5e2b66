"""Messages that say the same: blanks, lines, and registers named in place of values."""

from __future__ import annotations

import pytest

from rpl.proof.messages import as_lines, same_message
from rpl.proof.record import Happening, Named

NAMES = Named(r"R\d+", r"SR\d+")


def shown(*texts: str, t: float = 1.0) -> list[Happening]:
    return [Happening("message", t, text) for text in texts]


def named(*texts: str, t: float = 1.0) -> list[Happening]:
    return [Happening("message", t, text, named=NAMES) for text in texts]


@pytest.mark.parametrize(
    "one, other, same",
    [
        ("count: 17", "count: R12", True),
        ("count:17 pieces", "count: R12 pieces", True),
        ("count: -1.5E-03", "count: R12", True),
        ("part lid.", "part SR1 .", True),
        ("part ", "part SR1", True),
        ("count: many", "count: R12", False),
        ("counts: 17", "count: R12", False),
        ("FOR12", "FOR 12", True),
        ("FOR 7", "FOR12", False),
        ("a (b)", "a (b)", True),
    ],
)
def test_a_register_stands_for_a_value_of_its_kind(one: str, other: str, same: bool) -> None:
    assert same_message(shown(one)[0], named(other)[0]) == same
    assert same_message(named(other)[0], shown(one)[0]) == same


def test_two_sides_that_name_registers_have_the_same_text() -> None:
    assert not same_message(named("R1")[0], named("R2")[0])
    assert not same_message(shown("R1")[0], shown("17")[0])


@pytest.mark.parametrize(
    "one, several, lines",
    [
        (shown("part 7 is", "next"), named("part R1 is", "next"), (1, 1)),
        (shown("part 7 is ready", "next"), named("part R1", "is ready", "next"), (1, 2)),
        (shown("v3.0", "3"), named("v R3", "R3"), (1, 1)),
        (shown("v lid", "b"), named("v SR3", "b"), (1, 1)),
        (shown("v lid b"), named("v SR3", "b"), (1, 2)),
        (shown("part 7 is ready"), [*named("part R1"), *named("is ready", t=2.0)], (1, 1)),
        (shown("a b"), shown("a", "b"), (1, 2)),
    ],
)
def test_lines_of_one_message(one: list[Happening], several: list[Happening], lines: tuple[int, int]) -> None:
    assert as_lines(one, several) == lines
    assert as_lines(several, one) == lines[::-1]
