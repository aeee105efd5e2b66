"""The acceleration on paths that a language gives every program, where the target's is another one."""

from __future__ import annotations

import pytest

from rpl.simulation import run_program
from tests.there_and_back import Journey, there_and_back

KUKA = "kuka_kr16_2"
RPL = """PROCEDURE main()
    VAR place: POSE = {{x: 900, y: 0, z: 500, a: 0, b: 180, c: 0}}
    VAR home: JOINTS = {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}}
    MOVE TO home JOINT SPEED 50 %
    MOVE LINEAR TO place SPEED 250 mm/s
    {steps}
    SET do[1] TO ON
END PROCEDURE
"""
STEPS = {
    "short moves": "MOVE LINEAR TO offset(place, 0, 60, 0) SPEED 400 mm/s\nMOVE LINEAR TO place SPEED 400 mm/s",
    "a relative move of a time": "MOVE LINEAR BY {y: 100} DURATION 3 s",
    "one along the tool": "MOVE LINEAR BY {z: -60} IN TOOL DURATION 2 s",
}


def written(steps: str, target: str) -> Journey:
    return there_and_back({"a.rpl": RPL.format(steps=steps)}, "rpl", target, KUKA)


@pytest.mark.parametrize("case", STEPS)
def test_paths_take_as_long_as_in_the_source(case: str) -> None:
    journey = written(STEPS[case], "krl")
    assert "$ACC.CP=2.0" in journey.text
    own = run_program(journey.source.program, KUKA, None, "main", 60.0)
    times = [[one.data["duration"] for one in run.trace if one.kind == "move"][2:] for run in (own, journey.run())]
    assert times[0] and times[1] == pytest.approx(times[0], abs=0.01)
    assert "accelerations-differ" not in {item.code.name for item in journey.found}


@pytest.mark.parametrize("target", ["tp", "vplus", "inform"])
def test_where_no_setting_says_it_the_difference_is_told(target: str) -> None:
    assert "accelerations-differ" in {item.code.name for item in written(STEPS["short moves"], target).found}


SCRIPT = """def cell():
  movej([3.14, -1.57, 1.57, -1.57, -1.57, 0], a=1.4, v=1.05)
  movel(p[0.4, -0.1, 0.25, 3.1415926, 0, 0], a=1.2, v=0.25)
  movel(p[0.4, 0.05, 0.25, 3.1415926, 0, 0], a={rate}, v=0.25)
  movel(p[0.4, -0.1, 0.25, 3.1415926, 0, 0], v=0.25)
end
cell()
"""


def test_moves_with_an_acceleration_of_their_own() -> None:
    usual = there_and_back({"cell.script": SCRIPT.format(rate="1.2")}, "urscript", "krl", "ur5e").text
    assert usual.count("$ACC.CP=") == 1 and "$ACC.CP=1.2" in usual
    other = there_and_back({"cell.script": SCRIPT.format(rate="0.5")}, "urscript", "krl", "ur5e").text
    lines = [line.strip() for line in other.splitlines() if "$ACC.CP=" in line]
    assert lines == ["$ACC.CP=1.2", "$ACC.CP=0.5", "$ACC.CP=1.2"]


def test_a_language_that_says_none_changes_nothing() -> None:
    text = "MODULE M\nPROC main()\nMoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;\n"
    text += "MoveL Offs(CRobT(),0,0,20),v100,fine,tool0;\nENDPROC\nENDMODULE\n"
    journey = there_and_back({"M.mod": text}, "rapid", "krl", "abb_irb1200_5_90")
    assert "$ACC.CP" not in journey.text
