"""Margins are what they are called: zero where the arm is singular or at its limit, and nowhere else."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.margins import conditioning, limit_margins, manipulability, singular_factors
from rpl.emulator.model import load_robot

ARMS = ["kuka_kr6r900sixx", "fanuc_m10ia", "staubli_tx60", "puma560", "ur5e", "ur10"]


@pytest.mark.parametrize("name", ARMS)
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_determinant_is_the_product_of_the_factors(name: str, seed: int) -> None:
    """By one constant for each arm: the product of its lengths and of those that the shoulder is measured by."""
    model = load_robot(name)
    joints = np.random.default_rng(seed).uniform(-179.0, 179.0, (2, model.axes))
    determinants = np.abs(np.linalg.det(model.jacobian(joints)))
    products = np.prod(list(singular_factors(model, joints).values()), axis=0)
    assert determinants[0] * products[1] == pytest.approx(determinants[1] * products[0], rel=1e-6, abs=1.0)


SINGULAR = [
    ("kuka_kr6r900sixx", [0, -60, 80, 30, 0, 0], "wrist"),
    # The forearm is stretched where its offset of 35 mm over 420 mm is turned away: atan(35 / 420) = 4.764 deg.
    ("kuka_kr6r900sixx", [10, -40, np.rad2deg(np.arctan2(-35.0, 420.0)) + 4.7636416907 * 2, 10, 40, 0], "elbow"),
    ("ur5e", [10, -80, 0, -40, 60, 0], "elbow"),
    ("ur5e", [10, -80, 70, -40, 0, 0], "wrist"),
    ("adept_cobra_s600", [10, 0, 50, 0], "elbow"),
]


@pytest.mark.parametrize(("name", "joints", "factor"), SINGULAR)
def test_singular_postures(name: str, joints: list[float], factor: str) -> None:
    model = load_robot(name)
    posture = np.array([joints], dtype=float)
    found = singular_factors(model, posture)
    assert found[factor][0] == pytest.approx(0.0, abs=1e-9)
    assert conditioning(model, posture)[0] < 1e-8
    assert manipulability(model, posture)[0] < 1e-8
    away = posture + np.array([[0.0, *[7.0] * (model.axes - 1)]])
    assert singular_factors(model, away)[factor][0] > 0.05
    assert conditioning(model, away)[0] > 1e-4


def test_the_shoulder_is_singular_with_the_wrist_centre_over_axis_1() -> None:
    model = load_robot("puma560")
    flange = np.eye(4)
    flange[:3, :3] = np.diag([1.0, -1.0, -1.0])
    # The arm lies beside axis 1 by its shoulder offset, so that is where the wrist centre is then.
    flange[:3, 3] = [0.0, 150.05, 1100.0]
    solution = model.inverse(flange, model.home)[0]
    assert singular_factors(model, solution.joints[None])["shoulder"][0] == pytest.approx(0.0, abs=1e-9)


def test_limit_margins_are_shares_of_the_half_range() -> None:
    model = load_robot("kuka_kr6r900sixx")
    low, high = model.limits.T
    middle = 0.5 * (low + high)
    rows = np.stack([low, middle, high, high + 0.1 * (high - middle), 0.5 * (low + middle)])
    expected = np.array([0.0, 1.0, 0.0, -0.1, 0.5])[:, None] * np.ones(6)
    assert limit_margins(model, rows) == pytest.approx(expected)
