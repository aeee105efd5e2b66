"""Joints, poses and configuration flags that controllers themselves have printed, in both directions.

The targets are read as they were printed, with their rounding, and sit where it hurts: axis 4 within a thousandth of a
degree of zero, axis 6 at exactly half a turn. The sources stand in the data file.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rpl import registry
from rpl.emulator.configuration import Notation
from rpl.emulator.model import RobotModel, load_robot
from rpl.emulator.rotations import pose_matrix, rotation_angle

LINES = (Path(__file__).parent / "data" / "published_pairs.txt").read_text(encoding="utf-8").splitlines()
PAIRS = [tuple(part.strip() for part in line.split("|")) for line in LINES if not line.startswith("#")]
DIALECTS = {"abb": "rapid", "fanuc": "tp", "kuka": "krl", "ur3": "urscript", "ur5e": "urscript"}
# Rounding of the printed numbers.
PLACE_MM, TURN_DEG, JOINT_DEG = 0.02, 0.01, 0.003


def notation(robot: str) -> Notation:
    make = registry.dialect(DIALECTS[robot.partition("_")[0]]).notation
    assert make is not None
    return make()


@pytest.mark.parametrize(("robot", "tool_mm", "joints", "target"), PAIRS)
def test_printed_pairs(robot: str, tool_mm: str, joints: str, target: str) -> None:
    """Forward gives the printed pose, encoding the printed flags, and both together the joints again."""
    model, kind = load_robot(robot), notation(robot)
    values = np.array([float(part) for part in joints.split(",")])
    matrix, flags = kind.parse_pose(target)
    flange = matrix @ pose_matrix([0.0, 0.0, -float(tool_mm)])
    reached = model.forward(values)
    assert reached[:3, 3] == pytest.approx(flange[:3, 3], abs=PLACE_MM)
    assert np.degrees(rotation_angle(reached[:3, :3].T @ flange[:3, :3])) < TURN_DEG
    assert kind.encode(model, values) == flags
    if model.within_limits(values):  # calculated by the controller without a look at its limits
        assert "limit" in kind.select(model, flange, flags, None).reason
        return
    for near in [None, model.home] if flags else [values, values + 20.0]:
        chosen = kind.select(model, flange, flags, near)
        assert chosen.joints == pytest.approx(values, abs=JOINT_DEG), chosen.reason


def test_there_are_pairs_of_four_makers() -> None:
    assert len(PAIRS) == len(set(PAIRS)) > 100
    assert {robot.partition("_")[0] for robot, *_ in PAIRS} == set(DIALECTS)


# boundary/results/* of the same probes: axis 6 in RobotStudio and the turn with which ROBOGUIDE reached the point.
@pytest.mark.parametrize(
    ("abb_axis_6", "turn"), [(-0.0118, 1), (0.0, 1), (-0.0999, 1), (-0.0110, 1), (-57.9899, 1), (0.0996, 0)]
)
def test_axis_6_at_half_a_turn(abb_axis_6: float, turn: int) -> None:
    model: RobotModel = load_robot("fanuc_r2000ic190s")
    joints = np.array([0.0, 0.0, 0.0, 0.0, -90.0, 180.0 - abb_axis_6])
    assert notation(model.name).encode(model, joints)["t6"] == turn
