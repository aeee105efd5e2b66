"""How far corners are missed, and that every controller's corners leave and meet their paths where they should, with a
speed that nowhere jumps."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl import registry
from rpl.controllerfiles import controller_named
from rpl.emulator.blending import Corner, Size, blend
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray
from rpl.motionmodel import PLAIN, MotionModel

ROBOT = load_robot("abb_irb6700_140_285")
RIGHT = math.sqrt(2.0)


def at(x: float, y: float, z: float = 800.0) -> FloatArray:
    return np.array([[-1, 0, 0, x], [0, 1, 0, y], [0, 0, -1, z], [0, 0, 0, 1.0]])


START = ROBOT.nearest(at(1300, -150), np.array([0, 0, 0, 0, 30, 0.0]))
assert START is not None


def two_lines(turn_deg: float, speed: float, controller: MotionModel) -> tuple[PlannedMove, PlannedMove]:
    """150 mm to the corner point and 150 mm away from it, turned by that angle."""
    angle = math.radians(turn_deg)
    joints, planned = START, []
    for pose in (at(1300, 0), at(1300 + 150 * math.sin(angle), 150 * math.cos(angle))):
        request = MoveRequest(
            "linear", target_pose=pose, path_speed_mm_s=speed, path_acc_mm_s2=5000.0, controller=controller
        )
        move = plan(ROBOT, joints, request)
        assert isinstance(move, PlannedMove), move
        planned.append(move)
        joints = move.end_joints
    return planned[0], planned[1]


# ---- the law of the cut


def test_without_a_filter_the_cut_is_its_share_of_the_size() -> None:
    assert PLAIN.cut(50.0, 500.0, RIGHT) * RIGHT == pytest.approx(RIGHT / 4.0)
    assert replace(PLAIN, corner_cut=0.3).cut(50.0, 500.0, 0.4) * RIGHT == pytest.approx(0.3)


def test_in_long_corners_the_filter_adds_its_width_squared_over_24_times_the_acceleration() -> None:
    filtered = replace(PLAIN, corner_cut=0.0, corner_filter_s=0.1)
    size, speed = 100.0, 400.0
    acceleration = speed * speed * RIGHT / (2.0 * size)
    assert filtered.cut(size, speed, RIGHT) * size * RIGHT == pytest.approx(0.1**2 / 24.0 * acceleration)


def test_in_corners_without_a_size_the_filter_draws_the_curve() -> None:
    """A jump of the direction behind a moving average is a parabola that begins half its width before the point."""
    filtered = replace(PLAIN, corner_cut=0.0, corner_filter_s=0.1)
    size = 1e-6
    assert filtered.cut(size, 200.0, RIGHT) * size * RIGHT == pytest.approx(RIGHT / 4.0 * 0.05 * 200.0, rel=1e-4)


@given(st.floats(1.0, 300.0), st.floats(1.0, 3000.0), st.floats(0.01, 2.0))
def test_the_cut_never_falls_with_speed_and_the_acceleration_bounds_it(size: float, speed: float, turn: float) -> None:
    rapid = controller_named("rapid")
    slow, fast = rapid.cut(size, speed, turn), rapid.cut(size, 1.1 * speed, turn)
    assert rapid.corner_cut / RIGHT <= slow + 1e-12
    assert slow <= fast + 1e-12
    most = rapid.corner_filter_s**2 / 24.0 * (rapid.corner_acceleration_mm_s2 or 0.0)
    assert (slow - rapid.corner_cut / RIGHT) * size * turn <= most + 1e-9


@pytest.mark.parametrize("speed", [100, 400, 1500])
@pytest.mark.parametrize("turn_deg", [30.0, 90.0, 140.0])
def test_the_driven_path_misses_the_point_by_the_law(speed: float, turn_deg: float) -> None:
    rapid = controller_named("rapid")
    first, second = two_lines(turn_deg, speed, rapid)
    made = blend(ROBOT, first, second, Size(40.0))
    assert isinstance(made, Corner)
    middle = made.corner.geometry.tcp(np.array([0.5]))[0, :3, 3]
    turn = 2.0 * math.sin(math.radians(turn_deg) / 2.0)
    assert np.linalg.norm(middle - [1300, 0, 800]) == pytest.approx(
        rapid.cut(40.0, speed, turn) * 40.0 * turn, rel=1e-6
    )
    even = made.corner.length_mm / made.corner.duration_s
    assert even <= rapid.corner_speed(40.0, turn) * 1.02


# ---- where it leaves and meets, and its speed


@settings(max_examples=40)
@given(st.sampled_from(registry.dialect_names()), st.floats(0.5, 149.0), st.floats(1.0, 150.0), st.floats(50.0, 1500.0))
def test_every_controller_leaves_and_meets_at_the_size_and_keeps_its_speed(
    name: str, size: float, turn_deg: float, speed: float
) -> None:
    controller = controller_named(name)
    first, second = two_lines(turn_deg, speed, controller)
    made = blend(ROBOT, first, second, Size(size), (True, True))
    assert isinstance(made, Corner), made
    capped = size if controller.corner_whole else min(size, 75.0)
    assert 150.0 - made.first.length_mm == pytest.approx(capped, abs=0.01)
    assert 150.0 - made.second.length_mm == pytest.approx(capped, abs=0.01)
    tiny = 1e-6
    for one, two in pairwise(part for part in (made.first, made.corner, made.second) if part.duration_s > 0.0):
        assert one.end_pose[:3, 3] == pytest.approx(two.start_pose[:3, 3], abs=0.01)
        leaving = (one.tcp_at(one.duration_s) - one.tcp_at(one.duration_s - tiny))[:3, 3] / tiny
        meeting = (two.tcp_at(tiny) - two.tcp_at(0.0))[:3, 3] / tiny
        assert leaving == pytest.approx(meeting, abs=0.5 + 0.01 * float(np.linalg.norm(leaving)))


@settings(max_examples=15)
@given(st.sampled_from([n for n in registry.dialect_names() if controller_named(n).overlap]), st.floats(5.0, 100.0),
       st.floats(10.0, 150.0), st.floats(50.0, 1500.0))  # fmt: skip
def test_overlapping_moves_keep_their_speed_too(name: str, percent: float, turn_deg: float, speed: float) -> None:
    controller = controller_named(name)
    first, second = two_lines(turn_deg, speed, controller)
    made = blend(ROBOT, first, second, Size(overlap=controller.overlap_at(percent)))
    assert isinstance(made, Corner), made
    assert made.first.length_mm == pytest.approx(made.second.length_mm, abs=0.01)
    assert made.first.length_mm >= 75.0 - 1e-6
    tiny = 1e-6
    for one, two in pairwise(part for part in (made.first, made.corner, made.second) if part.duration_s > 0.0):
        leaving = (one.tcp_at(one.duration_s) - one.tcp_at(one.duration_s - tiny))[:3, 3] / tiny
        meeting = (two.tcp_at(tiny) - two.tcp_at(0.0))[:3, 3] / tiny
        assert leaving == pytest.approx(meeting, abs=0.5 + 0.01 * float(np.linalg.norm(leaving)))
