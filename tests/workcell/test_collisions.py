"""Collisions of runs of cells: who, when, how deep, at which line, and what is none."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rpl
from rpl.cell.armbodies import arm_bodies, link_poses
from rpl.cell.layout import Body, Gripper, Layout, Part, RobotPlace, Switch
from rpl.cell.shapes import Box, Capsule, Cylinder, Extrusion, Sphere
from rpl.emulator.model import RobotModel, load_robot
from rpl.emulator.rotations import FloatArray
from rpl.errors import UsageError
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.workcell.collisions import Collisions, distance_over_time, find_collisions
from rpl.workcell.record import CellRun, Grasp, Placed
from tests.workcell.cellruns import at, cell, driven, fixture, standing, straight, to_joints

KUKA = load_robot("kuka_kr6r900sixx")
HOME = (0.0, -90.0, 90.0, 0.0, 0.0, 0.0)
DOWN = at(500, 0, 500, 0, 180, 0)  # the flange looks down
ONE = (RobotPlace("kuka"),)


def joints_down(x: float, y: float, z: float) -> list[float]:
    """Joints that bring the flange to a place, looking down."""
    found = KUKA.nearest(at(x, y, z, 0, 180, 0), np.array([0.0, -60.0, 90.0, 0.0, 60.0, 0.0]))
    assert found is not None
    return [float(value) for value in found]


def who(found: Collisions) -> list[tuple[str, str]]:
    return [(one.a, one.b) for one in found.collisions]


def test_an_arm_that_goes_through_a_post_is_told_with_its_line() -> None:
    post = fixture("post", Cylinder(60, 600), at(540, 0, 300))
    start = joints_down(500, -300, 400)
    run = driven(KUKA, straight(at(500, -200, 400, 0, 180, 0)), straight(at(500, 300, 400, 0, 180, 0)), start=start)
    found = find_collisions(cell(Layout(ONE, fixtures=(post,)), (KUKA, run)))
    (first,) = [one for one in found.collisions if one.a == "kuka.link5"]
    assert first.b == "post"
    assert (first.origin.file, first.origin.line) == ("moves.txt", 2)
    assert found.as_json()["collisions"][0].keys() >= {"t", "a", "b", "file", "line", "depth_mm"}  # type: ignore


def flange_on_its_way(run: RunResult, t: float) -> FloatArray:
    leg = next(leg for event in run.trace for leg in event.legs if leg.start_s <= t <= leg.start_s + leg.duration_s)
    return KUKA.forward(leg.plan.joints_at(t - leg.start_s))


def test_first_contact_is_when_the_surfaces_meet() -> None:
    """The flange, a disc of 63.1 mm, comes down on a table: it touches when its face is at the table's height."""
    table = fixture("table", Box((400, 400, 100)), at(500, 0, 250))
    run = driven(KUKA, straight(at(500, 0, 280, 0, 180, 0)), start=joints_down(500, 0, 400))
    collisions = find_collisions(cell(Layout(ONE, fixtures=(table,)), (KUKA, run))).collisions
    (found,) = [one for one in collisions if one.a == "kuka.link6"]
    assert found.b == "table"
    assert flange_on_its_way(run, found.t)[2, 3] == pytest.approx(300.0, abs=0.03)
    assert found.depth_mm == pytest.approx(20.0, abs=1e-3)
    assert found.until_s == pytest.approx(run.time_s)
    assert found.at_mm[2] == pytest.approx(300.0, abs=0.05)


@pytest.mark.parametrize("step_s", [0.5, 0.02, 0.004, 0.001])
def test_no_plate_is_too_thin_at_2_metres_a_second(step_s: float) -> None:
    plate = fixture("plate", Box((100, 1, 100)), at(500, 150, 400))
    run = driven(KUKA, straight(at(500, 400, 400, 0, 180, 0), 2000.0), start=joints_down(500, -400, 400))
    layout = Layout(ONE, fixtures=(plate,))
    found = find_collisions(cell(layout, (KUKA, run)), step_s)
    assert ("kuka.link6", "plate") in who(found)
    same = find_collisions(cell(layout, (KUKA, run)), 0.004)
    assert who(found) == who(same)
    for one, other in zip(found.collisions, same.collisions, strict=True):
        assert one.t == pytest.approx(other.t, abs=1e-4)
        assert one.until_s == pytest.approx(other.until_s, abs=1e-4)
        assert one.depth_mm == pytest.approx(other.depth_mm, abs=0.01)


