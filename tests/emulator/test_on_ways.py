"""Joints along a way of places, found for many at once, are those that are found one after the other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.model import load_robot
from rpl.emulator.onways import Nearest, followed
from rpl.emulator.rotations import FloatArray


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "ur5e", "adept_cobra_s600"])
@given(seed=st.integers(0, 10**6), count=st.integers(1, 60), width=st.sampled_from((0.0, 5.0, 60.0, 400.0)))
@settings(max_examples=15, deadline=None)
def test_many_places_are_reached_as_each_from_the_one_before(name: str, seed: int, count: int, width: float) -> None:
    arm, chance = load_robot(name), np.random.default_rng(seed)
    joints = np.clip(arm.home + chance.uniform(-width, width, (count, arm.axes)), arm.limits[:, 0], arm.limits[:, 1])
    flanges = arm.forward(joints)
    flanges[chance.random(count) < 0.1, :3, 3] *= 3.0  # some are out of reach
    near, wanted, before = arm.home, list[FloatArray](), list[FloatArray]()
    for flange in flanges:
        found = arm.nearest(flange, near)
        before.append(near)
        wanted.append(np.full(arm.axes, np.nan) if found is None else found)
        near = near if found is None else found
    given_joints, given_before = followed(Nearest(arm, flanges), arm.home, count)
    np.testing.assert_allclose(given_joints, np.array(wanted), atol=1e-9)
    np.testing.assert_allclose(given_before, np.array(before), atol=1e-9)
