"""The table of look-ahead in docs/fidelity.md shows the data of the dialects; every one names its source."""

from pathlib import Path

import pytest

from rpl import registry
from rpl.passes.scope import rules_of

PAGE = Path(__file__).parents[2] / "docs" / "fidelity.md"


def rows() -> dict[str, list[str]]:
    text = PAGE.read_text(encoding="utf-8").partition("### How far the program runs ahead")[2].partition("\n### ")[0]
    lines = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {cells[0]: cells[1:] for cells in lines if cells[0] != "language"}


def test_every_language_is_in_the_table() -> None:
    assert set(rows()) == set(registry.dialect_names())


@pytest.mark.parametrize("dialect", registry.dialect_names())
def test_the_table_shows_the_rules(dialect: str) -> None:
    advance = rules_of(dialect).advance
    most = str(advance.most) if advance.most else "-"
    assert rows()[dialect] == [
        str(advance.moves),
        most,
        advance.runs_ahead_of,
        f"{advance.lead_s:g}",
        advance.source,
    ]
    assert advance.source


def test_the_tests_that_the_rules_name_exist() -> None:
    """Every rule's row names tests that are there."""
    text = PAGE.read_text(encoding="utf-8").partition("### Rules")[2].partition("\nWhat is not modelled")[0]
    here = Path(__file__).parent
    tests = "\n".join(path.read_text(encoding="utf-8") for path in here.glob("test_*.py"))
    named = [
        part for line in text.splitlines() if line.startswith("| ") for part in line.split("|")[-2].split("`")[1::2]
    ]
    assert len(named) > 30
    for name in named:
        if name.endswith(".py"):
            assert (here / name).exists(), name
        else:
            assert name.rstrip("._") in tests, name
