"""A place on a joint move that the run decides is refused; a constant one is looked for while the robot moves."""

from __future__ import annotations

import pytest
from refusing import refused

PROGRAM = """VAR far: REAL = 30.0
far = far + 1.0
MOVE TO pose {x: 1060, y: 0, z: 450, a: 0, b: 180, c: 0}
TRIGGER AT end DISTANCE %s DO SET do[1] TO ON
MOVE TO pose {x: 940, y: 100, z: 450, a: 0, b: 180, c: 0}
"""
REFUSED = [("path-event-computed-on-joint-move", 4)]


@pytest.mark.parametrize(("place", "told"), [("(-far) mm", REFUSED), ("-30 mm", [])])
def test_only_a_constant_place_is_looked_for(place: str, told: list[tuple[str, int]]) -> None:
    assert refused(PROGRAM % place, "rpl", "inform", "kuka_kr16_2") == told
