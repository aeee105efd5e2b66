"""A program that says which part its gripper takes knows where it is: its data agree with the world of the cell."""

from pathlib import Path

import pytest

from rpl.cell import read_cell
from rpl.diagnostics import Diagnostics
from rpl.workcell.loading import robots_of
from rpl.workcell.outcome import outcome_of
from rpl.workcell.running import run_cell

CELL = """
[[robot]]
name = "kuka"
arm = "kuka_kr6r900sixx"
programs = ["carry.rpl"]

[[gripper]]
name = "jaws"
kind = "jaws"
grip = [0, 0, 150]
close = "do[1]"
time = 0.2
opening = [0, 80]

[[fixture]]
name = "table"
box = [600, 800, 30]
at = [500, 0, -15]

[[part]]
name = "box"
box = [60, 50, 50]
at = [500, -200, 25]
mass = 0.4
"""
PROGRAM = """
GRIPPER hand = do[1] TIME 0.4 s
VAR home: JOINTS = {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}
FRAME box = {x: 500, y: -200, z: 25, a: 0, b: 0, c: 0}
FRAME grip = {x: 0, y: 0, z: 0, a: 0, b: 180, c: 0} ON box
FRAME place = {x: 450, y: 150, z: 25.01, a: TURN, b: 180, c: 0}
$tool = pose {x: 0, y: 0, z: 150, a: 0, b: 0, c: 0}
MOVE TO home
OPEN hand
MOVE TO tool_offset(grip, 0, 0, -100)
MOVE LINEAR TO grip
CLOSE hand ON box
MOVE LINEAR BY {z: -100} IN TOOL
MOVE TO tool_offset(place, 0, 0, -100)
MOVE LINEAR TO place
OPEN hand
MOVE LINEAR BY {z: -100} IN TOOL
MESSAGE number_text(box.x, 3)
MESSAGE number_text(box.y, 3)
MESSAGE number_text(box.z, 3)
MESSAGE number_text(cos(box.a), 6)
MESSAGE number_text(sin(box.a), 6)
MOVE TO home
"""


@pytest.mark.parametrize("turn", [0, 30, -75])
def test_the_part_lies_where_the_program_says(turn: int, tmp_path: Path) -> None:
    (tmp_path / "carry.rpl").write_text(PROGRAM.replace("TURN", str(turn)), "utf-8")
    (tmp_path / "cell.toml").write_text(CELL, "utf-8")
    diagnostics = Diagnostics()
    loaded = robots_of(read_cell(tmp_path / "cell.toml"), diagnostics)
    assert [item.as_text() for item in diagnostics] == []
    made = run_cell(read_cell(tmp_path / "cell.toml"), [one.driven for one in loaded])
    assert made.status == "finished"
    assert [(one.part, one.ok) for one in made.grasps] == [("box", True)]
    (box,) = outcome_of(made).parts
    told = [float(event.data["text"]) for event in made.robots[0].result.trace if event.kind == "message"]
    assert told[:3] == pytest.approx(box.pose[:3, 3], abs=0.05)
    assert told[3:] == pytest.approx(box.pose[:2, 0], abs=1e-3)
