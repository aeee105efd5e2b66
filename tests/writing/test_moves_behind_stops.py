"""A move whose action on the way cannot be said stands behind the stop without it: what follows finds its place."""

import pytest

from tests.analog_wiring import WIRED
from tests.there_and_back import there_and_back

PROGRAM = """ENTRY main
MODULE m
PROCEDURE main()
  VAR r: REAL
  $tool = {x: 0, y: 0, z: 100, a: 0, b: 0, c: 0}
  MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}
  r = ai[1]
  TRIGGER AT start DISTANCE r / 2 DO do[3] = TRUE
  MOVE CIRCULAR VIA {x: 500, y: 50, z: 600, a: 0, b: 180, c: 0} TO {x: 450, y: 100, z: 600, a: 0, b: 180, c: 0}
  SET do[1] TO ON
END PROCEDURE
END MODULE
"""


# What cannot be said: the move with its action, or the action alone.
CASES = [("tp", "PAUSE", ":C ", 9), ("inform", "PAUSE", "MOVC ", 8)]


@pytest.mark.parametrize(("target", "stop", "move", "line"), CASES)
def test_a_move_stands_behind_the_stop_without_its_action(target: str, stop: str, move: str, line: int) -> None:
    journey = there_and_back({"m.rpl": PROGRAM}, "rpl", target, "kuka_kr6r900sixx", WIRED)
    assert [item.origin.line for item in journey.found if item.severity.word == "loss"] == [line]
    before, found, behind = journey.text.partition(stop)
    assert found
    assert move not in before
    assert move in behind
