"""Exploring reaches at least 95 of 100 statements of every sample, whatever could not be reached counted too: what is
left is listed with its reason in docs/reach.md.

`python tests/conformance/test_conformance_reach.py` writes the page anew. One sample in two is explored by the quick
tests, all of them by `make test-long`.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from outcomes import model_of
from test_conformance_samples import SAMPLES, expected, name_of, programs_of

from rpl.proof.explore import Budget, explore
from rpl.proof.reach import Reach, lines_of, reach_of
from rpl.proof.watched import side_of

PAGE = Path(__file__).parents[2] / "docs" / "reach.md"
LEAST = 0.95
HEAD = """# What the proof reaches

For every sample: its statements, how many a run in its own cell reaches, how many an exploration from there reaches
(`rpl prove --explore`), how many nothing can reach, and what is left with the reason. At least 95 of
100 statements of every sample are reached, those that nothing can reach counted too. The page is generated.

| sample | statements | its own cell | explored | cannot be | not reached |
|---|---|---|---|---|---|
"""


def reaches_of(sample: Path) -> tuple[Reach, Reach]:
    """In the sample's own cell, and explored."""
    wanted, program = expected(sample), programs_of(sample).program
    side = side_of(program, model_of(wanted.robot), wanted.entry, controller="plain")
    found = explore([side], wanted.cell, Budget(seconds=math.inf))
    alone = reach_of(program, found.reached[0][:1], wanted.entry)
    reach = reach_of(program, found.reached[0], wanted.entry, found.remarks[0], found.one_way[0])
    assert not found.ended or not reach.unreached  # an end of the budget hides nothing where all is reached
    return alone, reach


def row_of(sample: Path, alone: Reach, reach: Reach) -> str:
    by_reason: dict[str, list[str]] = {}
    for one in reach.unreached:
        by_reason.setdefault(one.reason, []).append(one.reason)
    told = "; ".join(
        f"{lines_of([one for one in reach.unreached if one.reason == reason])}: {reason}" for reason in by_reason
    )
    numbers = f"{reach.statements} | {alone.reached} | {reach.reached} | {reach.impossible or ''}"
    return f"| {name_of(sample)} | {numbers} | {told} |"


@pytest.mark.parametrize(
    "sample",
    [
        pytest.param(sample, id=name_of(sample), marks=[pytest.mark.slow] if number % 2 else [])
        for number, sample in enumerate(SAMPLES)
    ],
)
def test_every_sample_is_reached(sample: Path) -> None:
    alone, reach = reaches_of(sample)
    assert reach.share >= LEAST, reach.as_text()
    assert all(one.reason for one in reach.unreached)
    assert row_of(sample, alone, reach) in PAGE.read_text("utf-8").splitlines(), f"see {PAGE.name}, which is generated"


if __name__ == "__main__":
    rows = [row_of(sample, *reaches_of(sample)) for sample in SAMPLES]
    PAGE.write_text(HEAD + "\n".join(rows) + "\n", "utf-8")
