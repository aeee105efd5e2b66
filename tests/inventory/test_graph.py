"""The drawing of calls: callers in front of what they call, also where calls lead in a circle."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from rpl.inventory.contents import Program
from rpl.inventory.graph import graph


def program(name: str, calls: tuple[str, ...], missing: tuple[str, ...] = (), entry: bool = False) -> Program:
    return Program(name, "m", "m:1", "procedure", "", entry, 1, 0, calls, (), missing)


def test_columns_rows_and_what_is_missing() -> None:
    found = graph(
        [
            program("main", ("a", "b"), entry=True),
            program("a", ("b",)),
            program("b", ("a",), ("lost",)),  # back to its caller
            program("spare", ()),
        ]
    )
    at = {one.name: (one.x, one.kind) for one in found.boxes}
    assert at["main"][0] < at["a"][0] < at["b"][0] < at["lost"][0]
    assert at["spare"][0] == at["main"][0]
    assert [at[name][1] for name in ("main", "a", "spare", "lost")] == ["entry", "alone", "alone", "missing"]
    assert {(one.caller, one.called) for one in found.lines} == {
        ("main", "a"), ("main", "b"), ("a", "b"), ("b", "a"), ("b", "lost"),
    }  # fmt: skip


@given(st.lists(st.lists(st.integers(0, 11), max_size=4), min_size=1, max_size=12))
def test_every_routine_has_a_place_of_its_own_and_every_call_a_line(calls: list[list[int]]) -> None:
    names = [f"r{at}" for at in range(len(calls))]
    programs = [
        program(name, tuple(names[one] for one in dict.fromkeys(found) if one < len(names)))
        for name, found in zip(names, calls, strict=True)
    ]
    drawn = graph(programs)
    assert sorted(one.name for one in drawn.boxes) == sorted(names)
    assert len({(one.x, one.y) for one in drawn.boxes}) == len(names)
    assert len(drawn.lines) == sum(len(one.calls) for one in programs)
    assert all(one.x < drawn.width and one.y < drawn.height for one in drawn.boxes)
