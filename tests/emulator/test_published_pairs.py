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
from rpl.emulator.rotations import (
    FloatArray,
    invert_pose,
    matrix_to_zyx,
    pose_matrix,
    rotation_angle,
    zyx_to_matrix,
)


def table(name: str) -> list[tuple[str, ...]]:
    lines = (Path(__file__).parent / "data" / name).read_text(encoding="utf-8").splitlines()
    return [tuple(part.strip() for part in line.split("|")) for line in lines if not line.startswith("#")]


PAIRS, READINGS = table("published_pairs.txt"), table("published_readings.txt")
DIALECTS = {"abb": "rapid", "fanuc": "tp", "kuka": "krl", "motoman": "inform", "ur3": "urscript", "ur5e": "urscript"}
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
    assert {robot.partition("_")[0] for robot, *_ in PAIRS} == set(DIALECTS) - {"motoman"}


def framed(values: str) -> FloatArray:
    """A tool (4, 4) of x y z w p r."""
    x, y, z, w, p, r = map(float, values.replace(",", " ").split())
    return pose_matrix([x, y, z], zyx_to_matrix([r, p, w]))


@pytest.mark.parametrize(("robot", "tool", "joints", "target", "close"), READINGS)
def test_readings_of_machines(robot: str, tool: str, joints: str, target: str, close: str) -> None:
    """As printed pairs, within what the machine printed and how well its tool is known."""
    model, kind = load_robot(robot), notation(robot)
    place, turn, axis = map(float, close.split())
    values = np.array([float(part) for part in joints.split(",")])
    matrix, flags = kind.parse_pose(target)
    flange = matrix @ invert_pose(framed(tool))
    reached = model.forward(values) @ framed(tool)
    assert np.linalg.norm(reached[:3, 3] - matrix[:3, 3]) < place
    assert np.degrees(rotation_angle(reached[:3, :3].T @ matrix[:3, :3])) < turn
    assert kind.encode(model, values) == flags
    chosen = kind.select(model, flange, flags, None)
    assert chosen.joints == pytest.approx(values, abs=axis), chosen.reason


# A cell of two GP25 with its machine parameters and its tools; github.com/lukelalondePZ/Komatsu-Press-Demo. Points in
# pulses beside points in millimetres of the same gripper: above the stack straight over where the part is taken, and
# in front of the press at the height of entry, so that poses count from the height of axis 2.
GRIPPER = "-165.205 0 358.005 0 -90 0"
ABOVE = (182486, -16527, -36319, -44059, 18956, 22828)
TAKEN = "-863.111,979.613,426.219,178.9297,-0.1487,123.0482 RCONF 0,0,0,0,0,0,0,0"
BEFORE = (182835, -67765, -44577, -28, -3541, -48884)
ENTRY = "-850.000,924.100,955.814,-90.0000,0.0000,90.0000 RCONF 1,0,0,0,1,0,0,0"


def test_points_in_pulses_lie_where_the_cell_says() -> None:
    model, kind = load_robot("motoman_gp25"), notation("motoman_gp25")
    assert model.pulse_scale is not None
    above, before = (model.forward(pulses / model.pulse_scale) @ framed(GRIPPER) for pulses in (ABOVE, BEFORE))
    taken, flags = kind.parse_pose(TAKEN)
    assert above[:2, 3] == pytest.approx(taken[:2, 3], abs=0.02)
    assert matrix_to_zyx(above) == pytest.approx(matrix_to_zyx(taken), abs=0.002)
    assert kind.encode(model, ABOVE / model.pulse_scale) == flags
    assert kind.select(model, taken @ invert_pose(framed(GRIPPER)), flags, None).joints is not None
    entry, flags = kind.parse_pose(ENTRY)
    assert before[2, 3] == pytest.approx(entry[2, 3], abs=0.1)
    # No-flip and T beyond half a turn: written by hand to a tenth of a degree, so that axis 6 may end at 180 all but.
    chosen = kind.select(model, entry @ invert_pose(framed(GRIPPER)), flags, None)
    assert chosen.joints == pytest.approx([145.76, -8.74, -8.40, 89.77, -55.76, 180.40], abs=0.01)


# boundary/results/* of the same probes: axis 6 in RobotStudio and the turn with which ROBOGUIDE reached the point.
@pytest.mark.parametrize(
    ("abb_axis_6", "turn"), [(-0.0118, 1), (0.0, 1), (-0.0999, 1), (-0.0110, 1), (-57.9899, 1), (0.0996, 0)]
)
def test_axis_6_at_half_a_turn(abb_axis_6: float, turn: int) -> None:
    model: RobotModel = load_robot("fanuc_r2000ic190s")
    joints = np.array([0.0, 0.0, 0.0, 0.0, -90.0, 180.0 - abb_axis_6])
    assert notation(model.name).encode(model, joints)["t6"] == turn
