"""Where parts come to rest that are let go."""

import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.cell.falling import GRAVITY_MM_S2, Laws, below, fall, obstacle_of, obstacles_of, states_of
from rpl.cell.layout import Body, Fixture, Part
from rpl.cell.layoutfile import LayoutReader
from rpl.cell.shapes import Box, Cylinder, Extrusion, bounds_at
from rpl.emulator.rotations import pose_matrix

TABLE = Fixture("table", (Body(Box((400.0, 400.0, 40.0)), pose_matrix((0.0, 0.0, -20.0))),), restitution=0.5)
FLOOR = Fixture("floor", (Body(Box((4000.0, 4000.0, 40.0)), pose_matrix((0.0, 0.0, -1020.0))),), restitution=0.5)
BLOCK = Part("block", Box((60.0, 40.0, 20.0)), restitution=0.5)


def obstacles(*fixtures):
    return [one for fixture in fixtures for one in obstacles_of(fixture)]


def bin_of(x, y, z):
    return LayoutReader("cell.toml", {}).layout({"bin": [{"name": "bin", "inside": [x, y, z]}]}).fixtures[0]


def let_go(part, at, around, laws=Laws(), seed=1):  # noqa: B008 (frozen)
    return fall(part, pose_matrix(at), around, laws, random.Random(seed))


@pytest.mark.parametrize("z", [8.0, 10.0, 10.9])
def test_a_part_that_is_set_down_stays_as_it_is(z):
    (stop,) = let_go(BLOCK, (0.0, 0.0, z), obstacles(TABLE))
    assert stop.after_s == 0.0
    assert stop.on == "table"
    assert np.allclose(stop.pose, pose_matrix((0.0, 0.0, 10.0)))


def test_times_are_those_of_a_fall_and_of_bounces_with_both_restitutions():
    """h = g t^2 / 2; a bounce keeps (e1 e2)^2 of the height, here 1/16, and lasts up and down."""
    first, second, *_ = let_go(BLOCK, (0.0, 0.0, 410.0), obstacles(TABLE))
    size = first.pose[2, 3] - 10.0  # lying on another face its middle is higher
    height = 400.0
    down = math.sqrt(2.0 * height / GRAVITY_MM_S2)
    assert first.after_s == pytest.approx(down, rel=1e-6)
    assert second.after_s - first.after_s == pytest.approx(2.0 * math.sqrt(2.0 * (height / 16.0) / GRAVITY_MM_S2))
    assert size >= 0.0


def test_what_scatters_over_the_edge_falls_on_to_the_floor():
    ends = {let_go(BLOCK, (190.0, 0.0, 300.0), obstacles(TABLE, FLOOR), Laws(1.0), seed)[-1].on for seed in range(20)}
    assert ends == {"table", "floor"}


def test_what_has_nothing_below_is_lost():
    (stop,) = let_go(BLOCK, (500.0, 0.0, 100.0), obstacles(TABLE))
    assert stop.on == ""
    assert stop.pose[2, 3] < -4000.0


@given(st.integers(0, 10_000), st.floats(-60.0, 60.0), st.floats(-60.0, 60.0))
@settings(max_examples=40, deadline=None)
def test_nothing_leaves_a_bin_and_nothing_lies_in_another_part(seed, x, y):
    holder = bin_of(240.0, 200.0, 400.0)
    chance, around, boxes = random.Random(seed), obstacles(holder), []
    for number in range(6):
        part = Part(f"block{number}", BLOCK.shape, restitution=0.6)
        stop = fall(part, pose_matrix((x, y, 350.0)), around, Laws(0.5, 0.3), chance)[-1]
        box = bounds_at(part.shape, stop.pose)
        assert (box[0, :2] >= [-120.001, -100.001]).all()
        assert (box[1, :2] <= [120.001, 100.001]).all()
        assert box[0, 2] >= -1e-6
        assert below(part.shape, stop.pose, around).gap_mm == pytest.approx(0.0, abs=1e-6)
        for other in boxes:
            turned = np.minimum(box[1], other[1]) - np.maximum(box[0], other[0])
            assert turned[2] <= 3.0 or (turned[:2] <= box[1, 2] - box[0, 2] + 60.0).any()
        boxes.append(box)
        around.append(obstacle_of(part, stop.pose))


def test_faces_come_as_often_as_the_stable_states_say():
    """500 drops from far enough, each face within four standard deviations of a count."""
    around, chance = obstacles(FLOOR), random.Random(3)
    states = states_of(BLOCK.shape)
    counts = [0] * len(states)
    for _ in range(500):
        pose = fall(BLOCK, pose_matrix((0.0, 0.0, -800.0)), around, Laws(), chance)[-1].pose
        counts[int(np.argmax([state.rotation[2] @ pose[2, :3] for state in states]))] += 1
    for state, count in zip(states, counts, strict=True):
        p = state.probability
        assert abs(count - 500 * p) <= 4.0 * math.sqrt(500 * p * (1.0 - p)) + 1.0


def test_a_small_drop_mostly_keeps_the_face():
    around = obstacles(TABLE)
    kept = sum(
        fall(BLOCK, pose_matrix((0.0, 0.0, 13.0)), around, Laws(), random.Random(seed))[-1].pose[2, 2] > 0.99
        for seed in range(100)
    )
    assert kept >= 90  # 3 mm are a twentieth of the longest side


@pytest.mark.parametrize(
    ("shape", "gap"),
    [
        (Box((60.0, 40.0, 20.0)), 40.0),
        (Cylinder(40.0, 20.0), 40.0),
        (Extrusion(((0.0, 0.0), (40.0, 0.0), (20.0, 30.0)), 20.0), 40.0),
    ],
)
def test_heights_are_of_the_lowest_face(shape, gap):
    assert below(shape, pose_matrix((0.0, 0.0, 50.0)), obstacles(TABLE)).gap_mm == pytest.approx(gap)


def test_a_peg_below_the_middle_of_a_face_carries_it():
    """No corner of the part is over the peg: the corners of the peg are looked at too."""
    peg = Fixture("peg", (Body(Box((4.0, 4.0, 60.0)), pose_matrix((7.0, 3.0, 30.0))),))
    found = below(Box((60.0, 40.0, 20.0)), pose_matrix((0.0, 0.0, 100.0)), obstacles(TABLE, peg))
    assert (found.obstacle.name, found.gap_mm) == ("peg", pytest.approx(30.0))
