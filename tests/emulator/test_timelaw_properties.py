"""What holds for every time law and every corner, whatever the controller."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from rpl import registry
from rpl.controllerfiles import controller_named
from rpl.emulator.blending import Corner, Size, blend
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import pose_matrix
from rpl.emulator.timelaw import Profile, mean_acceleration, of_constant_time, travel
from rpl.motionmodel import MotionModel

SPEEDS = st.floats(0.05, 20.0)
ACCELERATIONS = st.floats(0.05, 200.0)
SMOOTHINGS = st.sampled_from([0.0, 0.02, 0.112, 0.3])
SHARES = st.floats(0.0, 1.0)
CONTROLLERS = ["plain", *registry.dialect_names()]
ROBOT = load_robot("abb_irb6700_140_285")
DOWN = np.diag([1.0, -1.0, -1.0])


@given(SPEEDS, ACCELERATIONS, SMOOTHINGS)
def test_a_law_rises_from_0_to_1_within_its_profile(speed: float, acceleration: float, smoothing: float) -> None:
    law = Profile(speed, acceleration, smoothing_s=smoothing).law()
    times = np.linspace(0.0, law.duration, 1001)
    places, step = law.at(times), float(times[1])
    assert places[0] == pytest.approx(0.0, abs=1e-9) and places[-1] == 1.0
    assert np.diff(places).min() > -1e-9
    speeds = law.speed_at(times)
    assert speeds[[0, -1]] == pytest.approx(0.0, abs=1e-6 * speed)
    assert speeds.max() <= speed * (1.0 + 1e-9)
    assert np.abs(np.diff(speeds)).max() / step <= acceleration * (1.0 + 1e-6) + 1e-9 * speed / step
    assert np.diff(places) / step == pytest.approx(0.5 * (speeds[1:] + speeds[:-1]), abs=acceleration * step)


@given(SPEEDS, ACCELERATIONS, SMOOTHINGS, SHARES)
def test_the_time_of_a_place_is_the_inverse(speed: float, acceleration: float, smoothing: float, share: float) -> None:
    law = Profile(speed, acceleration, smoothing_s=smoothing).law()
    assert float(law.at(law.time_of(share))) == pytest.approx(share, abs=1e-8)
    assert law.fraction_at(share * law.duration) == pytest.approx(float(law.at(share * law.duration)), abs=1e-12)


@given(SPEEDS, ACCELERATIONS, SMOOTHINGS)
def test_a_move_lasts_its_way_its_ramp_and_its_smoothing(speed: float, acceleration: float, smoothing: float) -> None:
    assume(speed * speed <= acceleration)
    law = Profile(speed, acceleration, smoothing_s=smoothing).law()
    assert law.duration == pytest.approx(1.0 / speed + speed / acceleration + smoothing, rel=1e-9)


@given(SPEEDS, st.floats(0.02, 2.0))
def test_a_constant_ramp_adds_itself_to_any_move(speed: float, ramp: float) -> None:
    assert travel(speed, of_constant_time(speed, ramp)).duration == pytest.approx(1.0 / speed + ramp, rel=1e-9)


@given(SPEEDS, ACCELERATIONS, SMOOTHINGS, SHARES, SHARES)
def test_boundary_speeds_are_exact(speed: float, acceleration: float, smoothing: float, a: float, b: float) -> None:
    profile = Profile(speed, acceleration, smoothing_s=smoothing)
    most = min(speed, float(np.sqrt(acceleration)))
    law = profile.law(0.0, 1.0, a * most, b * most)
    ends = law.speed_at(np.array([0.0, law.duration]))
    assert ends == pytest.approx([a * most, b * most], abs=1e-6 * most)
    speeds = law.speed_at(np.linspace(0.0, law.duration, 401))
    assert speeds.max() <= speed * (1.0 + 1e-6)


@given(SPEEDS, ACCELERATIONS, ACCELERATIONS, SHARES, SHARES)
def test_slowing_down_may_differ_from_speeding_up(speed: float, up: float, down: float, a: float, b: float) -> None:
    most = min(speed, float(np.sqrt(min(up, down))))
    law = travel(speed, up, a * most, b * most, down)
    times = np.linspace(0.0, law.duration, 2001)
    steps = np.diff(law.speed_at(times)) / times[1]
    assert law.fractions[-1] == pytest.approx(1.0, abs=1e-9)
    assert np.diff(law.fractions) == pytest.approx(0.5 * (law.speeds[1:] + law.speeds[:-1]) * np.diff(law.times))
    assert -down * (1.0 + 1e-6) - 1e-6 <= steps.min() and steps.max() <= up * (1.0 + 1e-6) + 1e-6


def line(start: np.ndarray, goal: tuple[float, float, float], speed: float, controller: MotionModel) -> PlannedMove:
    request = MoveRequest(
        "linear",
        target_pose=pose_matrix(np.array(goal), DOWN),
        path_speed_mm_s=speed,
        path_acc_mm_s2=controller.path_acceleration_mm_s2 or 5000.0,
        ori_speed_deg_s=1000.0,
        ori_acc_deg_s2=10000.0,
        controller=controller,
    )
    made = plan(ROBOT, start, request)
    assert isinstance(made, PlannedMove), made
    return made


def cornered(
    name: str, speed: float, second: tuple[float, float, float], size: dict[str, float]
) -> tuple[PlannedMove, PlannedMove, Corner]:
    controller = controller_named(name)
    begin = ROBOT.nearest(pose_matrix(np.array([1300.0, -200.0, 900.0]), DOWN), ROBOT.home)
    assert begin is not None
    first = line(begin, (1600.0, -200.0, 900.0), speed, controller)
    after = line(first.end_joints, second, speed, controller)
    made = blend(ROBOT, first, after, Size(**size))  # type: ignore[arg-type]  # distance or overlap
    assert isinstance(made, Corner), made
    return first, after, made


SECONDS = st.sampled_from(
    [(1600.0, 200.0, 900.0), (1600.0, -200.0, 1250.0), (1850.0, 50.0, 900.0), (1400.0, 100.0, 900.0)]
)


@settings(max_examples=12, deadline=None)
@given(st.sampled_from(CONTROLLERS), st.sampled_from([50.0, 250.0, 1000.0]), SECONDS, st.floats(2.0, 120.0))
def test_a_corner_begins_and_ends_at_its_distance(
    name: str, speed: float, second: tuple[float, float, float], size: float
) -> None:
    _, _, made = cornered(name, speed, second, {"distance_mm": size})
    point = np.array([1600.0, -200.0, 900.0])
    assert np.linalg.norm(made.corner.start_pose[:3, 3] - point) == pytest.approx(size, abs=0.01)
    assert np.linalg.norm(made.corner.end_pose[:3, 3] - point) == pytest.approx(size, abs=0.01)


@settings(max_examples=20, deadline=None)
@given(
    st.sampled_from(CONTROLLERS),
    st.sampled_from([50.0, 250.0, 1000.0]),
    SECONDS,
    st.one_of(
        st.builds(lambda size: {"distance_mm": size}, st.floats(2.0, 120.0)),
        st.builds(lambda share: {"overlap": share}, st.floats(0.1, 1.0)),
    ),
)
def test_tool_and_joints_keep_their_speed_where_pieces_meet(
    name: str, speed: float, second: tuple[float, float, float], size: dict[str, float]
) -> None:
    """Speeds over half a millisecond on both sides differ by what the acceleration gives, here at most 20 m/s2."""
    _, _, made = cornered(name, speed, second, size)
    step = 5e-4
    for before, after in ((made.first, made.corner), (made.corner, made.second)):
        if min(before.duration_s, after.duration_s) < 2.0 * step:
            continue
        ends = before.duration_s - np.array([step, 0.0])
        for ask in ("tcp_at", "joints_at"):
            left, right = getattr(before, ask)(ends), getattr(after, ask)(np.array([0.0, step]))
            if ask == "tcp_at":
                left, right = left[:, :3, 3], right[:, :3, 3]
            jump = np.linalg.norm((right[1] - right[0]) - (left[1] - left[0])) / step
            assert jump < (60.0 if ask == "tcp_at" else 6.0), (ask, jump)
            assert np.abs(left[1] - right[0]).max() < 1e-5


@given(SPEEDS, ACCELERATIONS, st.floats(0.1, 10.0), SMOOTHINGS)
def test_two_ramps_last_as_long_as_their_mean(speed: float, up: float, ratio: float, smoothing: float) -> None:
    """A move from rest to rest with different ramps, also where it is too short for its speed."""
    both = Profile(speed, up, smoothing_s=smoothing, deceleration=up * ratio)
    mean = Profile(speed, mean_acceleration(up, up * ratio), smoothing_s=smoothing)
    assert both.law().duration == pytest.approx(mean.law().duration, rel=1e-9)
    assert both.peak == pytest.approx(mean.peak, rel=1e-9)
    times = np.linspace(0.0, both.law().duration, 1001)
    speeds = both.law().speed_at(times)
    steps = np.diff(speeds) / times[1]
    assert steps.max() <= up * (1.0 + 1e-6) + 1e-6 * speed / times[1]
    assert -steps.min() <= up * ratio * (1.0 + 1e-6) + 1e-6 * speed / times[1]


@given(SPEEDS, ACCELERATIONS, SMOOTHINGS, st.floats(0.0, 1.0))
def test_a_smoother_stop_takes_longer_and_ends_there(speed: float, up: float, smoothing: float, wider: float) -> None:
    plain = Profile(speed, up, smoothing_s=smoothing).law()
    smooth = Profile(speed, up, smoothing_s=smoothing, stopping_s=wider).law()
    assert smooth.duration >= plain.duration * (1.0 - 1e-9)
    assert float(smooth.at(smooth.duration)) == 1.0
    if speed * speed * (1.0 / up + 0.5 * wider / speed) <= 1.0:  # room for both ramps
        assert smooth.duration == pytest.approx(plain.duration + 0.5 * wider, rel=1e-6)
