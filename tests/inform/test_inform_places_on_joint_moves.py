"""An action on the way of a joint move is refused where the controller has no path events."""

from __future__ import annotations

import pytest

from tests.refusing import refused

PROGRAM = """VAR far: REAL = 30.0
far = far + 1.0
MOVE TO pose {x: 1060, y: 0, z: 450, a: 0, b: 180, c: 0}
TRIGGER AT end DISTANCE %s DO SET do[1] TO ON
MOVE TO pose {x: 940, y: 100, z: 450, a: 0, b: 180, c: 0}
"""


@pytest.mark.parametrize("place", ["(-far) mm", "-30 mm"])
@pytest.mark.parametrize(("target", "code"), [("inform", "path-event-on-joint-move"), ("urscript", "path-event-lost")])
def test_no_target_without_path_events_is_given_it(place: str, target: str, code: str) -> None:
    assert refused(PROGRAM % place, "rpl", target, "kuka_kr16_2") == [(code, 4)]


TIMED = """DEF one()
PTP {A1 0, A2 -90, A3 90, A4 0, A5 60, A6 0}
TRIGGER WHEN DISTANCE=1 DELAY=-200 DO $OUT[1]=TRUE
TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[2]=TRUE
PTP {A1 30, A2 -90, A3 90, A4 0, A5 60, A6 0}
END
"""


@pytest.mark.parametrize(("target", "code"), [("inform", "path-event-on-joint-move"), ("urscript", "path-event-lost")])
def test_nor_a_time_before_the_end(target: str, code: str) -> None:
    assert refused(TIMED, "krl", target, "kuka_kr6r900sixx")[0] == (code, 3)


def test_the_end_of_a_joint_move_is_no_way() -> None:
    assert refused(PROGRAM % "0 mm", "rpl", "inform", "kuka_kr16_2") == []
