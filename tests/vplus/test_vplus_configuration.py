"""V+ postures and the text of locations, on a six-axis arm and on a SCARA."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rpl.dialects.vplus.configuration import NOTATION, matrix_to_zyz

from rpl.emulator.model import load_robot
from rpl.emulator.rotations import zyx_to_matrix
from rpl.emulator.selection import STRAIGHT_DEG
from rpl.errors import SourceError

VIPER, COBRA = load_robot("adept_viper_s650"), load_robot("adept_cobra_s600")

TEXTS = [
    ("TRANS(1, 2, 3, 0, 180, 0)", {"shoulder": None, "elbow": None, "wrist": None}),
    ("trans(1,2,3,0,180,0) ;LEFTY ABOVE FLIP", {"shoulder": 1, "elbow": 0, "wrist": 1}),
    ("SET p = TRANS(1, 2, 3, , 180)", {"shoulder": None, "elbow": None, "wrist": None}),
]


@pytest.mark.parametrize(("text", "flags"), TEXTS)
def test_text_of_a_location(text: str, flags: dict[str, int | None]) -> None:
    matrix, found = NOTATION.parse_pose(text)
    assert found == flags
    assert matrix[:3, 3] == pytest.approx([1, 2, 3])
    assert matrix[:3, 2] == pytest.approx([0, 0, -1])


@pytest.mark.parametrize("text", ["{X 1}", "TRANS(1,2,x)", "TRANS(1,2,3,4,5,6,7)"])
def test_what_is_no_location(text: str) -> None:
    with pytest.raises(SourceError):
        NOTATION.parse_pose(text)


def test_a_scara_shows_its_handedness_only() -> None:
    right, left = np.array([10.0, 40.0, 50.0, 0.0]), np.array([10.0, -40.0, 50.0, 0.0])
    assert NOTATION.encode(COBRA, right) == {"shoulder": 0, "elbow": 0, "wrist": 0}
    assert NOTATION.encode(COBRA, left) == {"shoulder": 1, "elbow": 0, "wrist": 0}
    assert NOTATION.format_pose(COBRA, COBRA.forward(right), right).endswith(";RIGHTY")


_ANGLES = [st.floats(low + 1.0, high - 1.0) for low, high in VIPER.limits]


@given(st.tuples(*_ANGLES))
def test_the_posture_that_is_shown_selects_the_joints_again(angles: tuple[float, ...]) -> None:
    joints = np.array(angles)
    flange = VIPER.forward(joints)
    found = NOTATION.select(VIPER, flange, NOTATION.encode(VIPER, joints), joints)
    assert found.joints is not None
    missed = 1e-5 if abs(joints[4]) > STRAIGHT_DEG else 0.003  # a wrist straight within rounding is made straight
    assert np.allclose(VIPER.forward(found.joints), flange, atol=missed)
    assert NOTATION.encode(VIPER, found.joints) == NOTATION.encode(VIPER, joints) or abs(joints[4]) < 0.1


@given(st.tuples(*_ANGLES))
def test_a_location_is_read_back_as_it_is_shown(angles: tuple[float, ...]) -> None:
    joints = np.array(angles)
    flange = VIPER.forward(joints)
    matrix, flags = NOTATION.parse_pose(NOTATION.format_pose(VIPER, flange, joints))
    assert np.allclose(matrix, flange, atol=2e-6)
    assert flags == NOTATION.encode(VIPER, joints)


@pytest.mark.parametrize(
    ("angles", "wanted"),
    [
        ((30.0, 0.0, 0.0), (0.0, 0.0, 30.0)),
        ((30.0, 180.0, 0.0), (0.0, 180.0, -30.0)),
        ((10.0, 20.0, 30.0), (10.0, 20.0, 30.0)),
    ],
)
def test_zyz_angles(angles: tuple[float, float, float], wanted: tuple[float, float, float]) -> None:
    yaw, pitch, roll = angles
    turn = zyx_to_matrix([yaw, pitch, 0.0]) @ zyx_to_matrix([roll, 0.0, 0.0])
    assert matrix_to_zyz(turn) == pytest.approx(wanted)
