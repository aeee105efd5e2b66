"""Generated well-typed programs mean the same in every target. A few run each time, many with `make test-long`.

The programs are written in RPL (`drawn_programs.py`). Each is written in every target; what comes out in one language,
drawn with the program, is the source of a second round, so that every pair of languages is tried. What a target refuses
with a guarded stop is no failure here; what it writes must show the same.
"""

from __future__ import annotations

import pytest
from drawn_programs import ARM, programs
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from outcomes import DIFFERENT, outcome_of

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TARGETS = registry.target_names()


def check(text: str, between: str, targets: list[str]) -> None:
    """From RPL to each target; then, by way of the language `between`, once more."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("generated.rpl", text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    for target in targets:
        assert_same(read, target, "main", text)
    losses = Diagnostics()
    translation = translate_program(read, between, ARM, None, losses)
    if losses.of(Severity.LOSS):
        return
    again = [source_from_bytes(file.path, file.data) for file in translation.files]
    written = read_sources(again, between, Diagnostics())
    for target in targets:
        assert_same(written, target, translation.renamed.get("main", "main"), text)


def assert_same(read: ReadProgram, target: str, entry: str, text: str) -> None:
    outcome, _ = outcome_of(read, target, ARM, None, entry)
    assert outcome.status != DIFFERENT, f"{', '.join(read.dialects)} to {target}: {outcome.why}\n{text}"


_QUIET = (HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example)
_languages = st.sampled_from([name for name in TARGETS if name != "rpl"])


@settings(max_examples=4, deadline=None, suppress_health_check=_QUIET)
@given(programs(), _languages)
def test_generated_programs_mean_the_same_everywhere(text: str, between: str) -> None:
    check(text, between, TARGETS)


@pytest.mark.slow
@settings(max_examples=200, deadline=None, suppress_health_check=_QUIET)
@given(programs(), _languages)
def test_many_generated_programs_mean_the_same_everywhere(text: str, between: str) -> None:
    check(text, between, TARGETS)
