"""CONFIG strings against published joint/pose pairs and the rules measured on virtual controllers."""

import numpy as np
import pytest

from rpl import registry
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import matrix_to_zyx, pose_matrix
from rpl.errors import SourceError

# onerobotics.com, "The perils of six-axis robots": R-2000iB/165F, 270 mm from the wrist centre to the tool.
NUT = (7.962, -5.284, -36.25, 77.661, -51.975, -79.273)
FUT = (7.962, -5.284, -36.25, -102.339, 51.975, 100.727)
TOOL_BEYOND_FLANGE_MM = 35.0  # of fanuc_r2000ib210f, whose flange is 235 mm from the wrist centre


def notation():  # type: ignore[no-untyped-def]
    make = registry.dialect("tp").notation
    assert make is not None
    return make()


def text_of(flags: dict[str, int]) -> str:
    letters = "NF"[flags["flip"]] + "UD"[flags["down"]] + "TB"[flags["back"]]
    return f"{' '.join(letters)}, {flags['t1']}, {flags['t4']}, {flags['t6']}"


@pytest.mark.parametrize(("joints", "config"), [(NUT, "N U T, 0, 0, 0"), (FUT, "F U T, 0, 0, 0")])
def test_the_published_pair(joints: tuple[float, ...], config: str) -> None:
    model = load_robot("fanuc_r2000ib210f")
    flange = model.forward(joints)
    tool = flange @ pose_matrix([0.0, 0.0, TOOL_BEYOND_FLANGE_MM], np.eye(3))
    assert tool[:3, 3] == pytest.approx([1500.01, 0.0, 360.0], abs=0.02)
    r, p, w = matrix_to_zyx(tool)
    assert (w, p, r) == pytest.approx((135.0, -45.0, 0.0), abs=0.01)
    flags = notation().encode(model, np.array(joints))
    assert text_of(flags) == config
    chosen = notation().select(model, flange, flags, None)
    assert chosen.joints == pytest.approx(np.array(joints), abs=1e-6)


TURNS = [
    *((0.0, 0), (179.99, 0), (-179.99, 0), (180.0, 1), (-180.0, -1), (350.0, 1), (-235.0, -1)),
    *((539.9, 1), (540.0, 2), (-540.0, -2)),
]


@pytest.mark.parametrize(("angle", "turn"), TURNS)
def test_turn_zero_is_open_at_both_ends(angle: float, turn: int) -> None:
    model = load_robot("fanuc_lrmate200id")
    assert notation().encode(model, np.array([0, 0, 0, 0, -90, angle]))["t6"] == turn


def test_half_a_turn_can_be_asked_for_on_either_side_but_not_as_turn_zero() -> None:
    model = load_robot("fanuc_r2000ib210f")
    flange = model.forward([0, 0, 0, 0, -90, 180.0])
    found = {}
    for turn in (-1, 0, 1):
        flags = {"flip": 0, "down": 0, "back": 0, "t1": 0, "t4": 0, "t6": turn}
        joints = notation().select(model, flange, flags, None).joints
        found[turn] = None if joints is None else round(float(joints[5]), 6)
    assert found == {-1: -180.0, 0: None, 1: 180.0}


def test_the_refusal_says_what_the_arm_can_do() -> None:
    model = load_robot("fanuc_lrmate200id")
    flange = model.forward([0, 0, 0, 0, -90, 0])
    flags = {"flip": 1, "down": 0, "back": 0, "t1": 0, "t4": 0, "t6": 0}
    chosen = notation().select(model, flange, flags, None)
    assert chosen.joints is None and "'N U T, 0, 0, 0'" in chosen.reason


@pytest.mark.parametrize("seed", range(20))
def test_what_is_shown_is_chosen(seed: int) -> None:
    model = load_robot("fanuc_m20id25")
    low, high = model.limits[:, 0], model.limits[:, 1]
    joints = np.random.default_rng(seed).uniform(low * 0.9, high * 0.9)
    flags = notation().encode(model, joints)
    chosen = notation().select(model, model.forward(joints), flags, joints)
    assert chosen.joints == pytest.approx(joints, abs=1e-5)


def test_a_position_as_text_and_back() -> None:
    model = load_robot("fanuc_lrmate200id")
    joints = np.array([10.0, 5.0, -20.0, 15.0, -80.0, 200.0])
    matrix = model.forward(joints)
    text = notation().format_pose(model, matrix, joints)
    assert text.startswith("CONFIG : 'N U T, 0, 0, 1', X = ")
    again, flags = notation().parse_pose(text)
    assert again == pytest.approx(matrix, abs=1e-5)
    assert flags == notation().encode(model, joints)


def test_a_text_that_is_no_position_is_refused() -> None:
    with pytest.raises(SourceError, match="lacks Z, W, P, R"):
        notation().parse_pose("X = 1 mm, Y = 2 mm")
