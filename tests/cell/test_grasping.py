"""What closing grippers hold: against brute force where there is one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl.cell.grasping import Hold, Miss, grasp, squeezed
from rpl.cell.layout import Gripper, Part
from rpl.cell.shapes import Box, Cylinder, Extrusion, Sphere, moved
from rpl.emulator.rotations import pose_matrix, rotation_x, rotation_z

DOWN = np.diag([1.0, -1.0, -1.0])
JAWS = Gripper("jaws", "jaws", opening=(5.0, 80.0), reach_mm=2.0)
CUP = Gripper("cup", "suction", reach_mm=10.0)


def lying(shape, x=0.0, y=0.0, yaw_deg=0.0):
    low = -shape.facets.bounds[0][2]
    return Part("part", shape), pose_matrix((x, y, low), rotation_z(math.radians(yaw_deg)))


@pytest.mark.parametrize("yaw", [0.0, 10.0, -25.0, 40.0])
def test_jaws_turn_a_box_flat_and_centre_it(yaw):
    found = grasp(JAWS, pose_matrix((0.0, 0.0, 20.0), DOWN), [lying(Box((60.0, 40.0, 30.0)), 3.0, 5.0, yaw)])
    assert isinstance(found, Hold)
    assert found.width_mm == pytest.approx(40.0, abs=1e-6)
    across = moved(found.part.shape.facets.vertices, found.pose)[:, 1]
    assert across.max() + across.min() == pytest.approx(0.0, abs=1e-9)


def test_jaws_do_not_turn_what_is_round():
    part, pose = lying(Cylinder(40.0, 30.0), 0.0, 3.0, 7.0)
    found = grasp(JAWS, pose_matrix((0.0, 0.0, 15.0), DOWN), [(part, pose)])
    assert isinstance(found, Hold)
    assert np.allclose(found.pose[:3, :3], DOWN @ pose[:3, :3])


@given(st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=5, max_size=12), st.floats(-3.0, 3.0))
def test_squeezing_ends_at_a_minimum_of_the_width(corners, start):
    """Brute force: from where squeezing ends, no small turn makes the part narrower, and no width on the way is wider
    than where it began."""
    points = np.array(corners) @ rotation_z(start)[:2, :2].T
    if np.linalg.matrix_rank(points - points.mean(axis=0), tol=1.0) < 2:
        return

    def width(turn):
        across = points[:, 0] * math.sin(turn) + points[:, 1] * math.cos(turn)
        return across.max() - across.min()

    turn = squeezed(points)
    assert width(turn) <= width(0.0) + 1e-9
    if turn:
        assert width(turn) <= min(width(turn - 1e-4), width(turn + 1e-4)) + 1e-9
        on_way = [width(turn * share) for share in np.linspace(0.0, 1.0, 50)]
        assert max(on_way) <= on_way[0] + 1e-9


@pytest.mark.parametrize(
    ("gripper", "at", "shape", "why"),
    [
        (JAWS, (300.0, 0.0, 20.0), Box((60.0, 40.0, 30.0)), "no part between the jaws"),
        (JAWS, (0.0, 0.0, 20.0), Box((60.0, 90.0, 30.0)), "90.0 mm wide between jaws that open 80 mm"),
        (JAWS, (0.0, 0.0, 20.0), Box((60.0, 3.0, 30.0)), "3.0 mm wide between jaws that close to 5 mm"),
        (CUP, (0.0, 0.0, 60.0), Box((60.0, 40.0, 30.0)), "no part under the cup"),
        (CUP, (18.0, 0.0, 32.0), Sphere(40.0), "the facet under the cup leans by 65 degrees"),
    ],
)
def test_grasps_that_miss_say_why(gripper, at, shape, why):
    found = grasp(gripper, pose_matrix(at, DOWN), [lying(shape)])
    assert isinstance(found, Miss)
    assert found.why == why


def test_a_cup_aligns_the_facet_under_it():
    """A roof of 10 degrees: the part turns by these 10 degrees about the point that the cup touches."""
    tilt = math.radians(10.0)
    wedge = Extrusion(((0.0, 0.0), (100.0, 0.0), (100.0, 50.0 + 100.0 * math.tan(tilt)), (0.0, 50.0)), 60.0)
    part, pose = Part("wedge", wedge), pose_matrix((0.0, 0.0, 0.0), rotation_x(math.pi / 2.0))
    grip = pose_matrix((0.0, 0.0, 30.0), DOWN)
    found = grasp(CUP, grip, [(part, pose)])
    assert isinstance(found, Hold)
    turned = found.pose[:3, :3].T @ (DOWN.T @ pose[:3, :3])
    assert math.acos((np.trace(turned) - 1.0) / 2.0) == pytest.approx(tilt, abs=1e-9)
    top = moved(wedge.facets.vertices, found.pose)[:, 2]
    assert top.min() == pytest.approx(0.0, abs=1e-9)


def test_of_several_the_nearest_is_taken():
    near, far = lying(Box((60.0, 40.0, 30.0)), 3.0), lying(Box((60.0, 40.0, 30.0)), 25.0)
    found = grasp(JAWS, pose_matrix((0.0, 0.0, 20.0), DOWN), [far, near])
    assert isinstance(found, Hold)
    assert found.part is near[0]
