"""Spline blocks: the curve through its points, the path even in distance, one move with the speeds of its segments."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.model import load_robot
from rpl.emulator.paths import arc_through
from rpl.emulator.planner import MotionFault, MoveRequest
from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_angle, zyx_to_matrix
from rpl.emulator.splines import BlockFault, JointSpline, Kind, Run, SplinePath, plan_block, spline_path
from rpl.passes.curves import Leg, Segment, block, circle_through
from rpl.passes.rigid import Pose, Vector, rotation_of_zyx

KR6 = load_robot("kuka_kr6r900sixx")
START = np.array([0, -90, 90, 0, 60, 0.0])
HERE = KR6.forward(START)


def pose(x: float, y: float, z: float, a: float = 0, b: float = 0, c: float = 0) -> Pose:
    return Pose(Vector(x, y, z), rotation_of_zyx(a, b, c))


def spl(*numbers: float) -> Leg:
    return Leg("spline", pose(*numbers))


def runs_of(start: Pose, legs: Sequence[Leg]) -> list[list[Segment]]:
    found = block(start, legs)
    assert isinstance(found, list)
    return found


def path_of(start: Pose, legs: Sequence[Leg]) -> SplinePath:
    (run,) = runs_of(start, legs)
    return spline_path(run)


MIXED = [
    spl(10, 5, 0, 10),
    spl(25, 0, 3, 20, 5),
    Leg("line", pose(45, 0, 3, 20, 5)),
    spl(60, 10, 3, 0, 20),
    Leg("arc", pose(80, 10, 3, 30, 20), Vector(70, 20, 3), follow=True),
    spl(100, 0, 0, 40),
]

numbers = st.floats(-200, 200).map(lambda value: round(value, 2))
angles = st.floats(-60, 60).map(lambda value: round(value, 2))
poses = st.builds(pose, numbers, numbers, numbers, angles, angles, angles)


def far_apart(points: Sequence[Pose]) -> bool:
    return all(a.position.plus(b.position, -1.0).length > 5.0 for a, b in pairwise(points))


@given(st.lists(poses, min_size=2, max_size=6).filter(far_apart))
@settings(deadline=None, max_examples=60)
def test_the_curve_goes_through_its_points_with_their_orientation(points: list[Pose]) -> None:
    path = path_of(points[0], [Leg("spline", point) for point in points[1:]])
    through = path.poses(path.marks / path.length_mm)
    for found, wanted in zip(through, points, strict=True):
        assert found == pytest.approx(np.array(wanted.matrix), abs=1e-6)


@given(st.lists(poses, min_size=3, max_size=6).filter(far_apart))
@settings(deadline=None, max_examples=60)
def test_the_curve_is_smooth_at_its_points(points: list[Pose]) -> None:
    """Direction, bend and angular speed by the parameter are the same on both sides of every point."""
    (run,) = runs_of(points[0], [Leg("spline", point) for point in points[1:]])
    for one, other in pairwise(run):
        for order in (1, 2):
            ends = [_derivative(segment, at, order) for segment, at in ((one, 1.0), (other, 0.0))]
            assert ends[0] == pytest.approx(ends[1], rel=1e-9, abs=1e-9)
        assert _turning(one, 1.0) == pytest.approx(_turning(other, 0.0), rel=1e-4, abs=1e-6)


def _derivative(segment: Segment, at: float, order: int) -> list[float]:
    polynomials = [np.polynomial.Polynomial(row).deriv(order) for row in segment.position]
    return [float(each(at)) / segment.span**order for each in polynomials]


def _turning(segment: Segment, at: float) -> FloatArray:
    step = 1e-5
    before, behind = (np.array(segment.at(at + side * step).matrix)[:3, :3] for side in (-1.0, 1.0))
    turned = before.T @ behind
    axis = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
    return axis / (4.0 * step * segment.span)


def test_straight_and_circular_segments_are_exact_and_their_neighbours_tangent() -> None:
    """KSS: a straight or circular segment dictates direction and bend to the spline segments beside it."""
    (run,) = runs_of(pose(0, 0, 0), MIXED)
    assert [one.kind for one in run] == ["spline", "spline", "line", "spline", "arc", "spline"]
    assert _derivative(run[1], 1.0, 1) == pytest.approx([1.0, 0.0, 0.0])
    assert _derivative(run[1], 1.0, 2) == pytest.approx([0.0] * 3, abs=1e-12)
    assert _derivative(run[3], 1.0, 1) == pytest.approx([0.0, 1.0, 0.0])  # the arc begins upwards, its radius is 10
    assert _derivative(run[3], 1.0, 2) == pytest.approx([0.1, 0.0, 0.0])
    path = spline_path(run)
    between = path.poses(np.linspace(path.marks[4], path.marks[5], 50) / path.length_mm)[:, :3, 3]
    assert np.linalg.norm(between - [70, 10, 3], axis=1) == pytest.approx(np.full(50, 10.0))


def test_three_points_make_the_parabola_through_them() -> None:
    """INFORM: the path of MOVS is the parabola through three points. By the chords as its parameter (M)."""
    (run,) = runs_of(pose(0, 0, 0), [spl(30, 40, 0), spl(90, 0, 0)])
    for one in run:
        assert [row[3:] for row in one.position] == [pytest.approx([0.0] * 3, abs=1e-9)] * 3
    assert _derivative(run[0], 0.5, 2) == pytest.approx(_derivative(run[1], 0.5, 2))


def test_a_point_moves_two_segments_before_and_two_behind_it() -> None:
    """KSS: a changed point changes at most the two segments before it and the two behind it."""
    points = [(20.0 * k, 7.0 * (k % 3), 2.0 * k) for k in range(1, 9)]
    moved = [(x, y + 3.0 * (k == 4), z) for k, (x, y, z) in enumerate(points)]
    one, other = (runs_of(pose(0, 0, 0), [spl(*point) for point in each])[0] for each in (points, moved))
    changed = [k for k, (a, b) in enumerate(zip(one, other, strict=True)) if a.position != b.position]
    assert changed == [3, 4, 5, 6]


@pytest.mark.parametrize(
    ("legs", "runs"),
    [
        ([Leg("line", pose(50, 0, 0)), Leg("line", pose(50, 50, 0))], [1, 1]),  # a corner
        ([Leg("line", pose(50, 0, 0)), Leg("line", pose(90, 0, 0))], [2]),  # straight on
        ([Leg("line", pose(50, 0, 0)), Leg("line", pose(90, 0, 0, 30))], [1, 1]),  # straight on, but begins to turn
        ([Leg("line", pose(50, 0, 0, 50)), Leg("line", pose(90, 0, 0, 90))], [2]),  # turns on evenly
        ([Leg("line", pose(50, 0, 0)), Leg("arc", pose(50, 20, 0), Vector(60, 10, 0))], [1, 1]),  # tangential
        (
            [Leg("arc", pose(10, 10, 0), Vector(10 * math.sqrt(0.5), 10 - 10 * math.sqrt(0.5), 0)),
             Leg("arc", pose(-10, 10, 0), Vector(0, 20, 0))],
            [2],
        ),  # the same circle
        ([spl(50, 0, 0), spl(50, 0, 0, 40), spl(90, 0, 0, 40)], [1, 1, 1]),  # turning on the spot
        ([spl(50, 0, 0), Leg("line", pose(90, 0, 0)), spl(120, 20, 0)], [3]),
    ],
)  # fmt: skip
def test_where_the_robot_stops_inside_a_block(legs: list[Leg], runs: list[int]) -> None:
    """KSS: the velocity falls to zero between straight or circular segments that do not go on in the same way, also
    where a line is tangential to an arc, and where points have the same position."""
    assert [len(run) for run in runs_of(pose(0, 0, 0), legs)] == runs


def test_the_path_is_even_in_distance() -> None:
    path = path_of(pose(0, 0, 0), MIXED)
    places = path.poses(np.linspace(0.0, 1.0, 4001))[:, :3, 3]
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert steps == pytest.approx(np.full(4000, path.length_mm / 4000), rel=2e-4)
    assert steps.sum() == pytest.approx(path.length_mm, rel=1e-6)


def test_the_tangent_is_the_change_of_position() -> None:
    path = path_of(pose(0, 0, 0), MIXED)
    for place in np.linspace(0.01, 0.99, 25):
        before, behind = path.poses(np.array([place - 1e-6, place + 1e-6]))[:, :3, 3]
        assert path.tangent(place) == pytest.approx((behind - before) / 2e-6, rel=1e-3, abs=1e-2)


@pytest.mark.parametrize("swept", [None, 90.0, -90.0, 400.0])
def test_the_circle_is_that_of_circular_moves(swept: float | None) -> None:
    points = [(100, 0, 20), (60, 70, 40), (-50, 60, 10)]
    found = circle_through(*(Vector(*point) for point in points), swept)
    arc = arc_through(*(pose_matrix(point) for point in points), swept_deg=swept)
    assert found is not None and arc is not None
    assert (found.radius, found.sweep) == pytest.approx((arc.radius_mm, arc.sweep_rad))
    assert [*vars_of(found.centre), *vars_of(found.axis)] == pytest.approx([*arc.centre, *arc.axis])


def vars_of(vector: Vector) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z


# ---- moves


def at(x: float, y: float, z: float, turn: float = 0.0, **more: object) -> MoveRequest:
    """A point beside the start."""
    goal = pose_matrix(HERE[:3, 3] + [x, y, z], HERE[:3, :3] @ zyx_to_matrix([turn, 0, 0]))
    return MoveRequest("spline", target_pose=goal, path_acc_mm_s2=2000.0, reduce_speed_near_singularity=True, **more)  # type: ignore[arg-type]


def planned(requests: Sequence[MoveRequest], *kinds: Kind) -> list[Run]:
    found = plan_block(KR6, START, requests, kinds or ["spline"] * len(requests))
    assert isinstance(found, list), found
    return found


FLAT = "degenerate_circle"
WAVE = [at(20, 30, 10), at(0, 60, -10, 20), at(-20, 90, 0, 10), at(0, 130, 0)]


def test_a_block_is_one_move() -> None:
    (run,) = planned([MoveRequest(**{**_fields(one), "path_speed_mm_s": 100.0}) for one in WAVE])
    move = run.move
    assert run.marks[-1] == 1.0 and len(run.marks) == 4
    ends = move.geometry.tcp(np.array(run.marks))
    assert ends == pytest.approx(np.stack([one.target_pose for one in WAVE]), abs=1e-6)  # type: ignore[arg-type]
    assert np.linalg.norm(ends[0, :3, 3] - HERE[:3, 3] - [20, 30, 10]) < 1e-6
    samples = move.sample(2000)
    speeds = np.linalg.norm(np.diff(samples.tcp[:, :3, 3], axis=0), axis=1) / samples.times[1]
    assert speeds.max() == pytest.approx(100.0, rel=1e-3)
    assert speeds[200:1800].min() > 50.0  # it does not stop at the points
    assert rotation_angle(samples.tcp[-1, :3, :3].T @ HERE[:3, :3]) < 1e-6
    exact = move.geometry.joints(np.linspace(0, 1, 40))
    assert KR6.forward(exact) == pytest.approx(move.geometry.tcp(np.linspace(0, 1, 40)), abs=1e-5)


def _fields(request: MoveRequest) -> dict[str, object]:
    return {name: getattr(request, name) for name in request.__dataclass_fields__}


def test_each_segment_has_its_speed() -> None:
    speeds = (200.0, 50.0, 200.0)
    requests = [at(0, 60.0 * k + 60.0, 0, path_speed_mm_s=speed) for k, speed in enumerate(speeds)]
    (run,) = planned(requests)
    law = run.move.law
    times = np.linspace(0.0, law.duration, 2000)
    ways, rates = law.at(times) * run.move.length_mm, law.speed_at(times) * run.move.length_mm
    for number, speed in enumerate(speeds):
        inside = (ways > 60.0 * number) & (ways < 60.0 * number + 60.0)
        assert rates[inside].max() == pytest.approx(speed, rel=1e-3)


def test_a_tight_place_is_passed_slowly() -> None:
    (run,) = planned(
        [at(0, 60, 0, path_speed_mm_s=400.0), at(5, 70, 0, path_speed_mm_s=400.0), at(5, 10, 0, path_speed_mm_s=400.0)]
    )
    law, ways = run.move.law, run.move.length_mm
    bend = float(law.speed_at(law.time_of(run.marks[1]))) * ways
    straight = float(law.speed_at(law.time_of(0.5 * run.marks[0]))) * ways
    assert bend < 0.5 * straight


def test_constant_orientation_stays() -> None:
    (run,) = planned([at(10, 30, 0, 40, orientation="constant"), at(0, 60, 10, 20, orientation="constant")])
    turned = rotation_angle(np.swapaxes(run.move.geometry.tcp(np.linspace(0, 1, 30))[:, :3, :3], 1, 2) @ HERE[:3, :3])
    assert turned.max() < 1e-6


def test_a_joint_block_runs_smoothly_through_its_joints() -> None:
    goals = [START + np.array(step) for step in ([20, 5, 0, 0, 0, 0], [40, 0, 10, 10, 0, 0.0], [30, -5, 10, 30, 5, 0])]
    (run,) = planned([MoveRequest("joint", target_joints=goal) for goal in goals], "joint", "joint", "joint")
    geometry = run.move.geometry
    assert isinstance(geometry, JointSpline)
    assert geometry.joints(np.array(run.marks)) == pytest.approx(np.stack(goals), abs=1e-9)
    for mark in run.marks[:-1]:
        sides = [geometry.rates(np.array([mark + side * 1e-9]))[0] for side in (-1.0, 1.0)]
        assert sides[0] == pytest.approx(sides[1], rel=1e-5, abs=1e-5)
    samples = run.move.sample(3000)
    rates = np.abs(np.diff(samples.joints, axis=0)) / samples.times[1]
    assert (rates / KR6.speeds).max() < 1.01
    middle = rates[(samples.times[1:] > 0.1) & (samples.times[1:] < run.move.duration_s - 0.1)]
    assert middle.max(axis=1).min() > 5.0


@pytest.mark.parametrize(
    ("requests", "kinds", "segment", "kind"),
    [
        ([at(0, 30, 0), at(0, 5000, 0)], ("spline", "spline"), 1, "unreachable"),
        ([at(0, 30, 0), at(0, 60, 0, via_pose=at(0, 45, 0).target_pose)], ("spline", "circular"), 1, FLAT),
        ([at(0, 30, 0), at(0, 60, 0, path_speed_mm_s=0.0)], ("spline", "spline"), 1, "bad_speed"),
    ],
)  # fmt: skip
def test_why_a_block_is_refused(requests: list[MoveRequest], kinds: tuple[Kind, ...], segment: int, kind: str) -> None:
    found = plan_block(KR6, START, requests, kinds)
    assert isinstance(found, BlockFault) and isinstance(found.fault, MotionFault)
    assert (found.segment, found.fault.kind) == (segment, kind)


def test_the_mean_of_two_parabolas_goes_through_its_points_with_their_directions() -> None:
    """INFORM's composite (M: the mean, weighted evenly): between two inner points it is half of each parabola."""
    places = [(0.0, 0.0, 0.0), (30.0, 40.0, 0.0), (90.0, 30.0, 10.0), (120.0, 0.0, 0.0)]
    legs = [spl(*place) for place in places[1:]]
    found = block(pose(*places[0]), legs, mean=True)
    assert isinstance(found, list)
    (run,) = found
    spans = [float(np.linalg.norm(np.subtract(b, a))) for a, b in pairwise(places)]
    at = np.cumsum([0.0, *spans])
    parabolas = [np.polynomial.polynomial.polyfit(at[k : k + 3], np.array(places[k : k + 3]), 2) for k in (0, 1)]
    for u in (0.0, 0.25, 0.5, 0.9, 1.0):
        here = at[1] + u * spans[1]
        one, other = (np.polynomial.polynomial.polyval(here, rows) for rows in parabolas)
        place = run[1].at(u).position
        assert [place.x, place.y, place.z] == pytest.approx((1.0 - u) * one + u * other, abs=1e-9)
    for k, whole in ((0, parabolas[0]), (2, parabolas[1])):  # at both ends one of them is alone
        place = run[k].at(0.5).position
        middle = np.polynomial.polynomial.polyval(at[k] + 0.5 * spans[k], whole)
        assert [place.x, place.y, place.z] == pytest.approx(middle, abs=1e-9)
