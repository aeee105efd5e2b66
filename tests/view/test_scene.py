"""Where things are at a time: links by screws, tools, parts in the hand and falling, jaws, lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.cell.layout import Body, Layout, RobotPlace
from rpl.cell.record import Placed
from rpl.cell.shapes import Box
from rpl.emulator.model import load_robot, robot_names
from rpl.emulator.rotations import pose_matrix, rotation_vector_to_matrix
from rpl.report.screws import screws_of
from rpl.simulation import run_program
from rpl.view.document import view_document
from rpl.view.packing import unpacked
from rpl.view.scene import Scene, scene_of
from rpl.workcell.record import CellRun, RobotRun
from tests.runtime.helpers import ABB, read
from tests.view.cells import IN_HAND, LAYOUT, at, cell_run


@pytest.fixture(scope="module")
def scene() -> Scene:
    return scene_of(cell_run())


@pytest.mark.parametrize("name", robot_names())
def test_screws_bring_the_flange_where_forward_kinematics_has_it(name: str) -> None:
    model = load_robot(name)
    joints = np.random.default_rng(7).uniform(-170.0, 170.0, (20, model.axes))
    screws = screws_of(model)
    theta = (joints @ screws.matrix.T - screws.offsets) * screws.unit
    for number in range(20):
        pose = np.eye(4)
        for axis, slides in enumerate(screws.sliding):
            turn = np.eye(3) if slides else rotation_vector_to_matrix(theta[number, axis] * screws.directions[axis])
            way = theta[number, axis] * screws.directions[axis] if slides else np.zeros(3)
            pose = pose @ pose_matrix(way + screws.points[axis] - turn @ screws.points[axis], turn)
        assert pose @ screws.flange == pytest.approx(model.forward(joints[number]), abs=1e-8)


def pose_of(scene: Scene, name: str, t: float, which: int = 0) -> np.ndarray:
    poses = scene.poses_at(t)
    found = [pose for body, pose in zip(scene.bodies, poses, strict=True) if body.name == name][which]
    assert found is not None
    return found


def test_a_part_rests_goes_with_the_flange_falls_and_rests(scene: Scene) -> None:
    assert pose_of(scene, "plug", 0.5)[:3, 3] == pytest.approx([500.0, 0.0, 30.0])
    joints = scene.joints_at(1.5)[0]
    assert joints is not None
    assert pose_of(scene, "plug", 1.5) == pytest.approx(scene.flange_at(0, joints, 1.5) @ IN_HAND)
    assert pose_of(scene, "plug", 2.25)[:3, 3] == pytest.approx([400.0, 0.0, 230.0])
    assert pose_of(scene, "plug", 99.0)[:3, 3] == pytest.approx([400.0, 0.0, 30.0])


def test_a_part_that_has_not_come_or_was_taken_away_is_not_there() -> None:
    placed = (Placed(1.0, "plug", "rests", at(500.0, 0.0, 30.0)), Placed(2.0, "plug", "gone", at(500.0, 0.0, 30.0)))
    fed = replace(LAYOUT.parts[0], name="fed", again_s=0.5)  # of which the run says nothing: still to be brought
    run = replace(cell_run(), layout=replace(LAYOUT, parts=(*LAYOUT.parts, fed)), placed=placed)
    scene = scene_of(run)
    there = [
        [pose is not None for body, pose in zip(scene.bodies, scene.poses_at(t), strict=True) if body.kind == "part"]
        for t in (0.5, 1.5, 2.5)
    ]
    assert there == [[False, False], [True, False], [False, False]]


def test_bodies_beside_the_grip_are_jaws_that_move() -> None:
    fingers = tuple(Body(Box((20.0, 10.0, 90.0)), at(0.0, side * 50.0, 105.0)) for side in (1, -1))
    palm = LAYOUT.grippers[0].bodies
    gripper = replace(LAYOUT.grippers[0], bodies=(*palm, *fingers), opening=(0.0, 80.0))
    run = replace(cell_run(), layout=replace(LAYOUT, grippers=(gripper,)))
    scene = scene_of(run)
    assert [body.kind for body in scene.bodies if body.name.startswith("jaws")] == ["tool", "jaw", "jaw"]
    for t, apart in ((0.5, 100.0), (1.5, 50.0)):  # open as they are given; closed by 80 - 30 mm
        left, right = (pose_of(scene, "jaws", t, which)[:3, 3] for which in (1, 2))
        assert np.linalg.norm(left - right) == pytest.approx(apart)


RAIL = """[[mechanism]]
name = "rail"
kind = "track"
root = [0, -500, 0, 0, 0, 0]
axes = [{ number = 1, direction = "y", speed = 1000 }]
"""
RIDES = """MODULE prog
  CONST jointtarget far:=[[0,0,0,0,30,0],[900,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ far,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_a_robot_on_a_track_goes_with_it() -> None:
    cell = parse_cell(RAIL, "rail.toml")
    model = load_robot(ABB).among(cell.mechanisms, "rail.toml")
    program = read("rapid", RIDES)
    result = run_program(program, model, cell)
    place = RobotPlace(arm=ABB, base=at(100.0, 0.0, 0.0))
    scene = scene_of(CellRun(Layout((place,)), (RobotRun(place, model, program, result),), time_s=result.time_s))
    track = scene.tracks[0]
    assert track.bases is not None
    assert scene.base_at(0, 0.0)[:3, 3] == pytest.approx([100.0, 0.0, 0.0])
    assert scene.base_at(0, result.time_s)[:3, 3] == pytest.approx([100.0, 900.0, 0.0], abs=1e-6)
    joints = track.joints_at(result.time_s)
    assert scene.flange_at(0, joints, result.time_s)[:3, 3] == pytest.approx(track.tool[-1], abs=1e-6)
    document = view_document(scene, "rail")["robots"]
    assert isinstance(document, list)
    assert unpacked(document[0]["places"])[-1] == pytest.approx([100.0, 900.0, 0.0], abs=0.01)


def test_jaws_stand_as_far_apart_as_the_gripper_is_open(scene: Scene) -> None:
    for t, width in ((0.5, 120.0), (1.5, 30.0), (3.0, 80.0)):
        left, right = (pose_of(scene, "jaws", t, side)[:3, 3] for side in (1, 2))
        inner = np.linalg.norm(left - right) - 6.0  # two halves of their thickness
        assert inner == pytest.approx(width)


def test_the_tool_goes_where_the_run_says(scene: Scene) -> None:
    run = scene.run.robots[0]
    track = scene.tracks[0]
    last = [event for event in run.result.trace if event.kind == "move"][-1]
    assert track.tool[-1] - run.place.base[:3, 3] == pytest.approx(last.data["xyz_mm"], abs=1e-3)
    joints = track.joints_at(track.times[-1])
    assert (scene.flange_at(0, joints, 1.5) @ track.tool_at(track.times[-1]))[:3, 3] == pytest.approx(
        track.tool[-1], abs=1e-6
    )
    assert track.speeds[track.times > 1.5].max() == pytest.approx(200.0, rel=0.05)  # $VEL.CP


def test_joints_between_samples_are_those_of_the_plan(scene: Scene) -> None:
    run, track = scene.run.robots[0], scene.tracks[0]
    for event in run.result.trace:
        for leg in event.legs:
            for t in np.linspace(leg.start_s, leg.start_s + leg.duration_s, 37):
                planned = leg.plan.joints_at(min(t - leg.start_s, leg.duration_s) + leg.offset_s)
                assert track.joints_at(float(t)) == pytest.approx(planned, abs=0.1)


@pytest.mark.parametrize(("t", "line"), [(0.0, 4), (1.0, 6), (2.5, 7)])
def test_the_line_of_the_move_that_is_driven(scene: Scene, t: float, line: int) -> None:
    found = scene.tracks[0].line_at(t)
    assert found is not None
    legs = {
        event.origin.line: (event.legs[0].start_s, event.legs[-1].start_s + event.legs[-1].duration_s)
        for event in scene.run.robots[0].result.trace
        if event.legs
    }
    begin, end = legs[line]
    assert begin <= t < end
    assert found.line in (line, 5, 8)  # or of an output that was switched on the way
