"""Waits for a time or a place, where the target looks at them at intervals only."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

WAITS = {
    "a timer": ("$TIMER[1]=-0.35\n$TIMER_STOP[1]=FALSE\nWAIT FOR $TIMER[1]>0", 1),
    "an input": ("WAIT FOR $IN[1]", 0),
    "a variable": ("WAIT FOR n>0", 0),
}


@pytest.mark.parametrize("case", WAITS)
@pytest.mark.parametrize(("target", "looks_seldom"), [("rapid", True), ("tp", False), ("vplus", False)])
def test_it_is_told_where_the_moment_hangs_on_it(case: str, target: str, looks_seldom: bool) -> None:
    steps, waits = WAITS[case]
    journey = there_and_back({"prog.src": f"DEF prog( )\nDECL INT n\nn=1\n{steps}\nEND\n"}, "krl", target)
    found = [item for item in journey.found if item.code.name == "wait-looks-seldom"]
    assert len(found) == (waits if looks_seldom else 0)
