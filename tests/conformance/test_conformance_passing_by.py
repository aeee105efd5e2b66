"""Statements that hold nothing a pass acts on are passed by: entering them would write and report the same."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from drawn_programs import ARM, programs
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_program, read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SAMPLES = Path(__file__).parents[2] / "samples"
LANGUAGES = [name for name in registry.target_names() if name != "rpl"]


@contextmanager
def everything_entered() -> Iterator[None]:
    """Within it nothing is passed by."""
    with pytest.MonkeyPatch.context() as patch:
        for name, module in list(sys.modules.items()):
            if name.startswith("rpl.") and hasattr(module, "holds_none"):
                patch.setattr(module, "holds_none", lambda node, kinds: False)
        yield


def written(read: ReadProgram, target: str) -> tuple[dict[str, bytes], list[str]]:
    """Files and reports of a translation."""
    diagnostics = Diagnostics()
    done = translate_program(read, target, ARM, None, diagnostics)
    return {file.path: file.data for file in done.files}, [item.as_text() for item in diagnostics]


def assert_same(read: ReadProgram, target: str) -> dict[str, bytes]:
    passed_by = written(read, target)
    with everything_entered():
        entered = written(read, target)
    assert passed_by == entered
    return passed_by[0]


@settings(max_examples=3, deadline=None, suppress_health_check=(HealthCheck.too_slow, HealthCheck.data_too_large))
@given(programs(), st.permutations(LANGUAGES))
def test_entering_what_is_passed_by_changes_nothing(text: str, languages: list[str]) -> None:
    read = read_sources([source_from_text("generated.rpl", text)], "rpl", Diagnostics())
    first, second, third = languages[:3]
    files = assert_same(read, first)
    again = read_sources([source_from_bytes(path, data) for path, data in files.items()], first, Diagnostics())
    assert_same(again, second)
    assert_same(again, third)


@pytest.mark.parametrize("source", ["krl", "rapid", "tp"])
def test_entering_what_is_passed_by_in_a_sample_changes_nothing(source: str) -> None:
    read = read_program([SAMPLES / source / "machine_tending"], diagnostics=Diagnostics())
    for target in LANGUAGES:
        if target != source:
            assert_same(read, target)
