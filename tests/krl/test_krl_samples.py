"""The KRL samples: they read without a report, survive the round trip, and say at their head what they must do."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from krl_helpers import read, round_trip

SAMPLES = sorted(path.parent for path in (Path(__file__).parents[2] / "samples" / "krl").glob("*/expected.toml"))


def files_of(sample: Path) -> dict[str, str]:
    return {path.name: path.read_text("utf-8") for path in sorted(sample.iterdir()) if path.suffix != ".toml"}


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_reads_without_a_report(sample: Path) -> None:
    program, diagnostics = read(files_of(sample))
    assert not [item.as_text() for item in diagnostics]
    wanted = tomllib.loads((sample / "expected.toml").read_text("utf-8"))
    entry = wanted["entry"]
    (routine,) = [r for m in program.modules for r in m.routines if r.name.lower() == entry]
    assert "quick" in wanted or any(  # tasks that all languages have by hand say it there
        "Expected" in comment.text for s in (*routine.declarations, *routine.body) for comment in s.origin.comments
    )


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.name)
def test_survives_the_round_trip(sample: Path) -> None:
    first, second, _ = round_trip(files_of(sample))
    modules = {module.name: module for module in second.modules}
    assert {module.name: module for module in first.modules} == modules