def ball_distance(joints: FloatArray, link: int, ball: tuple[float, float, float], diameter: float) -> FloatArray:
    """From all capsules of a link to a ball, by closed form, at joints (k, n)."""
    poses, found = link_poses(KUKA, joints)[:, link], []
    for body in arm_bodies(KUKA):
        if body.link == link:
            assert isinstance(body.shape, Capsule)
            placed = poses @ body.at
            off = np.array(ball) - placed[:, :3, 3]
            along = np.clip((off * placed[:, :3, 2]).sum(axis=1), -body.shape.length / 2, body.shape.length / 2)
            away = np.linalg.norm(off - along[:, None] * placed[:, :3, 2], axis=1)
            found.append(away - (body.shape.diameter + diameter) / 2.0)
    return np.min(found, axis=0)


turns = st.tuples(
    st.floats(-100, 100), st.floats(-120, -40), st.floats(40, 120), st.floats(-90, 90), st.floats(-90, 90)
)


@given(turns, turns, st.tuples(st.floats(200, 700), st.floats(-400, 400), st.floats(300, 900)), st.floats(5, 200))
@settings(max_examples=60, deadline=None)
def test_the_sweep_finds_what_fine_sampling_finds(
    start: tuple[float, ...], end: tuple[float, ...], ball: tuple[float, float, float], diameter: float
) -> None:
    run = driven(KUKA, to_joints(*end, 0.0), start=[*start, 0.0])
    layout = Layout(ONE, fixtures=(fixture("ball", Sphere(diameter), at(*ball)),), near_mm=50.0)
    found = find_collisions(cell(layout, (KUKA, run)))
    times = np.linspace(0.0, run.time_s, int(run.time_s / 2e-4) + 2)
    joints = run.trace[0].legs[0].plan.joints_at(times)
    for link in (2, 3, 4):
        away = ball_distance(joints, link, ball, diameter)
        spans = [one for one in found.collisions if one.a == f"kuka.link{link}"]
        inside = np.zeros(len(times), dtype=bool)
        for one in spans:
            inside |= (times >= one.t - 1e-4) & (times <= one.until_s + 1e-4)
        assert inside[away < -0.05].all()
        assert (away[inside] < 0.6).all()  # as far as it goes in 0.1 ms
        if spans:
            assert max(one.depth_mm for one in spans) == pytest.approx(-away.min(), abs=0.05)
        near = [one for one in found.near if one.a == f"kuka.link{link}"]
        if 0.1 < away.min() < 49.0:
            assert [one.distance_mm for one in near] == [pytest.approx(away.min(), abs=0.05)]
        assert bool(near) <= (away.min() < 50.01 and not spans)


def test_two_arms_that_reach_for_one_place_collide() -> None:
    places = (RobotPlace("left"), RobotPlace("right", base=at(1020, 0, 0, 180)))
    start = joints_down(300, 0, 500)
    moving = driven(KUKA, straight(at(520, 0, 500, 0, 180, 0)), start=start)
    other = driven(KUKA, to_joints(*start), straight(at(520, 0, 500, 0, 180, 0)), start=start)
    found = find_collisions(cell(Layout(places), (KUKA, moving), (KUKA, other)))
    assert ("left.link6", "right.link6") in who(found)
    one = next(one for one in found.collisions if one.a == "left.link6" and one.b == "right.link6")
    assert one.origin.line == 1
    assert one.other_origin is not None and one.other_origin.line == 2
    waiting = standing(KUKA, start, moving.time_s)
    assert not find_collisions(cell(Layout(places), (KUKA, moving), (KUKA, waiting))).collisions


def test_a_collision_that_stands_already_begins_at_zero() -> None:
    block = fixture("block", Box((100, 100, 100)), at(500, 0, 500))
    run = standing(KUKA, joints_down(500, 0, 540), 2.0)
    found = find_collisions(cell(Layout(ONE, fixtures=(block,)), (KUKA, run))).collisions
    assert [(one.a, one.t, one.until_s, one.origin.line) for one in found] == [("kuka.link6", 0.0, 2.0, 0)]
    away = driven(KUKA, straight(at(500, 0, 700, 0, 180, 0)), start=joints_down(500, 0, 540))
    found = find_collisions(cell(Layout(ONE, fixtures=(block,)), (KUKA, away))).collisions
    assert [(one.a, one.t, one.origin.line) for one in found] == [("kuka.link6", 0.0, 1)]


