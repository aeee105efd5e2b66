"""Kinematics of every packaged arm: against itself and against published pairs."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rpl.emulator.arms import BRANCHES, OpwArm
from rpl.emulator.model import RobotError, RobotModel, load_robot, robot_names, robot_summaries
from rpl.emulator.robotfile import read_robot_file
from rpl.emulator.rotations import FloatArray, matrix_to_quaternion, matrix_to_xyz_fixed, matrix_to_zyx

pytestmark = pytest.mark.filterwarnings("error")


def postures(model: RobotModel, count: int, seed: int = 7) -> FloatArray:
    return np.random.default_rng(seed).uniform(model.limits[:, 0], model.limits[:, 1], (count, model.axes))


@pytest.mark.parametrize("name", robot_names())
def test_inverse_finds_the_posture_and_every_solution_reaches_the_pose(name: str) -> None:
    model = load_robot(name)
    joints = postures(model, 150)
    flanges = model.forward(joints)
    found = model.inverse_batch(flanges)
    assert found.joints.shape == (150, len(model.arm.branches), model.axes)
    reached = model.forward(np.nan_to_num(found.joints))
    assert np.abs(reached - flanges[:, None])[found.valid].max() < 1e-7
    off = np.abs(found.joints - model.canonical(joints)[:, None])
    off = np.where(model.revolute, np.minimum(off, 360.0 - off), off).max(axis=2)
    assert np.nanmin(np.where(found.valid, off, np.inf), axis=1).max() < 1e-6
    for row, valid in zip(found.joints, found.valid, strict=True):
        assert all(model.posture(q).branch == b for q, b, ok in zip(row, model.arm.branches, valid, strict=True) if ok)


@pytest.mark.parametrize("name", robot_names())
def test_file_is_complete(name: str) -> None:
    model = load_robot(name)
    assert model.name == name
    assert model.within_limits(model.home) == []
    assert (model.speeds > 0).all()
    given = any("accelerations" in note for note in read_robot_file(name).notes)
    assert given or model.accelerations == pytest.approx(model.speeds / 0.3)
    assert (model.accelerations > 0).all()
    assert given or any("model" in note for note in model.notes)


def test_summaries() -> None:
    kr6 = next(s for s in robot_summaries() if s.name == "kuka_kr6r900sixx")
    assert (kr6.maker, kr6.title, kr6.axes, kr6.kind) == ("KUKA", "KR 6 R900 sixx", 6, "opw")
    assert len(robot_summaries()) == len(robot_names()) >= 60


def test_unknown_names_are_answered_with_close_ones() -> None:
    with pytest.raises(RobotError, match="kuka_kr6r900sixx"):
        load_robot("kr6r900")
    with pytest.raises(RobotError, match="ur5e"):
        load_robot("ur5x")


def test_published_pairs_of_the_makers() -> None:
    abb = load_robot("abb_irb120_3_58").forward(np.zeros(6))
    assert abb[:3, 3] == pytest.approx([374, 0, 630])
    assert matrix_to_quaternion(abb) == pytest.approx([0.70710678, 0, 0.70710678, 0])
    kuka = load_robot("kuka_kr6r900sixx").forward([0, -90, 90, 0, 0, 0])
    assert kuka[:3, 3] == pytest.approx([525, 0, 890])
    assert matrix_to_zyx(kuka) == pytest.approx([0, 90, 0])
    ur = load_robot("ur5e").forward(np.zeros(6))
    assert ur[:3, 3] == pytest.approx([-817.2, -232.9, 62.8])


@pytest.mark.parametrize(
    ("joints", "flipped"),
    [
        ((7.962, -5.284, -36.25, 77.661, -51.975, -79.273), False),
        ((7.962, -5.284, -36.25, -102.339, 51.975, 100.727), True),
    ],
)
def test_published_pair_of_a_coupled_arm(joints: tuple[float, ...], flipped: bool) -> None:
    """R-2000iB/165F with 270 mm from the wrist centre, published with its flags (onerobotics.com)."""
    model = load_robot("fanuc_r2000ic165f")
    assert isinstance(model.arm, OpwArm)
    model = replace(model, arm=replace(model.arm, c4=270.0))
    pose = model.forward(joints)
    assert pose[:3, 3] == pytest.approx([1500.01, 0, 360], abs=0.006)
    assert matrix_to_xyz_fixed(pose) == pytest.approx([135, -45, 0], abs=0.001)
    posture = model.posture(joints)
    assert not posture.behind_axis1
    assert posture.elbow_above_stretched
    assert posture.wrist_negative == flipped
    assert any(s.joints == pytest.approx(joints, abs=1e-3) for s in model.inverse(pose, joints))


def test_straight_wrist_keeps_joint_4_of_the_reference() -> None:
    model = load_robot("kuka_kr6r900sixx")
    flange = model.forward([10, -80, 85, 0, 0, 40])
    for solution in model.inverse(flange, [0, -90, 90, 25, 0, 0]):
        assert model.forward(solution.joints) == pytest.approx(flange, abs=1e-9)
        if solution.branch.shoulder == 0 and solution.branch.elbow == 0:
            assert solution.singular
            assert solution.joints[4] == 0.0
    plus = model.inverse(flange, [0, -90, 90, 25, 0, 0])[0]
    assert plus.joints == pytest.approx([10, -80, 85, 25, 0, 15])


@pytest.mark.parametrize("size", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_close_to_the_straight_wrist_the_pose_is_still_exact(size: float) -> None:
    model = load_robot("abb_irb120_3_58")
    flange = model.forward([10, 20, -30, 40, size, 50])
    for solution in model.inverse(flange, [0, 0, 0, 5, 0, 0]):
        assert np.abs(model.forward(solution.joints) - flange).max() < 1e-6


def test_wrist_over_the_base_keeps_joint_1_of_the_reference() -> None:
    model = load_robot("abb_irb120_3_58")
    assert isinstance(model.arm, OpwArm)
    # Upper arm upright, forearm folded back so that the wrist centre lies on axis 1: height only.
    lean = np.rad2deg(np.arctan2(model.arm.a2, model.arm.c3))
    flange = model.forward([33, 0, -90 - lean, 0, 60, 0])
    assert flange[:2, 3] - model.arm.c4 * flange[:2, 2] == pytest.approx([0, 0], abs=1e-9)
    for reference in (0.0, 33.0, -120.0):
        solutions = model.inverse(flange, [reference, 0, 0, 0, 0, 0])
        assert solutions
        assert all(s.singular for s in solutions)
        assert {float(np.round((s.joints[0] - reference) % 180, 6)) for s in solutions} == {0.0}
        assert all(np.abs(model.forward(s.joints) - flange).max() < 1e-6 for s in solutions)


def test_stretched_arm_is_clamped() -> None:
    model = load_robot("abb_irb120_3_58")
    assert isinstance(model.arm, OpwArm)
    lean = np.rad2deg(np.arctan2(model.arm.a2, model.arm.c3))
    flange = model.forward([20, 40, -90 - lean, 10, 50, 30])
    flange[:3, 3] *= 1.0 + 1e-12
    front = [s for s in model.inverse(flange) if s.branch.shoulder == 0]
    assert len(front) == 4
    assert all(s.singular and np.abs(model.forward(s.joints) - flange).max() < 1e-6 for s in front)
    flange[:3, 3] += 0.01 * flange[:3, 3] / np.linalg.norm(flange[:3, 3])
    assert [s for s in model.inverse(flange) if s.branch.shoulder == 0] == []


def test_branches_have_stable_names() -> None:
    assert [b.name for b in BRANCHES[:3]] == ["front-forward-plus", "front-forward-minus", "front-backward-plus"]
    assert [b.index for b in BRANCHES] == list(range(8))


def test_turns() -> None:
    model = load_robot("kuka_kr6r900sixx")
    joints = np.array([0, -185, 90, 180, 20, -300.0])
    assert model.canonical(joints).tolist() == [0, 175, 90, 180, 20, 60]
    assert model.turns(joints).tolist() == [0, -1, 0, 0, 0, -1]
    wanted = {(0, -185, 90, a4, 20, a6) for a4 in (180, -180) for a6 in (60, -300)}
    assert {tuple(row) for row in model.expand_turns(joints)} == wanted


def test_nearest_stays_inside_the_limits() -> None:
    model = load_robot("kuka_kr6r900sixx")
    near = np.array([0, -90, 90, 0, 60, 340.0])
    found = model.nearest(model.forward([0, -90, 90, 0, 60, 20]), near)
    assert found == pytest.approx([0, -90, 90, 0, 60, 20])
    assert model.nearest(model.forward([0, -90, 90, 0, 60, -20]), near) == pytest.approx([0, -90, 90, 0, 60, 340])
    assert model.within_limits([171, 0, 0, 0, 0, np.nan]) == [0, 5]


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "fanuc_m20ia", "ur10e", "adept_cobra_s600", "puma560"])
def test_jacobian_is_the_derivative_of_the_flange(name: str) -> None:
    model = load_robot(name)
    for joints in postures(model, 10):
        exact = model.jacobian(joints)
        for axis in range(model.axes):
            step = np.zeros(model.axes)
            step[axis] = 1e-4
            change = model.forward(joints + step) - model.forward(joints - step)
            rate = change / (2e-4 * model.unit[axis])
            turning = rate[:3, :3] @ model.forward(joints)[:3, :3].T
            assert exact[:3, axis] == pytest.approx(rate[:3, 3], abs=1e-4)
            assert exact[3:, axis] == pytest.approx([turning[2, 1], turning[0, 2], turning[1, 0]], abs=1e-6)


def test_tilted_tools_are_out_of_reach_of_a_scara() -> None:
    model = load_robot("adept_cobra_s600")
    flange = model.forward(model.home)
    flange[:3, :3] = flange[:3, :3] @ np.array([[1, 0, 0], [0, 0.99995, -0.01], [0, 0.01, 0.99995]])
    assert model.inverse(flange) == ()


def test_wrong_shapes_are_refused() -> None:
    with pytest.raises(ValueError, match="6 joints"):
        load_robot("ur5").forward([0, 0, 0])


def test_loading_a_closed_form_arm_needs_no_pinocchio() -> None:
    code = (
        "import sys; from rpl.emulator.model import load_robot; m = load_robot('ur5e');"
        "m.inverse(m.forward(m.home)); sys.exit('pinocchio' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_every_robot_is_in_the_documentation() -> None:
    page = (Path(__file__).parents[2] / "docs" / "robots.md").read_text(encoding="utf-8")
    for name in robot_names():
        file = read_robot_file(name)
        row = f"| `{name}` | {file.maker} | {file.title} | {len(file.home)} | {file.kind} | "
        assert row + (", ".join(file.assumed) or "-") in page


# Makers of arms whose pulses per degree are published.
COUNTING = {load_robot(name).maker for name in robot_names() if load_robot(name).pulses_per_degree is not None}


@pytest.mark.parametrize("name", robot_names())
def test_a_scale_of_pulses_is_never_guessed_for_an_arm_whose_controller_counts(name: str) -> None:
    model = load_robot(name)
    if model.maker in COUNTING:
        assert model.counts_pulses and model.pulse_scale is model.pulses_per_degree
    elif not model.counts_pulses:
        assert model.pulse_scale is not None and set(model.pulse_scale) == {10000.0}
