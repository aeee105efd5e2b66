"""Corners: where they leave and meet, how close they come, and that nothing jumps."""

from itertools import pairwise

import numpy as np
import pytest

from rpl.emulator.blending import Corner, NoBlend, Size, blend
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray, rotation_angle, zyx_to_matrix

ROBOT = load_robot("abb_irb6700_140_285")
START = ROBOT.nearest(
    np.array([[-1, 0, 0, 1100], [0, 1, 0, -200], [0, 0, -1, 800], [0, 0, 0, 1.0]]), np.array([0, 0, 0, 0, 30, 0.0])
)


def at(x: float, y: float, z: float, turn: FloatArray | None = None) -> FloatArray:
    pose = np.array([[-1, 0, 0, x], [0, 1, 0, y], [0, 0, -1, z], [0, 0, 0, 1.0]])
    if turn is not None:
        pose[:3, :3] = pose[:3, :3] @ turn
    return pose


def moves(*requests: MoveRequest) -> list[PlannedMove]:
    planned: list[PlannedMove] = []
    assert START is not None
    joints = START
    for request in requests:
        move = plan(ROBOT, joints, request)
        assert isinstance(move, PlannedMove), move
        planned.append(move)
        joints = move.end_joints
    return planned


def line(pose: FloatArray, speed: float = 1000.0, acceleration: float = 10000.0) -> MoveRequest:
    return MoveRequest("linear", target_pose=pose, path_speed_mm_s=speed, path_acc_mm_s2=acceleration)


def joined(first: PlannedMove, second: PlannedMove, **size: float) -> Corner:
    corner = blend(ROBOT, first, second, Size(**size))
    assert isinstance(corner, Corner), corner
    return corner


def right_angle(**size: float) -> Corner:
    return joined(*moves(line(at(1400, -200, 800)), line(at(1400, 200, 800))), **size)


def check_continuous(parts: list[PlannedMove]) -> None:
    """Joints, poses and their rates meet at every seam; what two corners leave of a move may be nothing."""
    for one, two in pairwise(part for part in parts if part.duration_s > 0.0):
        assert one.end_joints == pytest.approx(two.start_joints, abs=1e-4)
        assert one.end_pose == pytest.approx(two.start_pose, abs=1e-4)
        tiny = 1e-5
        leaving = (one.tcp_at(one.duration_s) - one.tcp_at(one.duration_s - tiny))[:3, 3] / tiny
        meeting = (two.tcp_at(tiny) - two.tcp_at(0.0))[:3, 3] / tiny
        assert leaving == pytest.approx(meeting, abs=1.0 + 0.01 * float(np.linalg.norm(leaving)))


@pytest.mark.parametrize("radius", [1.0, 10.0, 50.0, 100.0])
def test_leaves_and_meets_at_the_distance(radius: float) -> None:
    corner = right_angle(distance_mm=radius)
    assert corner.first.end_pose[:3, 3] == pytest.approx([1400 - radius, -200, 800], abs=1e-6)
    assert corner.second.start_pose[:3, 3] == pytest.approx([1400, -200 + radius, 800], abs=1e-6)
    assert corner.first.length_mm == pytest.approx(300 - radius)
    assert corner.second.length_mm == pytest.approx(400 - radius)
    check_continuous([corner.first, corner.corner, corner.second])


def test_misses_the_corner_point_as_a_parabola_does() -> None:
    corner = right_angle(distance_mm=100.0)
    path = corner.corner.sample(401).tcp[:, :3, 3]
    nearest = np.linalg.norm(path - [1400, -200, 800], axis=1).min()
    assert nearest == pytest.approx(100 * np.sqrt(2) / 4, abs=1e-3)
    middle = corner.corner.tcp_at(corner.t_middle_s)[:3, 3]
    assert np.linalg.norm(middle - [1400, -200, 800]) == pytest.approx(nearest, abs=1e-3)


def test_never_takes_more_than_half_of_the_shorter_move() -> None:
    corner = right_angle(distance_mm=1000.0)
    assert corner.first.end_pose[:3, 3] == pytest.approx([1250, -200, 800], abs=1e-6)
    assert corner.second.start_pose[:3, 3] == pytest.approx([1400, -50, 800], abs=1e-6)


def test_saves_time_and_keeps_path_speed_and_acceleration() -> None:
    stopped = sum(m.duration_s for m in moves(line(at(1400, -200, 800)), line(at(1400, 200, 800))))
    previous = stopped
    for radius in (5.0, 20.0, 50.0, 100.0):
        corner = right_angle(distance_mm=radius)
        parts = [corner.first, corner.corner, corner.second]
        total = sum(p.duration_s for p in parts)
        assert total < previous
        previous = total
        for part in parts:
            times = np.linspace(0, part.duration_s, 200)
            points = part.tcp_at(times)[:, :3, 3]
            speeds = np.linalg.norm(np.diff(points, axis=0), axis=1) / times[1]
            accelerations = np.linalg.norm(np.diff(points, n=2, axis=0), axis=1) / times[1] ** 2
            assert speeds.max() < 1000.0 * 1.001
            assert accelerations.max() < 10000.0 * 1.02


