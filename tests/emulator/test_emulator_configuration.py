"""Configuration flags by the rules that vendors' virtual controllers and taught points follow."""

import numpy as np
import pytest
from rpl.dialects.krl.configuration import NOTATION as KRL
from rpl.dialects.krl.configuration import is_untaught
from rpl.dialects.rapid.configuration import NOTATION as RAPID

from rpl.emulator.configuration import Notation
from rpl.emulator.model import load_robot
from rpl.errors import SourceError

KR6 = load_robot("kuka_kr6r900sixx")
IRB120 = load_robot("abb_irb120_3_58")


def encoded(notation: Notation, robot: str, joints: list[float]) -> tuple[int, ...]:
    return tuple(notation.encode(load_robot(robot), np.array(joints)).values())


@pytest.mark.parametrize(
    ("joints", "status", "turn"),
    [
        ([0, -90, 90, 0, 0, 0], 0b010, 0b000010),
        ([0, -90, 90, 0, -0.0, -0.0], 0b010, 0b000010),
        ([0, -90, 90, 0, -1e-5, 0], 0b110, 0b010010),
        ([0, -90, 4.77, 0, 10, 0], 0b010, 0b000010),
        ([0, -90, 4.75, 0, 10, 0], 0b000, 0b000010),
        ([0, -90, 90, -190.07, 10, 0], 0b010, 0b001010),
        ([0, -90, 90, 190, 10, -350], 0b010, 0b100010),
        ([10, -150, 20, 0, 30, 0], 0b011, 0b000010),
    ],
)
def test_status_and_turn(joints: list[float], status: int, turn: int) -> None:
    assert encoded(KRL, "kuka_kr6r900sixx", joints) == (status, turn)


@pytest.mark.parametrize(
    ("robot", "threshold"),
    [("kuka_kr6r900sixx", 4.76), ("kuka_kr125_3", 2.58), ("kuka_kr16_2", -2.99)],
)
def test_elbow_threshold_is_the_stretched_arm(robot: str, threshold: float) -> None:
    assert encoded(KRL, robot, [0, -90, threshold + 0.01, 0, 10, 0])[0] == 0b010
    assert encoded(KRL, robot, [0, -90, threshold - 0.01, 0, 10, 0])[0] == 0b000


@pytest.mark.parametrize(
    ("joints", "conf"),
    [
        ([0, 0, 0, 0, 0, 0], (0, 0, 0, 0)),
        ([-0.00018, 0, 0, 90, 1, 190], (-1, 1, 2, 0)),
        ([89.999, 0, 0, -185, -1, -0.0], (0, -3, 0, 1)),
        ([0, 0, -81.5, 0, 30, 0], (0, 0, 0, 0)),
        ([0, 0, -82.2, 0, 30, 0], (0, 0, 0, 2)),
        ([0, -60, -60, 0, 30, 0], (0, 0, 0, 4)),
        ([0, -60, -100, 0, -30, 0], (0, 0, 0, 7)),
    ],
)
def test_confdata(joints: list[float], conf: tuple[int, ...]) -> None:
    assert encoded(RAPID, "abb_irb6700_140_285", joints) == conf


@pytest.mark.parametrize(
    ("notation", "robot"), [(KRL, "kuka_kr6r900sixx"), (KRL, "kuka_kr125_3"), (RAPID, "abb_irb120_3_58")]
)
def test_flags_choose_the_joints_they_describe(notation: Notation, robot: str) -> None:
    """300 postures all over the range, less those within 2 degrees of a sign change, where T is ignored."""
    model, rng = load_robot(robot), np.random.default_rng(4)
    postures = rng.uniform(model.limits[:, 0], model.limits[:, 1], (400, 6))
    for joints in postures[(np.abs(postures) > 2.001).all(axis=1)][:300]:
        chosen = notation.select(model, model.forward(joints), notation.encode(model, joints), model.home)
        assert chosen.joints == pytest.approx(joints, abs=1e-6), chosen.reason


def test_missing_status_keeps_the_one_of_the_start() -> None:
    start = np.array([0, -90, 90, 0, -60, 0.0])
    flange = KR6.forward([20, -80, 70, 10, 50, 30])
    chosen = KRL.select(KR6, flange, {}, start)
    assert chosen.joints is not None
    assert KRL.encode(KR6, chosen.joints)["s"] == 0b110


def test_missing_turn_takes_the_shortest_way() -> None:
    start = np.array([0, -90, 90, 0, 60, 300.0])
    flange = KR6.forward([0, -90, 90, 0, 60, -40])
    chosen = KRL.select(KR6, flange, {"s": 2, "t": None}, start)
    assert chosen.joints == pytest.approx([0, -90, 90, 0, 60, 320], abs=1e-6)


def test_first_motion_needs_both_flags() -> None:
    flange = KR6.forward(KR6.home)
    assert KRL.select(KR6, flange, {"s": 2}, None).joints is None
    assert KRL.select(KR6, flange, {"s": 2, "t": 2}, None).joints == pytest.approx(KR6.home)


