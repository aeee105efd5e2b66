"""What always holds of arm configurations: for every arm and notation the flags lead back to the joints.

Where a notation cannot tell joints apart, that is said here by name: the turns of axes that it does not write, the side
of axes next to zero, and the three singular postures.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from rpl import registry
from rpl.emulator.arms import OpwArm
from rpl.emulator.configuration import BatchNotation
from rpl.emulator.model import RobotModel, load_robot, robot_names
from rpl.emulator.rotations import rotation_angle

NOTATIONS = [name for name in registry.dialect_names() if registry.dialect(name).notation is not None]
# Axes whose revolution the notation writes. The others take the one nearest to where the arm is.
TOLD = {"krl": (0, 1, 2, 3, 4, 5), "rapid": (0, 3, 5), "tp": (0, 3, 5), "rpl": (0, 3, 5), "inform": (0, 3, 5)}
# These write the side of an axis (or whether it is beyond half a turn), not the revolution: one turn is told, not two.
ONE_TURN = ("krl", "inform")
WITHOUT_BRANCH = ("urscript",)


def batch(dialect: str) -> BatchNotation:
    make = registry.dialect(dialect).notation
    assert make is not None
    found = make()
    assert isinstance(found, BatchNotation)
    return found


def drawn(model: RobotModel, count: int, seed: int) -> np.ndarray:
    """Joints inside the limits, none within 2 degrees of whole turns (KRL), none at a singular posture."""
    rng = np.random.default_rng(seed)
    joints = rng.uniform(model.limits[:, 0], model.limits[:, 1], (4 * count, model.axes))
    aside = np.abs(np.remainder(joints[:, model.revolute] + 180.0, 360.0) - 180.0)
    joints = joints[(aside > 2.001).all(axis=1)]
    turning = np.remainder(model.theta(joints)[:, 4] + np.pi / 2, np.pi) - np.pi / 2 if model.axes > 4 else 1.0
    return joints[np.broadcast_to(np.abs(turning) > 0.01, len(joints))][:count]


@pytest.mark.parametrize("dialect", NOTATIONS)
@pytest.mark.parametrize("robot", robot_names())
def test_the_flags_lead_back_to_the_joints(robot: str, dialect: str) -> None:
    model, notation = load_robot(robot), batch(dialect)
    joints = drawn(model, 60, seed=sum(map(ord, robot)))
    assert len(joints) > 20
    flanges, flags = model.forward(joints), notation.encode_all(model, joints).astype(float)
    assert notation.select_all(model, flanges, flags, joints).joints == pytest.approx(joints, abs=1e-6)
    found = notation.select_all(model, flanges, flags, model.home).joints
    assert model.forward(found) == pytest.approx(flanges, abs=1e-6)
    if dialect in WITHOUT_BRANCH:
        return
    assert notation.encode_all(model, found).astype(float) == pytest.approx(flags)
    if dialect not in TOLD:
        return
    turns = np.where(model.revolute, np.round((found - joints) / 360.0), 0.0)
    rest = (found - joints) - 360.0 * turns
    # M: an arm whose wrist turns further than half a turn has two ways to a flag that is the sign of axis 5.
    wide = model.axes > 4 and float(np.abs(model.limits[4]).max()) > 180.0
    same = (np.abs(rest) < 1e-6).all(axis=1)
    assert same.all() or wide
    for axis in range(model.axes):
        if axis in TOLD[dialect] and not (dialect in ONE_TURN and np.abs(model.limits[axis]).max() > 360.0):
            assert not turns[same, axis].any()


ARMS = [("krl", "kuka_kr6r900sixx"), ("rapid", "abb_irb6700_140_285"), ("tp", "fanuc_r2000ic165f")]
ARMS += [("inform", "motoman_gp7"), ("rpl", "staubli_tx60")]


@pytest.mark.parametrize(("dialect", "robot"), ARMS)
@given(parts=st.tuples(*[st.floats(0.0, 1.0)] * 6), steps=st.integers(0, 6))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
def test_wherever_the_arm_comes_from(dialect: str, robot: str, parts: tuple[float, ...], steps: int) -> None:
    model, notation = load_robot(robot), batch(dialect)
    low, high = model.limits[:, 0], model.limits[:, 1]
    joints = low + np.array(parts) * (high - low)
    assume(
        (np.abs(joints) > 2.001).all() and (np.abs(joints) < 357.9).all() and abs(np.sin(np.radians(joints[4]))) > 0.02
    )
    arm = model.arm
    assert isinstance(arm, OpwArm)
    theta = model.theta(joints)
    assume(abs(np.sin(theta[2] + arm.elbow_angle)) > 1e-3 and abs(arm.in_plane(theta)[0]) > 1.0)
    near = low + (high - low) * steps / 6.0
    flags = notation.encode_all(model, joints[None]).astype(float)
    found = notation.select_all(model, model.forward(joints)[None], flags, near).joints[0]
    assert found == pytest.approx(joints, abs=1e-5)


@pytest.mark.parametrize("dialect", NOTATIONS)
@pytest.mark.parametrize("printed", [0.0, 4e-4, -4e-4])
def test_a_straight_wrist(dialect: str, printed: float) -> None:
    """Axis 4 stays (KRL: goes to zero), also where the printed digits have bent the wrist a little."""
    model, notation = load_robot("fanuc_r2000ic165f"), batch(dialect)
    near = np.array([0.0, 0.0, 0.0, 25.0, -9.0, 0.0])
    flange = model.forward([10.0, 5.0, -10.0, 30.0, printed, 10.0])
    flags = np.full((1, len(notation.fields)), np.nan)
    found = notation.select_all(model, flange[None], flags, near).joints[0]
    fourth = 0.0 if dialect == "krl" else 25.0
    assert found[3:5] == pytest.approx([fourth, 0.0], abs=1e-6)
    assert found[5] == pytest.approx(40.0 - fourth, abs=0.002)
    assert np.degrees(rotation_angle(model.forward(found)[:3, :3].T @ flange[:3, :3])) < 2e-3


@pytest.mark.parametrize("printed", [0.0, 4e-4])
@pytest.mark.parametrize("dialect", [name for name in NOTATIONS if name != "urscript"])
def test_the_wrist_over_axis_1(dialect: str, printed: float) -> None:
    """Axis 1 stays where it is (KRL: goes to zero), whichever side the flags name."""
    model, notation = load_robot("abb_irb140"), batch(dialect)
    arm = model.arm
    assert isinstance(arm, OpwArm)
    # Axis 2 leans back until the wrist centre stands over axis 1, with the forearm straight up.
    lean = -float(np.degrees(np.arcsin(arm.a1 / arm.c2)))
    over = np.array([33.0, lean, -90.0 - lean, 20.0, 40.0, 50.0])
    assert abs(arm.in_plane(model.theta(over))[0]) < 1e-9
    flange = model.forward(over)
    flange[:2, 3] -= (flange[:3, 3] - arm.c4 * flange[:3, 2])[:2]  # exactly over it, whatever rounding says
    flange[0, 3] += printed
    near = np.array([-20.0, 0.0, 0.0, 5.0, 30.0, 5.0])
    flags = np.full((1, len(notation.fields)), np.nan)
    found = notation.select_all(model, flange[None], flags, near).joints[0]
    assert found[0] == pytest.approx(0.0 if dialect == "krl" else -20.0, abs=1e-6)
    assert model.forward(found) == pytest.approx(flange, abs=1e-6 + printed)


@pytest.mark.parametrize("dialect", NOTATIONS)
def test_the_stretched_elbow(dialect: str) -> None:
    """Both sides of the elbow are the same joints: either flag is met."""
    model, notation = load_robot("kuka_kr6r900sixx"), batch(dialect)
    stretched = -float(np.degrees(np.arctan2(-35.0, 420.0)))
    joints = np.array([10.0, -60.0, stretched, 20.0, 40.0, 50.0])
    near = np.array([0.0, -90.0, 90.0, 0.0, 30.0, 0.0])
    flange = model.forward(joints)
    for bent in (-0.5, 0.5):
        flags = notation.encode_all(model, (joints + np.eye(6)[2] * bent)[None]).astype(float)
        found = notation.select_all(model, flange[None], flags, near).joints[0]
        assert found == pytest.approx(joints, abs=1e-4)


@pytest.mark.parametrize(("robot", "elbow"), [("kuka_kr6r900sixx", 4.7636417), ("ur5e", 0.0), ("fanuc_m20ia", None)])
@pytest.mark.parametrize("places", [3, 6])
def test_the_end_of_the_reach_in_printed_digits(robot: str, elbow: float | None, places: int) -> None:
    """Rounding may put the pose beyond the reach: it is reached all the same, within that rounding."""
    model = load_robot(robot)
    arm = model.arm
    for first in range(-60, 61, 10):
        joints = np.array([first, 13.0, elbow or 0.0, 20.0, 40.0, 50.0])
        if elbow is None:  # the pendant's joint 3 is the angle to the horizontal
            assert isinstance(arm, OpwArm)
            wanted = np.array([0.0, 0.0, -arm.elbow_angle, 0.0, 0.0, 0.0])
            joints[2] = np.degrees(wanted[2] / model.pendant_to_arm[2, 2]) - 90.0 - joints[1]
            joints[2] += (np.degrees(-arm.elbow_angle - model.theta(joints)[2])) / model.pendant_to_arm[2, 2]
        flange = np.round(model.forward(joints), places + 3)
        flange[:3, 3] = np.round(flange[:3, 3], places)
        found = batch("rpl").select_all(model, flange[None], np.full((1, 6), np.nan), joints).joints[0]
        assert model.forward(found) == pytest.approx(flange, abs=0.003)


@pytest.mark.parametrize(
    ("dialect", "angle"),
    [
        ("krl", 400.0),
        ("krl", -400.0),
        ("rapid", 400.0),
        ("rapid", -730.0),
        ("tp", 400.0),
        ("tp", -900.0),
        ("rpl", 800.0),
    ],
)
def test_axes_of_many_turns(dialect: str, angle: float) -> None:
    """KRL says only the side: of two turns on it the nearer one is taken. The others count them."""
    model = load_robot("kuka_kr6r900sixx")
    limits = model.limits.copy()
    limits[5] = [-1000.0, 1000.0]
    model, notation = replace(model, limits=limits), batch(dialect)
    joints = np.array([10.0, -80.0, 70.0, 20.0, 40.0, angle])
    flags = notation.encode_all(model, joints[None]).astype(float)
    flange = model.forward(joints)[None]
    assert notation.select_all(model, flange, flags, joints).joints[0] == pytest.approx(joints, abs=1e-6)
    from_home = notation.select_all(model, flange, flags, model.home).joints[0]
    nearest = angle - 360.0 * np.sign(angle) if dialect == "krl" else angle
    assert from_home[5] == pytest.approx(nearest, abs=1e-6)


@pytest.mark.parametrize(
    ("dialect", "robot"),
    [("tp", "fanuc_r2000ic165f"), ("inform", "motoman_gp7"), ("rpl", "puma560"), ("rapid", "abb_irb140")],
)
@pytest.mark.parametrize("sixth", [180.0, -180.0])
def test_half_a_turn_in_printed_digits(dialect: str, robot: str, sixth: float) -> None:
    """Rounding of the pose must not carry axis 6 to the other side of half a turn."""
    model, notation = load_robot(robot), batch(dialect)
    for first in np.linspace(-50.0, 50.0, 21):
        joints = np.array([first, 10.3, -20.7, 31.1, -50.9, sixth])
        flange = np.round(model.forward(joints), 6)
        flange[:3, 3] = np.round(flange[:3, 3], 3)
        flags = notation.encode_all(model, joints[None]).astype(float)
        found = notation.select_all(model, flange[None], flags, None).joints[0]
        assert found == pytest.approx(joints, abs=0.003)


@pytest.mark.parametrize("first", range(-60, 61, 7))
def test_the_end_of_the_reach_of_a_scara_in_printed_digits(first: int) -> None:
    model = load_robot("adept_cobra_s600")
    joints = np.array([first, 0.0, 50.0, 20.0])
    flange = model.forward(joints)
    flange[:3, 3] = np.round(flange[:3, 3], 3)
    found = batch("vplus").select_all(model, flange[None], np.full((1, 3), np.nan), joints).joints[0]
    assert model.forward(found) == pytest.approx(flange, abs=0.002)


def test_a_point_that_was_never_taught() -> None:
    model, notation = load_robot("kuka_kr125_3"), batch("krl")
    poses = notation.poses_of(np.array([[666666.688, 0.0, 0.0, 0.0, 0.0, 0.0], [1500.0, 0, 1200, 0, 90, 0]]))
    found = notation.select_all(model, poses, np.array([[0.0, 0.0], [2.0, 2.0]]), None).joints
    assert np.isnan(found[0]).all()
    assert not np.isnan(found[1]).any()