def test_orientation_turns_smoothly_through_the_corner() -> None:
    turned = at(1400, -200, 800, zyx_to_matrix([20, 10, 0]))
    corner = joined(*moves(line(turned), line(at(1400, 200, 800, zyx_to_matrix([20, 10, 30])))), distance_mm=60.0)
    samples = corner.corner.sample(100).tcp
    steps = rotation_angle(np.swapaxes(samples[:-1, :3, :3], 1, 2) @ samples[1:, :3, :3])
    assert steps.max() < 3 * steps.mean() + 1e-6
    check_continuous([corner.first, corner.corner, corner.second])


def test_chain_of_corners() -> None:
    stops = [at(1400, -200, 800), at(1400, 0, 800), at(1300, 0, 900), at(1300, 300, 900)]
    first, *others = moves(*(line(p) for p in stops))
    parts: list[PlannedMove] = []
    for following in others:
        corner = joined(first, following, distance_mm=80.0)
        parts += [corner.first, corner.corner]
        first = corner.second
    parts.append(first)
    check_continuous(parts)
    assert parts[-1].law.speeds[-1] == 0.0
    assert parts[0].law.speeds[0] == 0.0


def test_corner_after_an_arc_is_tangent() -> None:
    arc = MoveRequest("circular", target_pose=at(1100, 200, 800), via_pose=at(1300, 0, 800), path_speed_mm_s=500)
    corner = joined(*moves(arc, line(at(1100, 200, 1000), 500)), distance_mm=40.0)
    assert corner.first.length_mm == pytest.approx(np.pi * 200 - 40)
    check_continuous([corner.first, corner.corner, corner.second])


def test_joint_moves_by_fraction() -> None:
    assert START is not None
    a, b = START + [40, 0, 0, 0, 0, 0], START + [40, 20, 0, 0, 0, 60]  # noqa: RUF005
    corner = joined(*moves(MoveRequest("joint", target_joints=a), MoveRequest("joint", target_joints=b)), fraction=0.3)
    assert corner.first.end_joints == pytest.approx(START + 0.7 * (a - START))
    assert corner.second.start_joints == pytest.approx(a + 0.3 * (b - a))
    check_continuous([corner.first, corner.corner, corner.second])
    samples = corner.corner.sample(500)
    rates = np.diff(samples.joints, axis=0) / samples.times[1]
    assert (np.abs(rates) / ROBOT.speeds).max() < 1.001
    assert (np.abs(np.diff(rates, axis=0)) / samples.times[1] / ROBOT.accelerations).max() < 1.01


def test_joint_move_into_a_line() -> None:
    target = ROBOT.nearest(at(1400, -200, 800), np.array([0, 0, 0, 0, 30, 0.0]))
    corner = joined(*moves(MoveRequest("joint", target_joints=target), line(at(1400, 200, 800))), distance_mm=50.0)
    assert corner.corner.kind == "corner"
    assert corner.second.start_pose[:3, 3] == pytest.approx([1400, -150, 800], abs=1e-6)


def test_moves_that_cannot_be_joined() -> None:
    first, second = moves(line(at(1400, -200, 800)), line(at(1400, 200, 800)))
    assert isinstance(blend(ROBOT, second, first, Size(distance_mm=10.0)), NoBlend)
    assert isinstance(blend(ROBOT, first, second, Size(distance_mm=0.0)), NoBlend)
    assert isinstance(blend(ROBOT, first, second, Size(fraction=0.0)), NoBlend)
    turning = moves(line(at(1400, -200, 800)), line(at(1400, -200, 800, zyx_to_matrix([30, 0, 0]))))
    assert isinstance(blend(ROBOT, *turning, Size(distance_mm=10.0)), NoBlend)


def test_a_turn_on_the_spot_into_a_way_is_driven_with_a_stop() -> None:
    there = moves(line(at(1400, -200, 800)))[0]
    turn = plan(ROBOT, there.end_joints, line(at(1400, -200, 800, zyx_to_matrix([0, 10, 0]))))
    assert isinstance(turn, PlannedMove)
    way = plan(ROBOT, turn.end_joints, line(at(1400, -200, 820, zyx_to_matrix([0, 10, 0]))))
    assert isinstance(way, PlannedMove)
    assert isinstance(blend(ROBOT, turn, way, Size(fraction=0.045)), NoBlend)


def test_straight_on_is_not_slowed_down() -> None:
    corner = joined(*moves(line(at(1300, -200, 800), 500), line(at(1500, -200, 800), 500)), distance_mm=20.0)
    assert corner.corner.duration_s == pytest.approx(40 / 500, rel=1e-6)
