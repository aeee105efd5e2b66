"""Actions a time before or behind a place on an arc are refused where the target looks how far straight the tool is."""

from __future__ import annotations

import pytest
from refusing import refused

PROGRAM = """VAR over: POSE = pose {x: 1000, y: 60, z: 450, a: 0, b: 180, c: 0}
MOVE TO pose {x: 1060, y: 0, z: 450, a: 0, b: 180, c: 0}
TRIGGER AT %s DO SET do[1] TO ON
MOVE CIRCULAR VIA over TO pose {x: 940, y: 0, z: 450, a: 0, b: 180, c: 0} %s
MOVE TO pose {x: 1000, y: 0, z: 450, a: 0, b: 180, c: 0}
"""
CASES = {
    "before the end": ("end DELAY -0.3 s", "SPEED 60 mm/s", True),
    "behind a place on the way": ("end DISTANCE -40 mm DELAY 0.2 s", "SPEED 60 mm/s", True),
    "behind the end, in a corner": ("end DELAY 0.2 s", "SPEED 60 mm/s BLEND 10 mm", True),
    "behind the end": ("end DELAY 0.2 s", "SPEED 60 mm/s", False),
    "behind the start": ("start DELAY 0.2 s", "SPEED 60 mm/s", False),
    "a place": ("end DISTANCE -40 mm", "SPEED 60 mm/s", False),
}


@pytest.mark.parametrize("target", ["vplus", "urscript"])
@pytest.mark.parametrize("case", CASES)
def test_a_time_on_an_arc_is_refused(case: str, target: str) -> None:
    place, settings, no = CASES[case]
    told = refused(PROGRAM % (place, settings), "rpl", target, "kuka_kr16_2")
    assert told == ([("path-event-timed-on-arc", 3)] if no else [])
