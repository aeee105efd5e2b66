"""RPL's posture flags choose the joints that they were made from, on arms of several makers."""

from __future__ import annotations

import numpy as np
import pytest

from rpl import registry
from rpl.emulator.model import load_robot

NOTATION = registry.dialect("rpl").notation
ARMS = ("kuka_kr6r900sixx", "abb_irb120_3_58", "fanuc_lrmate200id")


@pytest.mark.parametrize("arm", ARMS)
def test_encoded_joints_are_selected_again(arm: str) -> None:
    assert NOTATION is not None
    notation, model = NOTATION(), load_robot(arm)
    random = np.random.default_rng(7)
    low, high = model.limits[:, 0], model.limits[:, 1]
    for _ in range(60):
        joints = low + (high - low) * random.uniform(0.05, 0.95, model.axes)
        flags = notation.encode(model, joints)
        chosen = notation.select(model, model.forward(joints), flags, None)
        assert chosen.joints is not None, chosen.reason
        reached = model.forward(chosen.joints)
        assert np.allclose(reached, model.forward(joints), atol=1e-6)
        assert notation.encode(model, chosen.joints) == flags


def test_free_flags_take_the_nearest() -> None:
    assert NOTATION is not None
    notation, model = NOTATION(), load_robot(ARMS[0])
    joints = np.array([10.0, -80.0, 95.0, 20.0, 40.0, 300.0])
    chosen = notation.select(model, model.forward(joints), {}, joints + 1.0)
    assert chosen.joints is not None and np.allclose(chosen.joints, joints, atol=1e-6)


def test_poses_as_text() -> None:
    assert NOTATION is not None
    notation, model = NOTATION(), load_robot(ARMS[0])
    joints = np.array([10.0, -80.0, 95.0, 20.0, 40.0, 30.0])
    matrix = model.forward(joints)
    back, flags = notation.parse_pose(notation.format_pose(model, matrix, joints))
    assert np.allclose(back, matrix, atol=1e-5)
    assert flags == notation.encode(model, joints)
    assert notation.parse_pose(notation.format_pose(model, matrix, None))[1] == dict.fromkeys(notation.fields)