def test_an_arm_can_hit_itself() -> None:
    """Leaning forward, with the forearm folded back under the upper arm, it comes to its own foot."""
    run = driven(KUKA, to_joints(0, 40, 147, 0, -50, 0), start=HOME)
    found = who(find_collisions(cell(Layout(ONE), (KUKA, run))))
    assert ("kuka.base", "kuka.link4") in found
    assert all(a.startswith("kuka.") and b.startswith("kuka.") for a, b in found)


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "abb_irb120_3_58", "fanuc_lrmate200id", "motoman_gp8", "ur5e"])
def test_neighbours_never_collide(name: str) -> None:
    model = load_robot(name)
    middle = model.limits.mean(axis=1)
    run = driven(model, to_joints(*(model.home + 0.2 * (middle - model.home))), start=list(model.home))
    for a, b in who(find_collisions(cell(Layout(ONE), (model, run)))):
        assert abs(int(a[-1]) - int(b[-1])) > 2


JAWS = Gripper(
    "jaws",
    "jaws",
    "kuka",
    grip=at(0, 0, 100),
    bodies=(Body(Box((60, 120, 60)), at(0, 0, 30)), Body(Box((20, 10, 60)), at(0, 30, 90)),
            Body(Box((20, 10, 60)), at(0, -30, 90))),
    close=Switch("do1"),
)  # fmt: skip
TABLE = fixture("table", Box((600, 900, 50)), at(500, 0, 175))  # its top at z = 200
CUBE = Part("cube", Box((50, 50, 50)), at(500, 0, 225))


def picked_and_placed(drop_mm: float = 0.0, **more: object) -> tuple[CellRun, list[float]]:
    """The cube is taken up at x 500, y 0 and put down 200 mm beside; `drop_mm`: so much too low."""
    low = 225.0 + 100.0
    moves = [
        straight(at(500, 0, low, 0, 180, 0)),
        straight(at(500, 0, low + 100, 0, 180, 0)),
        straight(at(500, 200, low + 100, 0, 180, 0)),
        straight(at(500, 200, low - drop_mm, 0, 180, 0)),
        straight(at(500, 200, low + 100, 0, 180, 0)),
    ]
    run = driven(KUKA, *moves, start=joints_down(500, 0, low + 100), pause_s=0.2)
    ends = [leg.start_s + leg.duration_s for event in run.trace for leg in event.legs]
    down, up = ends[0] + 0.1, ends[3] + 0.1
    held = np.linalg.inv(flange_on_its_way(run, ends[0])) @ CUBE.at
    put = flange_on_its_way(run, ends[3]) @ held
    places = (
        Placed(0.0, "cube", "rests", CUBE.at, "table"),
        Placed(down, "cube", "held", held, "jaws"),
        Placed(up, "cube", "rests", put, "table"),
    )
    layout = Layout(ONE, (JAWS,), (TABLE, *more.pop("fixtures", ())), (CUBE, *more.pop("parts", ())), **more)  # type: ignore
    grasps = (Grasp(down, "jaws", "cube", True),)
    return cell(layout, (KUKA, run), placed=places, grasps=grasps), [down, up]


def test_picking_and_placing_is_no_collision() -> None:
    run, _ = picked_and_placed()
    found = find_collisions(run)
    assert who(found) == []
    assert ("cube", "table") not in [(one.a, one.b) for one in found.near]


def test_what_is_held_moves_with_the_arm() -> None:
    wall = fixture("wall", Box((400, 10, 105)), at(500, 100, 252.5))  # 305 high: jaws pass above it, the cube does not
    run, (down, up) = picked_and_placed(fixtures=(wall,))
    (found,) = find_collisions(run).collisions
    assert (found.a, found.b) == ("wall", "cube")
    assert found.origin.line == 3
    assert down < found.t < up
    assert found.depth_mm == pytest.approx(5.0, abs=0.01)


def test_a_part_pressed_into_its_support_is_a_collision() -> None:
    assert who(find_collisions(picked_and_placed(drop_mm=0.5)[0])) == []
    (found,) = [one for one in find_collisions(picked_and_placed(drop_mm=3.0)[0]).collisions if one.b == "cube"]
    assert (found.a, found.origin.line) == ("table", 4)
    assert found.depth_mm == pytest.approx(3.0, abs=0.01)


def test_a_part_that_stands_in_the_way_is_hit() -> None:
    other = Part("other", Box((50, 50, 200)), at(500, 120, 300))
    run, _ = picked_and_placed(parts=(other,))
    run = CellRun(run.layout, run.robots, (*run.placed, Placed(0.0, "other", "rests", other.at, "table")), run.grasps,
                  time_s=run.time_s)  # fmt: skip
    assert set(who(find_collisions(run))) >= {("jaws", "other"), ("other", "cube")} or set(
        who(find_collisions(run))
    ) >= {("jaws", "other"), ("cube", "other")}


@pytest.mark.parametrize("pair", [("wall", "cube"), ("cube", "wall")])
def test_allowed_pairs_may_touch(pair: tuple[str, str]) -> None:
    wall = fixture("wall", Box((400, 10, 105)), at(500, 100, 252.5))
    assert who(find_collisions(picked_and_placed(fixtures=(wall,), allowed=(pair,))[0])) == []


