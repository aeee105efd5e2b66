"""The sweep as a whole: its poses against Pinocchio, blocks of moments, arms on tracks."""

from pathlib import Path

import numpy as np
import pytest

from rpl.cell.layout import Body, Gripper, Layout, RobotPlace
from rpl.cell.shapes import Box, Cylinder, Extrusion
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest
from rpl.workcell import collisions
from rpl.workcell.collisions import find_collisions
from rpl.workcell.record import CellRun
from rpl.workcell.sweeping.geometrymodel import geometry_model
from rpl.workcell.sweeping.scene import scene_of
from rpl.workcell.sweeping.sweep import Meter
from tests.workcell.cellruns import at, cell, driven, fixture, standing, to_joints

HAND = Gripper("hand", "jaws", bodies=(Body(Box((60, 110, 50)), at(0, 0, 25)), Body(Box((20, 10, 60)), at(0, 30, 80))))
U_SHAPE = ((0, 0), (300, 0), (300, 200), (200, 200), (200, 50), (100, 50), (100, 200), (0, 200))


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "fanuc_lrmate200id", "ur5e", "adept_cobra_s600", "puma560"])
def test_distances_are_those_of_pinocchios_geometry_model(name: str) -> None:
    """The same solids, moved by Pinocchio's kinematics instead of ours, in a cell where the base is turned."""
    model, base = load_robot(name), at(300, -200, 100, 40, 5, -10)
    fixtures = (fixture("table", Box((800, 800, 40)), at(700, 0, 50)),
                fixture("fork", Extrusion(U_SHAPE, 100.0), at(500, 500, 400, 30, 20, 10)))  # fmt: skip
    layout = Layout((RobotPlace("arm", base=base),), (HAND,), fixtures)
    postures = np.random.default_rng(5).uniform(model.limits[:, 0], model.limits[:, 1], (10, model.axes))
    for joints in postures:
        scene = scene_of(cell(layout, (model, standing(model, list(joints), 1.0))))
        meetings = list(scene.meetings())
        numbers = {id(piece): number for number, piece in enumerate(scene.pieces)}
        pairs = [(numbers[id(one.first)], numbers[id(one.second)]) for one in meetings]
        geometry = geometry_model(model, scene.pieces, pairs, base)
        meter = Meter(scene.ways)
        ours = [meter.at(one.first, one.second, 0.5) for one in meetings]
        theirs = geometry.distances(model.theta(joints))
        shallow = [(a, b) for a, b in zip(ours, theirs, strict=True) if b > -1.0]
        assert len(shallow) > 10
        assert np.allclose(*np.array(shallow).T, atol=0.05)
        assert [one < 0.0 for one in ours] == [one < 0.0 for one in theirs]


def told(run: CellRun, step_s: float = 0.004) -> list[tuple[str, str, float, float, float]]:
    return [
        (one.a, one.b, round(one.t, 3), round(one.until_s, 3), round(one.depth_mm, 1))
        for one in find_collisions(run, step_s).collisions
    ]


def test_blocks_of_moments_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    model = load_robot("kuka_kr6r900sixx")
    post = fixture("post", Cylinder(120, 900), at(450, 100, 450))
    run = driven(model, to_joints(-60, -60, 90, 0, 40, 0), to_joints(60, -50, 80, 20, 60, 30), start=model.home)
    whole = told(cell(Layout((RobotPlace("arm"),), (HAND,), (post,)), (model, run)))
    assert len(whole) > 2
    monkeypatch.setattr(collisions, "BLOCK", 17)
    assert told(cell(Layout((RobotPlace("arm"),), (HAND,), (post,)), (model, run))) == whole


TRACK = """

[[mechanism]]
name = "track"
kind = "track"
carries = "robot"
axes = [{ number = 1, direction = "y", limits = [-2000, 2000], speed = 500, acceleration = 2000 }]
"""


def test_an_arm_on_a_track_takes_its_bodies_along(tmp_path: Path) -> None:
    packaged = (Path(__file__).parents[2] / "rpl" / "robots" / "kuka_kr6r900sixx.toml").read_text("utf-8")
    (tmp_path / "riding.toml").write_text(packaged + TRACK, encoding="utf-8")
    model = load_robot(str(tmp_path / "riding.toml"))
    ride = MoveRequest(
        "joint",
        target_joints=np.array(model.home),
        external_start=(0.0,),
        external_target=(1000.0,),
        external_speeds=(500.0,),
        external_accs=(2000.0,),
    )
    run = driven(model, ride, start=model.home)
    post = fixture("post", Cylinder(60, 900), at(0, 600, 450))
    found = find_collisions(cell(Layout((RobotPlace("arm"),), fixtures=(post,)), (model, run))).collisions
    first = next(one for one in found if one.a == "arm.base")
    leg = run.trace[0].legs[0]
    radius = next(body for body in scene_of(cell(Layout(), (model, run))).pieces).solid.half[0]
    ridden = float(leg.plan.external_at(first.t)[0])
    assert ridden == pytest.approx(600.0 - 30.0 - radius, abs=0.05)
