"""Messages that say the same: blanks, lines, and registers named in place of values."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.messages import as_lines, same_message
from rpl.proof.record import Happening, Named
from rpl.simulation import run_program
from rpl.source import source_from_text

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


@pytest.mark.parametrize(
    "text, names, held, same",
    [
        ("count: 17", "count: R12", {"R12": 17}, True),
        ("count: 17", "count: R12", {"R12": 18}, False),
        ("x 1.33 mm", "x R1 mm", {"R1": 4.0 / 3.0}, True),
        ("x 1.34 mm", "x R1 mm", {"R1": 4.0 / 3.0}, False),
        ("x 1.5E-3", "x R1", {"R1": 0.0015}, True),
        ("3 of 4", "R1 of R2", {"R2": 4}, True),
        ("3 of 5", "R1 of R2", {"R2": 4}, False),
        ("part left", "part SR1", {"SR1": "left"}, True),
        ("part right", "part SR1", {"SR1": "left"}, False),
    ],
)
def test_what_a_named_register_holds_is_what_is_shown(
    text: str, names: str, held: dict[str, object], same: bool
) -> None:
    other = replace(named(names)[0], held=tuple(held.items()))  # type: ignore[arg-type]
    assert same_message(shown(text)[0], other) == same
    assert same_message(other, shown(text)[0]) == same


def test_a_run_notes_what_the_named_registers_hold() -> None:
    text = "/PROG P\n/MN\n   1:  R[1]=7 ;\n   2:  MESSAGE[count R1] ;\n/END\n"
    program = read_sources([source_from_text("p.ls", text)], "tp", Diagnostics()).program
    (message,) = (event for event in run_program(program).trace if event.kind == "message")
    assert message.named == (("R1", 7),)


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


@pytest.mark.parametrize(
    "one, other",
    [
        ("count: 17", "number: R12"),  # another word
        ("17 parts", "R12 boxes"),
        ("count: TRUE", "count: R12"),  # a truth is no number
        ("count: 17 18", "count: R12"),
        ("count: 1.2.3", "count: R12"),
        ("count: ", "count: R12"),
        ("count: 17", "count: PR12"),  # no register of that name
        ("count: 17", "count: XR12"),
        ("lid", "part SR1"),
        ("part lid now", "part SR1 then"),
        ("(17)", "[R1]"),  # signs are signs, no pattern
        ("a+b 17", "aab R1"),
    ],
)
def test_messages_that_do_not_say_the_same(one: str, other: str) -> None:
    assert not same_message(shown(one)[0], named(other)[0])
    assert not same_message(named(other)[0], shown(one)[0])


OUTPUT = Happening("output", 1.0, True)


@pytest.mark.parametrize(
    "one, several",
    [
        (shown("part 7 is ready"), named("part R1", "is")),  # a line is missing
        (shown("part 7"), named("part R1", "is ready")),  # a line too many: it is the next message
        (shown("part 7 is ready"), named("part R1", "was ready")),  # another word in the second line
        (shown("part lid is ready"), named("part R1", "is ready")),  # a value of another kind
        (shown("a", "b"), shown("b", "a")),  # another order
        (shown("a b"), [*shown("a"), OUTPUT, *shown("b")]),  # something between the lines
        ([OUTPUT, *shown("a")], shown("a")),
        (shown("a b"), []),
        ([], []),
    ],
)
def test_lines_that_are_not_one_message(one: list[Happening], several: list[Happening]) -> None:
    assert as_lines(one, several) == (1, 1)
    assert as_lines(several, one) == (1, 1)


def test_consecutive_messages_at_the_same_time_stay_apart() -> None:
    """Each message takes its own lines; a name for any text does not swallow the next message."""
    assert as_lines(shown("v lid", "v lid"), named("v SR1", "v SR1")) == (1, 1)
    assert as_lines(shown("7", "8"), named("R1", "R2")) == (1, 1)
    assert as_lines(shown("7 8", "9"), named("R1", "R2", "R3")) == (1, 2)
    assert as_lines(shown("a", "b c"), shown("a", "b", "c")) == (1, 1)
    assert as_lines(shown("b c"), shown("b", "c")) == (1, 2)
