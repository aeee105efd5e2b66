"""Default grasps: a gripper that goes to one of them takes the part there, as it lies."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.cell.defaultgrasps import default_grasps
from rpl.cell.grasping import Hold, grasp
from rpl.cell.layout import Gripper, Part
from rpl.cell.shapes import Box, Cylinder, Extrusion, moved
from rpl.cell.stable import stable_states
from rpl.emulator.rotations import pose_matrix, quaternion_to_matrix, rotation_z

JAWS = Gripper("jaws", "jaws", opening=(5.0, 70.0), reach_mm=1.0)
CUP = Gripper("cup", "suction", reach_mm=2.0)
PRISM = Extrusion(((0.0, 0.0), (60.0, 0.0), (60.0, 25.0), (20.0, 40.0), (0.0, 40.0)), 30.0)


@pytest.mark.parametrize("shape", [Box((60.0, 40.0, 20.0)), Cylinder(50.0, 30.0), PRISM])
@pytest.mark.parametrize("gripper", [JAWS, CUP])
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_the_gripper_holds_the_part_as_it_lay(shape, gripper, yaw):
    """At its default grasp it closes on the part without turning or shifting it: what grasping says independently."""
    part, states = Part("part", shape), stable_states(shape)
    found = default_grasps(part, gripper, states)
    assert found
    for one in found:
        state = states[one.state]
        lying = pose_matrix((100.0, 50.0, state.height_mm), rotation_z(yaw) @ quaternion_to_matrix(state.rotation))
        grip = lying @ one.grip
        assert grip[2, 2] == pytest.approx(-1.0, abs=1e-6)  # from above
        held = grasp(gripper, grip, [(part, lying)])
        assert isinstance(held, Hold)
        assert np.allclose(grip @ held.pose, lying, atol=0.3)
        assert held.width_mm == pytest.approx(one.width_mm, abs=0.3)
        before = moved((lying @ one.approach)[None, :3, 3], np.eye(4))[0]
        assert before[2] - grip[2, 3] >= 50.0


def test_states_whose_sides_the_jaws_cannot_span_are_left_out():
    """A box of 90 x 80 x 40: lying flat it is 80 wide, on its sides 40."""
    part, states = Part("part", Box((90.0, 80.0, 40.0))), stable_states(Box((90.0, 80.0, 40.0)))
    taken = {one.state for one in default_grasps(part, JAWS, states)}
    flat = {number for number, state in enumerate(states) if abs(state.normal[2]) > 0.5}
    assert taken == set(range(6)) - flat


def test_the_cell_file_has_the_last_word():
    text = '[[part]]\nname = "p"\nbox = [60, 40, 20]\ngrasps = [{ grip = [5, 0, 5, 0, 0, 180], approach = 80 }]\n'
    (part,) = parse_cell(text).layout.parts
    states = stable_states(part.shape)
    own = [one for one in default_grasps(part, JAWS, states) if one.own]
    assert [states[one.state].normal for one in own] == [(0.0, 0.0, -1.0)]
    assert own[0].grip[:3, 3] == pytest.approx([5.0, 0.0, 5.0])
    assert own[0].approach[:3, 3] == pytest.approx([5.0, 0.0, 85.0])
    assert own[0].depart[:3, 3] == pytest.approx([5.0, 0.0, 55.0])
