"""The words of a language stand once, in `words.toml` of its dialect: neither room spells them in tables of its own."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from rpl import registry
from rpl.words import Words, lowered, spelled

ROOT = Path(__file__).parents[2]
LANGUAGES = sorted(file.parent.name for file in ROOT.glob("dialects/*/words.toml"))


@cache
def texts(folder: str) -> frozenset[str]:
    """All texts in the code of a folder, in small letters."""
    trees = [ast.parse(file.read_text("utf-8")) for file in (ROOT / folder).rglob("*.py")]
    constants = (node.value for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Constant))
    return frozenset(word.lower() for text in constants if isinstance(text, str) for word in (text, *text.split()))


def own_words(value: object) -> Iterator[str]:
    """All words in a table, in small letters."""
    if isinstance(value, str):
        yield from value.lower().split()
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield key.lower()
            yield from own_words(inner)


def holds_words(value: object) -> bool:
    """Tables of numbers have names for their numbers, by which the code asks for them."""
    return not isinstance(value, dict) or any(isinstance(inner, str | dict) for inner in value.values())


TABLES = [
    (language, key)
    for language in LANGUAGES
    for key, value in registry.words(language).table.items()
    if holds_words(value)
]


@pytest.mark.parametrize(("language", "key"), TABLES)
def test_no_table_of_words_stands_in_both_rooms_again(language: str, key: str) -> None:
    """Single words stand where a statement is read and where it is written. What the core knows too is neutral."""
    own = set(own_words(registry.words(language).table[key])) - texts("rpl")
    doubled = own & texts(f"dialects/{language}") & texts(f"postprocessors/{language}")
    assert len(doubled) <= max(2, len(own) / 3)


def test_what_krl_writes_it_reads_as_the_same() -> None:
    from dialects.krl import tables as reader
    from postprocessors.krl import tables as writer

    parts = {f"{name}.{part}": row for name, inner in reader.STRUCTURES.items() for part, row in inner.items()}
    variables = reader.SCALARS | reader.INDEXED | parts
    for neutral, (name, unit) in writer.SYSTEM.items():
        assert variables[name.lower()] == (neutral, unit)
    assert all(reader.FUNCTIONS[name.lower()] == neutral for neutral, name in writer.FUNCTIONS.items())
    assert {name.lower() for name in writer.PROCEDURES.values()} <= reader.TEXT_PROCEDURES.keys()
    assert {name.lower() for name in writer.MESSAGES.values()} <= reader.MESSAGES.keys()


def test_what_rapid_reads_stands_in_its_words() -> None:
    from dialects.rapid import functions, instructions, types

    table = registry.words("rapid").table
    for key, read in (("functions", functions.FUNCTIONS), ("instructions", instructions.INSTRUCTIONS)):
        assert set(read) <= {*own_words(table[key]), *own_words(table[f"vendor_{key}"])}
    assert set(types.SIGNALS) == set(registry.words("rapid").pairs("signal_types").values())


def test_what_tp_writes_it_reads_as_the_same() -> None:
    from dialects.tp import tables as reader
    from postprocessors.tp import tables as writer

    for written, read in (
        (writer.FUNCTIONS, reader.FUNCTIONS),
        (writer.SIGNALS, reader.NUMBERED_SIGNALS),
        (writer.SYSTEM_VARIABLES, reader.SYSTEM_VARIABLES),
    ):
        assert {name: read[name] for name in written.values()} == {name: neutral for neutral, name in written.items()}
    assert (writer.POSE_ELEMENTS, writer.JOINT_ELEMENTS) == (reader.CARTESIAN_ELEMENTS, reader.JOINT_ELEMENTS)
    assert {bank: writer.BANKS[bank].last for bank in reader.LAST_NUMBER} == reader.LAST_NUMBER


def test_the_first_of_several_words_is_the_one_that_is_written() -> None:
    pairs = {"$A": "a", "$B": "b", "$A_MES": "a"}
    assert spelled(pairs) == {"a": "$A", "b": "$B"}
    assert lowered(pairs) == {"$a": "a", "$b": "b", "$a_mes": "a"}


@pytest.mark.parametrize("table", [{"x": 1}, {"x": {"y": [1]}}, {"x": {"y": {"z": 1}}}])
def test_a_table_of_another_form_is_told(table: dict[str, object]) -> None:
    for read in (Words(table).listed, Words(table).pairs, Words(table).numbers, Words(table).nested):
        with pytest.raises(TypeError, match="x"):
            read("x")
