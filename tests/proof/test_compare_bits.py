"""Outputs as a group on one side and bit by bit on the other."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl.proof.bits import in_bits
from rpl.proof.compare import Tolerance, compare
from rpl.proof.record import Happening, Record, signal_names

END = Happening("end", 9.0, "finished")
Said = tuple[float, int | tuple[int, int], int | bool]


def record(*said: Said, language: str = "a", **tasks: tuple[Said, ...]) -> Record:
    """A run that writes outputs: time, number (or first and last), value."""

    def happening(t: float, number: int | tuple[int, int], value: int | bool) -> Happening:
        first, last = number if isinstance(number, tuple) else (number, None)
        return Happening("output", t, value, signal_names("digital_out", [], first, last))

    many = {"main": said, **tasks}
    return Record(
        "finished", 9.0, {k: (*(happening(*one) for one in v), END) for k, v in many.items()}, {}, "", language
    )


def equal(a: Record, b: Record) -> bool:
    found = compare(a, b, Tolerance())
    return found.difference is None and not found.deviations


TEN = record((1.0, (33, 36), 10))


@pytest.mark.parametrize(
    ("other", "same"),
    [
        (record((1.0, 34, True), (1.0, 36, True)), True),
        (record((1.0, (33, 36), 10)), True),
        (record((1.0, 34, True)), False),
        (record((1.0, 34, True), (1.0, 35, True), (1.0, 36, True)), False),
        (record((1.0, 33, True), (1.0, 36, True)), False),
        (record((1.0, 36, True), (1.0, 34, True)), False),  # another order is another order
        (record((1.0, (32, 35), 20), (1.0, 36, True)), True),  # another group over some of the bits
        (record((1.0, (33, 40), 10)), True),
        (record((1.0, (33, 40), 26)), False),
        (record((1.0, (33, 36), 12)), False),
    ],
)
def test_a_group_is_its_bits_where_they_are_switched_singly(other: Record, same: bool) -> None:
    assert equal(TEN, other) is same
    assert equal(other, TEN) is same


def test_only_the_bits_that_change_are_switched() -> None:
    whole = record((1.0, (1, 4), 5), (2.0, (1, 4), 6), (3.0, 2, False), (4.0, (1, 4), 0))
    singly = record((1.0, 1, True), (1.0, 3, True), (2.0, 1, False), (2.0, 2, True), (3.0, 2, False), (4.0, 3, False))
    assert equal(whole, singly)
    assert not equal(whole, record((1.0, 1, True), (1.0, 3, True), (2.0, 2, True), (3.0, 2, False), (4.0, 3, False)))


def test_what_another_task_switches_counts() -> None:
    ours = record((1.0, (1, 2), 1), (3.0, (1, 2), 3), other=((2.0, 2, True),))
    taken, _ = in_bits(ours, ours)
    assert [(one.t, one.value) for one in taken.tasks["main"][:-1]] == [(1.0, True)]


def test_groups_that_nothing_switches_singly_stay() -> None:
    assert in_bits(TEN, replace(TEN, language="b"))[0] is TEN
    apart = record((1.0, (33, 36), 10), (2.0, 40, True))
    assert in_bits(apart, TEN)[0] is apart


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        (("digital_out", [], 33, 36), (None, ["go33_36"]), True),
        (("group_out", [], 33, 36), ("digital_out", [], 33, 36), True),
        (("group_out", ["go[2]"], 2), ("digital_out", ["go2"], 65, 72), True),
        (("group_out", ["go[2]"], 2), ("digital_out", ["go3"], 65, 72), False),
        (("digital_out", [], 2), ("digital_out", ["go2"], 65, 72), False),
    ],
)
def test_names_of_groups_meet(a: tuple, b: tuple, same: bool) -> None:  # type: ignore[type-arg]
    assert bool(signal_names(*a) & signal_names(*b)) is same


@pytest.mark.parametrize(
    ("other", "same"),
    [
        (record((1.0, 34, True), (2.5, 36, True)), False),  # a bit at another moment
        (record((1.0, 34, True), (1.0, 36, True), (1.0, 36, False)), False),  # switched off again
        (record((1.0, 34, True), (1.0, 36, True), (2.0, 37, True)), False),  # a bit beside the group
        (record((1.0, 33, False), (1.0, 34, True), (1.0, 36, True)), False),  # a bit that does not change is written
        (record((1.0, (32, 36), 20), (1.0, 33, False)), False),
        (record(), False),
    ],
)
def test_bits_that_are_not_the_group(other: Record, same: bool) -> None:
    assert equal(TEN, other) is same
    assert equal(other, TEN) is same


def test_a_group_without_a_change_writes_no_bits() -> None:
    twice = record((1.0, (33, 36), 10), (2.0, (33, 36), 10), (3.0, 40, True))
    once = record((1.0, 34, True), (1.0, 36, True), (3.0, 40, True))
    assert equal(twice, once)
    assert equal(record((0.5, (33, 36), 0), (1.0, (33, 36), 10)), record((1.0, 34, True), (1.0, 36, True)))


def test_groups_one_after_the_other_at_the_same_time() -> None:
    ours = record((1.0, (33, 36), 10), (1.0, (33, 36), 5))
    same = record(
        (1.0, 34, True), (1.0, 36, True), (1.0, 33, True), (1.0, 34, False), (1.0, 35, True), (1.0, 36, False)
    )
    assert equal(ours, same)
    assert not equal(ours, record((1.0, 33, True), (1.0, 35, True)))
