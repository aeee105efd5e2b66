"""Single moves: shape, timing, continuity, and the reasons why a move is refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.configuration import Selection
from rpl.emulator.model import RobotModel, load_robot
from rpl.emulator.paths import arc_through
from rpl.emulator.planner import MotionFault, MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_angle, zyx_to_matrix
from rpl.emulator.timelaw import limited, travel

KR6 = load_robot("kuka_kr6r900sixx")
START = np.array([0, -90, 90, 0, 60, 0.0])


def offset(*joints: float) -> FloatArray:
    return START + np.array(joints)


TOOL = pose_matrix([10, -20, 120], zyx_to_matrix([10, 20, 30]))


def moved(pose: FloatArray, x: float = 0, y: float = 0, z: float = 0) -> FloatArray:
    goal = pose.copy()
    goal[:3, 3] += [x, y, z]
    return goal


def planned(request: MoveRequest, start: FloatArray = START, model: RobotModel = KR6) -> PlannedMove:
    move = plan(model, start, request)
    assert isinstance(move, PlannedMove), move
    return move


def refused(request: MoveRequest, start: FloatArray = START, model: RobotModel = KR6) -> MotionFault:
    fault = plan(model, start, request)
    assert isinstance(fault, MotionFault), fault
    return fault


def test_joint_move_starts_and_stops_all_axes_together() -> None:
    end = np.array([60, -60, 100, 40, 30, -90.0])
    move = planned(MoveRequest("joint", target_joints=end, joint_speed=0.5, joint_acc=0.5))
    samples = move.sample(400)
    share = (samples.joints - START) / (end - START)
    assert share == pytest.approx(np.repeat(share[:, :1], 6, axis=1), abs=1e-9)
    rates = np.abs(np.diff(samples.joints, axis=0)).max(axis=0) / (move.duration_s / 399)
    assert (rates / KR6.speeds).max() == pytest.approx(0.5, rel=1e-6)
    # leading axis: A1 by 60 degrees at 180 deg/s with 600 deg/s2 -> 60/180 + 180/600
    assert move.duration_s == pytest.approx(60 / 180 + 180 / 600)


def test_short_joint_move_is_a_triangle() -> None:
    move = planned(MoveRequest("joint", target_joints=offset(10, 0, 0, 0, 0, 0)))
    assert move.duration_s == pytest.approx(2 * np.sqrt(10 / 1200))


def test_joint_move_at_a_tool_speed() -> None:
    request = MoveRequest("joint", target_joints=offset(40, 0, 0, 0, 0, 0), tcp_speed_for_joint_move=100.0)
    move = planned(request)
    radius = np.linalg.norm(KR6.forward(START)[:2, 3])
    assert move.length_mm == pytest.approx(np.deg2rad(40) * radius, rel=1e-3)
    assert move.duration_s >= move.length_mm / 100.0


@pytest.mark.parametrize("kind", ["joint", "linear"])
def test_programmed_duration(kind: str) -> None:
    goal = moved(KR6.forward(START), 50, 50, -50)
    request = MoveRequest("joint" if kind == "joint" else "linear", target_pose=goal, duration_s=7.5)
    assert planned(request).duration_s == pytest.approx(7.5)
    assert planned(replace(request, duration_s=0.001)).duration_s > 0.05


def test_line_is_straight_and_exact_in_between() -> None:
    first = KR6.forward(START) @ TOOL
    goal = moved(first, 80, -150, -120)
    goal[:3, :3] = first[:3, :3] @ zyx_to_matrix([20, -10, 15])
    move = planned(MoveRequest("linear", target_pose=goal, tool=TOOL, path_speed_mm_s=300))
    samples = move.sample(101)
    assert KR6.forward(samples.joints) @ TOOL == pytest.approx(samples.tcp, abs=1e-7)
    direction = (goal - first)[:3, 3] / np.linalg.norm((goal - first)[:3, 3])
    off = samples.tcp[:, :3, 3] - first[:3, 3]
    assert np.linalg.norm(off - (off @ direction)[:, None] * direction, axis=1).max() < 1e-9
    assert move.end_pose == pytest.approx(goal, abs=1e-9)
    assert move.length_mm == pytest.approx(np.linalg.norm(goal[:3, 3] - first[:3, 3]))
    speeds = np.linalg.norm(np.diff(samples.tcp[:, :3, 3], axis=0), axis=1) / (move.duration_s / 100)
    assert speeds.max() == pytest.approx(300, rel=1e-6)


def test_slowest_of_translation_and_rotation_governs() -> None:
    first = KR6.forward(START)
    goal = moved(first, 1)
    goal[:3, :3] = first[:3, :3] @ zyx_to_matrix([60, 0, 0])
    move = planned(MoveRequest("linear", target_pose=goal, ori_speed_deg_s=30, ori_acc_deg_s2=60))
    assert move.duration_s == pytest.approx(60 / 30 + 30 / 60)


def test_constant_orientation() -> None:
    goal = moved(KR6.forward(START), 50)
    goal[:3, :3] = np.eye(3)
    move = planned(MoveRequest("linear", target_pose=goal, orientation="constant"))
    assert rotation_angle(move.start_pose[:3, :3].T @ move.end_pose[:3, :3]) < 1e-9


def test_distances_and_times() -> None:
    move = planned(MoveRequest("linear", target_pose=moved(KR6.forward(START), 0, 0, -200)))
    for mm in (0.0, 3.0, 50.0, 200.0):
        at = move.tcp_at(move.time_at_distance_from_start(mm))[2, 3]
        assert move.start_pose[2, 3] - at == pytest.approx(mm, abs=1e-9)
        back = move.tcp_at(move.time_at_distance_from_end(mm))[2, 3]
        assert back - move.end_pose[2, 3] == pytest.approx(mm, abs=1e-9)


def test_a_move_to_where_the_arm_is_takes_no_time() -> None:
    for kind in ("joint", "linear"):
        request = MoveRequest("joint" if kind == "joint" else "linear", target_pose=KR6.forward(START))
        move = planned(request)
        assert move.duration_s == pytest.approx(0.0, abs=1e-4)
        assert move.end_joints == pytest.approx(START, abs=1e-9)


def test_external_axes_move_along_and_govern_when_slowest() -> None:
    request = MoveRequest(
        "linear",
        target_pose=moved(KR6.forward(START), 10),
        external_start=(0.0,),
        external_target=(1000.0,),
        external_speeds=(500.0,),
    )
    move = planned(request)
    assert move.duration_s > 2.0
    assert move.external_at(move.duration_s) == pytest.approx([1000.0])
    assert move.external_at(move.duration_s / 2) == pytest.approx([500.0])


def test_circle_through_three_points() -> None:
    first = KR6.forward(START)
    via, goal = moved(first, 0, 100, -100), moved(first, 0, 0, -200)
    move = planned(MoveRequest("circular", target_pose=goal, via_pose=via))
    assert move.length_mm == pytest.approx(np.pi * 100)
    centre = first[:3, 3] - [0, 0, 100]
    samples = move.sample(100)
    assert np.linalg.norm(samples.tcp[:, :3, 3] - centre, axis=1) == pytest.approx(np.full(100, 100.0))
    assert move.tcp_at(move.duration_s / 2)[:3, 3] == pytest.approx(via[:3, 3], abs=1e-6)
    assert KR6.forward(samples.joints) == pytest.approx(samples.tcp, abs=1e-7)


@pytest.mark.parametrize(
    ("swept", "expected"), [(90.0, (0, 100, -100)), (-90.0, (0, -100, -100)), (450.0, (0, 100, -100))]
)
def test_swept_angle_replaces_the_end(swept: float, expected: tuple[float, ...]) -> None:
    first = KR6.forward(START)
    via, goal = moved(first, 0, 100, -100), moved(first, 0, 0, -200)
    move = planned(MoveRequest("circular", target_pose=goal, via_pose=via, swept_deg=swept))
    assert move.end_pose[:3, 3] - first[:3, 3] == pytest.approx(expected, abs=1e-6)
    assert move.length_mm == pytest.approx(np.deg2rad(abs(swept)) * 100)


def test_orientation_turns_with_the_circle() -> None:
    first = KR6.forward(START)
    arc = arc_through(
        first, moved(first, 0, 50, -50), moved(first, 0, 0, -100), constant_orientation=True, follow_path=True
    )
    assert arc is not None
    start, quarter = arc.poses(np.array([0.0, 0.5]))
    assert rotation_angle(start[:3, :3].T @ quarter[:3, :3]) == pytest.approx(np.pi / 2)
    assert arc.turn_rad == pytest.approx(np.pi)


def test_points_on_a_line_make_no_circle() -> None:
    first = KR6.forward(START)
    request = MoveRequest("circular", target_pose=moved(first, 0, 0, -100), via_pose=moved(first, 0, 0, -50))
    assert refused(request).kind == "degenerate_circle"
    assert refused(replace(request, via_pose=first)).kind == "degenerate_circle"


def test_out_of_reach() -> None:
    first = KR6.forward(START)
    assert refused(MoveRequest("joint", target_pose=moved(first, 2000))).kind == "unreachable"
    fault = refused(MoveRequest("linear", target_pose=moved(first, 2000)))
    assert fault.kind == "unreachable"
    assert fault.fraction is not None
    assert 0.1 < fault.fraction < 0.3


def test_joint_limits() -> None:
    fault = refused(MoveRequest("joint", target_joints=offset(0, 0, 0, 0, 100, 0)))
    assert (fault.kind, fault.axis) == ("joint_limit", 4)
    turned = KR6.forward(offset(0, 0, 0, 0, 0, 80))
    fault = refused(MoveRequest("linear", target_pose=turned), offset(0, 0, 0, 0, 0, 300))
    assert (fault.kind, fault.axis) == ("joint_limit", 5)


def test_configuration_is_chosen_and_checked_by_the_caller() -> None:
    goal = moved(KR6.forward(START), 10)
    fault = refused(
        MoveRequest("joint", target_pose=goal, select=lambda _f, _r: Selection(None, "S 1 cannot be reached"))
    )
    assert (fault.kind, fault.message) == ("configuration", "S 1 cannot be reached")
    fault = refused(MoveRequest("linear", target_pose=goal, check_end=lambda _: "another quarter turn"))
    assert (fault.kind, fault.message) == ("configuration", "another quarter turn")


def test_speeds_must_be_positive() -> None:
    goal = moved(KR6.forward(START), 10)
    for bad in (0.0, -1.0, float("nan")):
        assert refused(MoveRequest("linear", target_pose=goal, path_speed_mm_s=bad)).kind == "bad_speed"
        assert refused(MoveRequest("joint", target_pose=goal, joint_speed=bad)).kind == "bad_speed"


NEAR_SINGULAR = np.array([5, -90, 90, 3, -20, 0.0])
BEYOND = KR6.forward([-20, -80, 90, 2, 25.0, 0])


def test_singularity_is_a_fault() -> None:
    fault = refused(MoveRequest("linear", target_pose=BEYOND), NEAR_SINGULAR)
    assert (fault.kind, fault.axis) == ("singularity", 3)


def test_singularity_is_passed_slowly_when_asked() -> None:
    move = planned(MoveRequest("linear", target_pose=BEYOND, reduce_speed_near_singularity=True), NEAR_SINGULAR)
    assert move.slowed
    samples = move.sample(4000)
    rates = np.abs(np.diff(samples.joints, axis=0)) / (move.duration_s / 3999)
    assert (rates / KR6.speeds).max() == pytest.approx(1.0, abs=0.02)
    assert move.end_joints == pytest.approx([-20, -80, 90, -178, -25, 180], abs=1e-6)


def test_singularity_is_avoided_by_even_wrist_joints() -> None:
    move = planned(MoveRequest("linear", target_pose=BEYOND, orientation="wrist_joints"), NEAR_SINGULAR)
    samples = move.sample(50)
    assert samples.joints[:, 3] == pytest.approx(3 + (samples.joints[:, 4] + 20) / 45 * -1, abs=1e-6)
    way = samples.tcp[:, :3, 3] - move.start_pose[:3, 3]
    direction = BEYOND[:3, 3] - move.start_pose[:3, 3]
    assert np.linalg.norm(np.cross(way, direction), axis=1).max() / np.linalg.norm(direction) < 1e-6


def test_exactly_through_the_straight_wrist_with_joint_4_at_rest() -> None:
    move = planned(
        MoveRequest("linear", target_pose=KR6.forward([0, -95, 95, 0, -10, 0])), np.array([0, -90, 90, 0, 10, 0.0])
    )
    assert move.end_joints == pytest.approx([0, -95, 95, 0, -10, 0], abs=1e-6)


def test_an_axis_too_slow_for_the_path() -> None:
    request = MoveRequest(
        "linear", target_pose=moved(KR6.forward(START), 0, 300), path_speed_mm_s=9000, path_acc_mm_s2=1e6
    )
    assert refused(request).kind == "axis_speed"
    assert planned(replace(request, reduce_speed_near_singularity=True)).slowed


@given(seed=st.integers(0, 2**31))
@settings(max_examples=60, deadline=None)
def test_any_line_that_is_planned_is_continuous_and_exact(seed: int) -> None:
    rng = np.random.default_rng(seed)
    model = load_robot(("fanuc_m20ia", "ur5e", "abb_irb120_3_58", "staubli_tx60")[seed % 4])
    start = model.home + rng.uniform(-30, 30, 6)
    goal = model.forward(start + rng.uniform(-25, 25, 6)) @ TOOL
    move = plan(model, start, MoveRequest("linear", target_pose=goal, tool=TOOL, reduce_speed_near_singularity=True))
    if isinstance(move, MotionFault):
        assert move.kind in ("unreachable", "joint_limit", "singularity")
        return
    samples = move.sample(60)
    assert model.forward(samples.joints) @ TOOL == pytest.approx(samples.tcp, abs=1e-6)
    rates = np.abs(np.diff(samples.joints, axis=0)) / (move.duration_s / 59)
    assert (rates / model.speeds).max() < 1.05
    assert not any(model.within_limits(q) for q in samples.joints)


@given(speed=st.floats(0.01, 100), acceleration=st.floats(0.01, 1000))
def test_trapezoid(speed: float, acceleration: float) -> None:
    law = travel(speed, acceleration)
    times = np.linspace(0, law.duration, 50)
    fractions = law.at(times)
    assert fractions[0] == 0.0
    assert fractions[-1] == 1.0
    assert np.diff(fractions).min() >= -1e-12
    assert law.time_of(fractions[1:-1]) == pytest.approx(times[1:-1], rel=1e-6, abs=1e-9)
    assert law.speeds.max() <= speed * (1 + 1e-12)


def test_speed_ceiling_is_kept_in_its_interval() -> None:
    fractions = np.linspace(0, 1, 11)
    ceilings = np.full(10, 2.0)
    ceilings[4] = 0.1
    law = limited(fractions, ceilings, 20.0)
    times = np.linspace(0, law.duration, 2000)
    where, speed = law.at(times), law.speed_at(times)
    inside = (where > 0.4 + 1e-9) & (where < 0.5 - 1e-9)
    assert speed[inside].max() <= 0.1 + 1e-9
    assert speed.max() > 1.0
    assert np.abs(np.diff(speed)).max() / (times[1] - times[0]) <= 20.0 + 1e-6


@pytest.mark.parametrize("noise_deg", [-1e-6, 0.0, 1e-6])
@pytest.mark.parametrize("side", [20.0, -20.0])
def test_a_half_circle_along_the_path_does_not_turn_the_tool_round(side: float, noise_deg: float) -> None:
    down = zyx_to_matrix([0.0, 180.0, 0.0])
    arc = arc_through(
        pose_matrix([500.0, -10.0, 240.0], down),
        pose_matrix([500.0 + side, -30.0, 240.0], down),
        pose_matrix([500.0, -50.0, 240.0], zyx_to_matrix([noise_deg, 180.0, 0.0])),
        follow_path=True,
    )
    assert arc is not None
    turned = [float(rotation_angle(pose[:3, :3] @ down.T)) for pose in arc.poses(np.linspace(0.0, 1.0, 9))]
    assert max(turned) < 1e-6
    assert arc.turn_rad < 1e-6  # so that no limit of turning slows it down


@given(speed=st.floats(0.01, 100), acceleration=st.floats(0.01, 1000), share=st.floats(-1.0, 2.0))
def test_one_time_is_looked_up_as_many_are(speed: float, acceleration: float, share: float) -> None:
    law = travel(speed, acceleration)
    for time_s in (share * law.duration, *law.times.tolist()):
        assert law.fraction_at(time_s) == float(law.at(time_s))
