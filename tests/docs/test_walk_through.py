"""CONTRIBUTING leads a reader to the right stage and file."""

import re
from pathlib import Path

import pytest

from rpl.passes.legalise.pipeline import STAGES

ROOT = Path(__file__).parents[2]
LEGALISE = ROOT / "rpl" / "passes" / "legalise"
PART = (ROOT / "CONTRIBUTING.md").read_text("utf-8").partition("## Where a rewriting belongs")[2].partition("\n## ")[0]
ROWS = [row.strip("| ").split(" | ") for row in PART.splitlines() if re.match(r"\|.*`[a-z/]+` \|", row)]


def test_the_stages_are_told_in_their_order() -> None:
    told = re.findall("`([a-z]+)`", PART.partition("The order:")[2].partition("`facts`")[0])
    assert told == [stage.name for stage in STAGES]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: str(row[0]))
def test_a_question_leads_to_files_of_one_stage(row: list[str]) -> None:
    _, folder, files = row
    names = re.findall(r"`([a-z]+\.py)`", files)
    assert names
    room = folder.strip("`")  # a stage, or what a target brings along
    place = ROOT / room if "/" in room else LEGALISE / room
    assert [name for name in names if not list(place.rglob(name))] == []


def test_there_are_four_questions() -> None:
    assert len(ROWS) == 4
