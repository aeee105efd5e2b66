"""Joints that are computed and sent one by one, speeds given for a time, stops and questions where the robot rests."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import OTHERS, translated
from urscript_helpers import read

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.writing.target import WriteContext

STIRRED = """def main():
  movej([0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0])
  from_here = get_actual_tcp_pose()
  speedl([0, 0, 0.02, 0, 0, 0], a=0.5, t=1.0)
  stopl(1)
  while not is_steady():
    sync()
  end
  to_there = get_actual_tcp_pose()
  risen = to_there[2] - from_here[2]
  set_standard_digital_out(0, risen > 0.012 and risen < 0.03)
  base_q = get_actual_joint_positions()
  tick = 0
  while tick < 40:
    servoj([base_q[0], base_q[1], base_q[2], base_q[3], base_q[4], base_q[5] + 0.005 * tick], t=0.008, gain=300)
    tick = tick + 1
  end
  stopj(2)
  stirred = get_actual_joint_positions()
  set_standard_digital_out(1, stirred[5] - base_q[5] > 0.18)
  set_standard_digital_out(2, is_steady())
end
"""


@pytest.mark.parametrize("target", OTHERS)
def test_stops_and_questions_where_the_robot_rests(target: str) -> None:
    result, losses, text = translated(STIRRED, target)
    assert (result.status, losses) == ("finished", []), text
    assert [each[2] for each in result.outputs] == [True, True, True]


@pytest.mark.parametrize(
    ("target", "line"),
    [("tp", "=PR[3,1:base_q] ;"), ("krl", "=base_q.A1"), ("vplus", "]+0.005*tick*57.29577951308232)")],
)
def test_joints_that_stay_are_not_turned_into_radians_and_back(target: str, line: str) -> None:
    _, _, text = translated(STIRRED, target)
    assert line in text


@pytest.mark.parametrize("target", ["krl", "tp"])
def test_behind_a_corner_the_robot_does_not_rest(target: str) -> None:
    moves = "movel(p[0.4, -0.2, 0.4, 3.1416, 0, 0], r=0.02)\n  movel(p[0.45, -0.2, 0.4, 3.1416, 0, 0], r=0.02)"
    _, losses, _ = translated(f"def main():\n  {moves}\n  stopl(1)\n  set_standard_digital_out(0, True)\nend\n", target)
    assert losses


@pytest.mark.parametrize(
    "line",
    [
        "speedl([0, 0, 0.02, 0, 0, 0], a=0.5, t=1.0)",
        "speedl([0.01, 0, 0, 0, 0, 0.1], a=1.2, t=0.5)",
        "speedj([0.1, 0, 0, 0, 0, -0.2], a=1.4, t=0.5)",
    ],
)
def test_speeds_are_written_as_they_were(line: str) -> None:
    program, _ = read(f"def main():\n  {line}\nend\n")
    assert any(isinstance(one, ir.Move) for module in program.modules for one in module.routines[0].body)
    (file,) = registry.target("urscript").write(program, WriteContext(Diagnostics(), foreign=False))
    assert line in file.data.decode()
