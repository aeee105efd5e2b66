"""The file that keeps names and numbers between translations."""

from __future__ import annotations

import pytest

from rpl.errors import UsageError
from rpl.passes.capabilities import Bank, Storage
from rpl.writing.namemap import NameMap, check_map, map_text, parse_map

NAMES = {"pick up": "PICK_UP", "Éa": "Ea"}
NUMBERS = {("R", 10): "count", ("R", 2): "list[1,2]", ("main.P", 1): 'pick "left"', ("digital_out", 3): "grip"}


def test_what_is_written_is_read_back() -> None:
    text = map_text(NameMap("tp", NAMES, NUMBERS, {("R", 10): "int"}))
    assert text.splitlines()[2:] == [
        'target = "tp"', "", "[names]", '"pick up" = "PICK_UP"', '"Éa" = "Ea"', "",
        "[numbers.R]", '2 = "list[1,2]"', '10 = "count"  # int', "",
        "[numbers.digital_out]", '3 = "grip"', "", '[numbers."main.P"]', '1 = "pick \\"left\\""',
    ]  # fmt: skip
    read = parse_map(text)
    assert (read.target, read.names, read.numbers) == ("tp", NAMES, NUMBERS)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "m.toml: target: a map begins"),
        ("target = 3", "m.toml:1: target: a map begins"),
        ("target = \"tp\"\n[cell]\n", "m.toml:2: cell: a map has target, names, numbers, taught"),
        ("target = \"tp\"\n[numbers.R]\nx = \"a\"\n", "m.toml:3: x: a line has a whole number and a name"),
        ("target = \"tp\"\n\n[numbers.R]\n1 = \"a\"\n2 = 3\n", "m.toml:5: 2: behind the sign = stands a name"),
        ("target = \"tp\"\n[numbers.\"a.P\"]\n4 = \"\"\n", "m.toml:3: 4: behind the sign = stands a name"),
        ("target = \"tp\"\n[numbers.R]\n1 = \"a\"\n1 = \"b\"\n", "m.toml:4: '1': .*each number stands once"),
        ("target = \"tp\"\n[names]\n'a b' = 1\n", "m.toml:3: a b: behind the sign"),
    ],
)  # fmt: skip
def test_what_is_no_map_is_refused_with_its_line_and_key(text: str, problem: str) -> None:
    with pytest.raises(UsageError, match=problem):
        parse_map(text, "m.toml")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "m.toml:1: target: the map is one for krl, and tp is to be written"),
        ("[numbers.R]\n300 = \"count\"", "m.toml:3: 300: 'count' needs a number from 1 to 250"),
        ("[numbers.\"main.P\"]\n0 = \"up\"", "m.toml:3: 0: 'up' needs a number from 1 to 9"),
        ("[numbers.R]\n1 = \"a\"\n2 = \"a\"", "m.toml:4: 2: 'a' has the number 1 too: delete one of the lines"),
    ],
)  # fmt: skip
def test_what_the_target_has_not_is_refused(text: str, problem: str) -> None:
    storage = Storage(banks={"RealType": Bank("R", 1, 200, most=250)}, points=Bank("P", 1, 9))
    given = parse_map(f'target = "{"tp" if text else "krl"}"\n{text}\n', "m.toml")
    with pytest.raises(UsageError, match=problem):
        check_map(given, "tp", storage)


def test_what_the_program_has_no_more_stays_in_the_map() -> None:
    old = NameMap("tp", {"a": "A1", "b": "B1", "c": "C1"}, {("R", 1): "x", ("R", 2): "y", ("R", 3): "z"})
    new = NameMap("tp", {"b": "B2", "d": "C1"}, {("R", 3): "y", ("R", 4): "w"}).behind(old)
    assert new.names == {"a": "A1", "b": "B2", "d": "C1"}
    assert new.numbers == {("R", 1): "x", ("R", 3): "y", ("R", 4): "w"}