def test_turn_bit_next_to_zero_is_ignored() -> None:
    flange = KR6.forward([1.5, -90, 90, 0, 60, 0])
    wrong_sign = KRL.select(KR6, flange, {"s": 2, "t": 0b000011}, KR6.home)
    assert wrong_sign.joints == pytest.approx([1.5, -90, 90, 0, 60, 0], abs=1e-6)
    assert KRL.select(KR6, KR6.forward([2.5, -90, 90, 0, 60, 0]), {"s": 2, "t": 0b000011}, KR6.home).joints is None


def test_absolute_accuracy_bit_chooses_nothing() -> None:
    flange = KR6.forward([10, -90, 90, 5, 60, 7])
    assert KRL.select(KR6, flange, {"s": 2 + 16, "t": 2}, None).joints == pytest.approx([10, -90, 90, 5, 60, 7])


def test_an_impossible_choice_names_the_possible_ones() -> None:
    flange = KR6.forward([0, -90, 90, 0, 60, 0])
    refused = KRL.select(KR6, flange, {"s": 1, "t": 0}, KR6.home)
    assert refused.joints is None
    assert "S 2, T 2" in refused.reason


def test_untaught_point() -> None:
    matrix, flags = KRL.parse_pose("{X 666666.688,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0,S 0,T 0}")
    assert is_untaught(matrix)
    assert KRL.select(KR6, matrix, flags, KR6.home).reason == "the point is not taught"


@pytest.mark.parametrize(("sent", "got"), [(0, 0), (1, None), (-1, 0)])
def test_confj_accepts_a_quarter_within_45_degrees(sent: int, got: int | None) -> None:
    """J6 at 10 degrees: quarter 0 exactly; quarter -1 (-90..0) by its tolerance; quarter 1 (90..180) not."""
    joints = np.array([10.0, 10, 10, 20, 30, 10])
    chosen = RAPID.select(IRB120, IRB120.forward(joints), {"cf1": 0, "cf4": 0, "cf6": sent, "cfx": 0}, None)
    assert (chosen.joints is None) == (got is None)


def test_confj_off_keeps_the_main_axes_and_takes_the_nearest_turn() -> None:
    start = np.array([0, 0, 0, 0, 30, 350.0])
    chosen = RAPID.select(IRB120, IRB120.forward([10, 10, 10, 0, 40, 0]), {}, start)
    assert chosen.joints == pytest.approx([10, 10, 10, 0, 40, 360], abs=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        "{X 445.0,Y 0.0,Z 790.0,A 180.0,B 0.0,C 180.0,S 2,T 35}",
        "{POS: X 445,Y 0,Z 790,A 180,B 0,C 180,S 2,T 35}",
        "DECL E6POS XP1={x 445,y 0,z 790,a 180,b 0,c 180,s 'B10',t 'B100011',e1 0.0,e2 0.0}",
        "{ E6POS : C 180, B 0, A 180, Z 7.9e2, Y 0, X 445, T 35, S 'H2' , E1 0.0}",
    ],
)
def test_krl_texts(text: str) -> None:
    matrix, flags = KRL.parse_pose(text)
    assert flags == {"s": 2, "t": 35}
    assert matrix == pytest.approx(np.array([[-1, 0, 0, 445], [0, 1, 0, 0], [0, 0, -1, 790], [0, 0, 0, 1]]), abs=1e-9)


@pytest.mark.parametrize("text", ["{A1 0,A2 -90}", "nothing", "{X 1,Y 2,Z 3,A 4,B 5}", "{X 1,Y ?,Z 3,A 1,B 1,C 1}"])
def test_krl_text_that_is_no_pose(text: str) -> None:
    with pytest.raises(SourceError):
        KRL.parse_pose(text)


def test_rapid_text() -> None:
    matrix, flags = RAPID.parse_pose("[[374,0,630],[0.707107,0,0.707107,0],[0,-1,-3,1],[9E9,9E+09,9E9,9E9,9E9,9E9]]")
    assert flags == {"cf1": 0, "cf4": -1, "cf6": -3, "cfx": 1}
    assert matrix == pytest.approx(IRB120.forward(np.zeros(6)), abs=1e-9)
    assert RAPID.parse_pose("[[1,2,3],[1,0,0,0]]")[1] == dict.fromkeys(RAPID.fields)


@pytest.mark.parametrize("text", ["[[1,2],[1,0,0,0]]", "[[1,2,3],[1,1,0,0],[0,0,0,0]]", "p10"])
def test_rapid_text_that_is_no_target(text: str) -> None:
    with pytest.raises(SourceError):
        RAPID.parse_pose(text)


@pytest.mark.parametrize("notation", [KRL, RAPID], ids=lambda n: str(n.name))
@pytest.mark.parametrize("robot", ["kuka_kr6r900sixx", "abb_irb120_3_58", "fanuc_m20id25", "staubli_tx60", "ur5e"])
def test_what_is_printed_reads_back(notation: Notation, robot: str) -> None:
    model = load_robot(robot)
    joints = np.array([12.3, -71.1, 63.4, 21.2, 33.3, -44.4])
    matrix, flags = notation.parse_pose(notation.format_pose(model, model.forward(joints), joints))
    assert matrix == pytest.approx(model.forward(joints), abs=2e-6)
    assert flags == notation.encode(model, joints)
    assert notation.select(model, matrix, flags, joints).joints == pytest.approx(joints, abs=1e-4)
