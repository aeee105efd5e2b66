"""Joints calculated of a place and moved to at once: a move to the place, in languages that cannot calculate them."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import ARM, OTHERS, translated

from tests.refusing import refused

SCRIPT = """def main():
  above = p[0.45, -0.2, 0.4, 3.1416, 0, 0]
  movej([0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0])
  solution = get_inverse_kin(above)
  movej(solution, a=1.2, v=0.9)
  reached = get_actual_tcp_pose()
  set_standard_digital_out(0, point_dist(above, reached) < 0.001)
end
"""


@pytest.mark.parametrize("target", OTHERS)
def test_the_robot_comes_to_the_place(target: str) -> None:
    result, losses, _ = translated(SCRIPT, target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True]


LOOKED_AT = SCRIPT.replace("point_dist(above, reached) < 0.001", "norm(solution[4] - 1.5708) < 0.01")
REFUSED = {"tp": "tp-guarded-stop", "vplus": "kinematics-lost"}


@pytest.mark.parametrize("target", [name for name in OTHERS if name not in REFUSED])
def test_joints_that_are_looked_at_are_asked_of_the_controller(target: str) -> None:
    result, losses, _ = translated(LOOKED_AT, target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True]


@pytest.mark.parametrize("target", REFUSED)
def test_joints_that_are_looked_at_are_refused_where_they_cannot_be_asked(target: str) -> None:
    """Which solution is meant hangs on where the robot is, so that it cannot be worked out beforehand."""
    assert refused(LOOKED_AT, "urscript", target, ARM) == [(REFUSED[target], 4)]
    result, _, _ = translated(LOOKED_AT, target)
    assert (result.status, list(result.outputs)) == ("stopped", [])
