"""Facts of the arms whose pendant counts joint 3 from the horizontal, for every such arm, by plain geometry."""

import numpy as np
import pytest

from rpl.emulator.model import RobotModel, load_robot, robot_names
from rpl.emulator.robotfile import read_robot_file
from rpl.emulator.rotations import FloatArray

NAMES = [name for name in robot_names() if read_robot_file(name).joint_3_follows_joint_2]


def drawn(model: RobotModel, count: int) -> FloatArray:
    return np.random.default_rng(3).uniform(model.limits[:, 0], model.limits[:, 1], (count, model.axes))


def test_all_arms_of_the_maker_are_there_and_no_others() -> None:
    assert len(NAMES) > 30
    assert [name for name in robot_names() if read_robot_file(name).maker == "FANUC"] == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_joint_3_is_the_angle_of_the_forearm_to_the_horizontal(name: str) -> None:
    model = load_robot(name)
    joints = drawn(model, 50)
    joints[:, 0] = 0.0
    forearm = model.arm.axes(model.theta(joints))[1][:, 3]
    # With joint 1 at zero the forearm lies in the plane of x and z, at this angle whatever joint 2 is.
    angle = np.rad2deg(np.arctan2(forearm[:, 2], forearm[:, 0]))
    assert np.abs((angle - joints[:, 2] + 180.0) % 360.0 - 180.0).max() < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_up_and_down_are_the_sides_of_the_line_through_axes_2_and_3(name: str) -> None:
    model = load_robot(name)
    for joints in drawn(model, 200):
        points = model.arm.axes(model.theta(joints))[0]
        shoulder, elbow, wrist = points[1], points[2], points[3]
        heading = np.array([np.cos(np.deg2rad(joints[0])), np.sin(np.deg2rad(joints[0])), 0.0])
        # Seen with the arm's front to the right: is the wrist centre to the right of the line from axis 2 to axis 3?
        upper, fore = elbow - shoulder, wrist - shoulder
        side = upper[2] * (fore @ heading) - (upper @ heading) * fore[2]
        assert model.posture(joints).elbow_above_stretched == (side >= 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_front_and_back_are_the_sides_of_axis_1(name: str) -> None:
    model = load_robot(name)
    for joints in drawn(model, 200):
        wrist = model.arm.axes(model.theta(joints))[0][3]
        ahead = wrist[0] * np.cos(np.deg2rad(joints[0])) + wrist[1] * np.sin(np.deg2rad(joints[0]))
        assert model.posture(joints).behind_axis1 == (ahead < 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_zero_puts_the_flange_forward_at_the_height_of_the_forearm(name: str) -> None:
    model, lengths = load_robot(name), read_robot_file(name).lengths
    pose = model.forward(np.zeros(6))
    reach = lengths["a1"] + lengths["c3"] + lengths["c4"]
    assert pose[:3, 3] == pytest.approx([reach, 0.0, lengths["c2"] - lengths["a2"]])
    assert pose[:3, :3] == pytest.approx(np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]), abs=1e-12)