def test_the_name_of_a_robot_allows_all_its_links() -> None:
    post = fixture("post", Cylinder(60, 600), at(600, 0, 300))
    run = driven(KUKA, straight(at(500, 300, 400, 0, 180, 0)), start=joints_down(500, -300, 400))
    layout = Layout(ONE, fixtures=(post,), allowed=(("post", "kuka"),))
    assert who(find_collisions(cell(layout, (KUKA, run)))) == []


def test_near_misses_have_their_distance_and_line() -> None:
    wall = fixture("wall", Box((400, 10, 97)), at(500, 100, 248.5))  # 297 high, 3 mm below the cube's way
    found = find_collisions(picked_and_placed(fixtures=(wall,), near_mm=10.0)[0])
    assert who(found) == []
    (near,) = [one for one in found.near if one.b == "cube"]
    assert (near.a, near.origin.line) == ("wall", 3)
    assert near.distance_mm == pytest.approx(3.0, abs=0.01)


def test_distances_over_time_go_down_to_the_near_miss() -> None:
    wall = fixture("wall", Box((400, 10, 97)), at(500, 100, 248.5))
    run, (down, up) = picked_and_placed(fixtures=(wall,), near_mm=10.0)
    times = np.linspace(down, up, 400)[1:-1]
    away = distance_over_time(run, "cube", "wall", times)
    (near,) = [one for one in find_collisions(run).near if one.b == "cube"]
    assert away.min() == pytest.approx(near.distance_mm, abs=0.05)
    with pytest.raises(UsageError, match="nothing of the cell is called 'wal'"):
        distance_over_time(run, "cube", "wal", times)


HOLLOW = """\
<robot name="fork">
  <link name="base_link"/>
  <link name="fork">
    <collision><geometry><mesh filename="fork.obj"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="base_link"/><child link="fork"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
</robot>
"""


@pytest.mark.parametrize(("y", "touches"), [(0.0, False), (0.05, True), (-0.05, True)])
def test_the_mesh_of_a_urdf_is_hollow_where_it_is(tmp_path: Path, y: float, touches: bool) -> None:
    """Two prongs slide past a thin post: between them, or into one."""
    prongs = Extrusion(((0, -80), (300, -80), (300, -40), (50, -40), (50, 40), (300, 40), (300, 80), (0, 80)), 50.0)
    facets = prongs.facets
    lines = ["v {} {} {}".format(*(vertex / 1000.0)) for vertex in facets.vertices]
    lines += ["f {} {} {}".format(*(face + 1)) for face in facets.faces]
    (tmp_path / "fork.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (tmp_path / "fork.urdf").write_text(HOLLOW, encoding="utf-8")
    model = load_robot(str(tmp_path / "fork.urdf"))
    post = fixture("post", Cylinder(10, 400), at(300, 1000 * y, 0))
    run = driven(model, to_joints(280), start=[-200])
    found = find_collisions(cell(Layout((RobotPlace("fork"),), fixtures=(post,)), (model, run)))
    assert who(found) == ([("fork.link1", "post")] if touches else [])


def test_a_run_is_searched_the_same_way_twice() -> None:
    run, _ = picked_and_placed(fixtures=(fixture("wall", Box((400, 10, 105)), at(500, 100, 252.5)),))
    assert find_collisions(run).as_json() == find_collisions(run).as_json()


def test_a_program_of_the_samples_meets_what_stands_in_its_way() -> None:
    program = rpl.read([Path(__file__).parents[2] / "samples" / "krl" / "palletiser"])
    result = run_program(program.program, KUKA)
    post = fixture("post", Cylinder(80, 900), at(450, 300, 450))
    run = CellRun(Layout(ONE, fixtures=(post,)), cell(Layout(ONE), (KUKA, result)).robots, time_s=result.time_s)
    found = find_collisions(run)
    assert {one.b for one in found.collisions} == {"post"}
    assert all(one.origin.file.endswith("palletiser.src") and one.origin.line > 0 for one in found.collisions)
    assert all(first.t <= second.t for first, second in pairwise(found.collisions))


def test_other_families_of_arms_collide_as_well() -> None:
    scara: RobotModel = load_robot("adept_cobra_s600")
    post = fixture("post", Cylinder(60, 900), at(400, 200, 450))
    run = driven(scara, to_joints(60, 30, 0, 0), start=[-60, 30, 0, 0])
    assert ("kuka.link2", "post") in who(find_collisions(cell(Layout(ONE, fixtures=(post,)), (scara, run))))
