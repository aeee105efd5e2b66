"""What decides is rounded first: values on a boundary by design lie on one side of it, whatever the last bits are."""

import numpy as np
import pytest

from rpl.emulator.blending import NoBlend, Size, blend
from rpl.emulator.model import load_robot
from rpl.emulator.paths import Line
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import matrix_to_zyx, pose_matrix, rotation_vector_to_matrix, zyx_to_matrix
from rpl.emulator.rounding import first_least, settled, steps_of, whole_turns
from rpl.passes import rigid
from rpl.registry import dialect
from rpl.runtime.machine import Machine
from rpl.writing.text import number_text

BITS = (-1e-12, 0.0, 1e-12)
ARM = load_robot("kuka_kr6r900sixx")
HERE = np.array([10.0, -80.0, 90.0, 0.0, 40.0, 0.0])


@pytest.mark.parametrize("noise", BITS)
def test_counts_turns_and_choices(noise: float) -> None:
    assert steps_of(100.0 + noise, 10.0, 8, 400) == 10
    assert steps_of(100.1, 10.0, 8, 400) == 11
    assert whole_turns(180.0 + noise) == 0.0
    assert whole_turns(181.0) == 1.0
    assert first_least([3.0 + noise, 3.0, 4.0]) == 0
    assert settled(noise) == 0.0
    assert settled(-180.0 + noise) == -180.0


@pytest.mark.parametrize("noise", BITS)
def test_an_axis_half_a_turn_away_goes_one_way(noise: float) -> None:
    target, here = HERE.copy(), HERE.copy()
    target[5], here[5] = 180.0, noise
    assert ARM.nearest_turn(target, here)[5] == 180.0


@pytest.mark.parametrize("noise", (-5e-11, -1e-12, 0.0, 1e-12, 5e-11))
def test_half_a_turn_is_positive(noise: float) -> None:
    joints = HERE.copy()
    joints[5] = -180.0 + noise
    assert ARM.canonical(joints)[5] == pytest.approx(180.0, abs=1e-10)
    assert matrix_to_zyx(zyx_to_matrix([-180.0 + noise, 30.0, 0.0]))[0] == pytest.approx(180.0, abs=1e-9)
    assert rigid.rotation_of_turns((3, -180.0 + noise)).zyx[0] == pytest.approx(180.0, abs=1e-9)


@pytest.mark.parametrize("noise", (-1e-13, 0.0, 1e-13))
def test_a_zero_component_chooses_no_sign(noise: float) -> None:
    rows = rigid.Rotation((noise / 4.0, -0.6, 0.8, 0.0)).rows
    assert rigid.rotation_of_rows(rows).quaternion == pytest.approx((0.0, 0.6, -0.8, 0.0), abs=1e-12)
    assert rigid.rotation_of_rows(rows).quaternion[0] == 0.0


@pytest.mark.parametrize("noise", BITS)
@pytest.mark.parametrize(("name", "arm"), [("krl", "kuka_kr6r900sixx"), ("rapid", "abb_irb120_3_58")])
def test_flags_at_zero_are_those_of_zero(name: str, arm: str, noise: float) -> None:
    make, model = dialect(name).notation, load_robot(arm)
    assert make is not None
    notation = make()
    joints = np.array([0.0, 10.0, 20.0, 0.0, 40.0, 90.0])
    assert notation.encode(model, joints + noise) == notation.encode(model, joints)


@pytest.mark.parametrize("noise", BITS)
def test_a_joint_move_to_where_the_arm_stands_has_no_corner(noise: float) -> None:
    """By a share of the second move it would have one, if the noise of the inverse counted as a way."""
    stays = _planned(MoveRequest(kind="joint", target_joints=HERE + noise))
    goes = _planned(MoveRequest(kind="joint", target_joints=HERE + 10.0))
    assert stays.duration_s == 0.0
    assert isinstance(blend(ARM, stays, goes, Size(fraction=0.25)), NoBlend)
    assert isinstance(blend(ARM, stays, goes, Size(overlap=1.0)), NoBlend)


def _planned(request: MoveRequest) -> PlannedMove:
    move = plan(ARM, HERE, request)
    assert isinstance(move, PlannedMove)
    return move


@pytest.mark.parametrize("noise", (-1e-12, 0.0, 1e-12))
def test_a_number_between_two_printed_ones(noise: float) -> None:
    assert number_text(1234.0625 + noise, 3) == "1234.062"
    assert number_text(-0.5005 + noise * 1e-3, 3) == "-0.5"
    assert number_text(1234.0625001, 3) == "1234.063"


@pytest.mark.parametrize("noise", BITS)
def test_what_comes_at_one_moment_comes_by_its_phase(noise: float) -> None:
    class _Agenda(Machine):
        def __init__(self) -> None:
            self.agenda, self.sequence = [], 0

    machine = _Agenda()
    machine.schedule(2.5, 2, "late phase", 0)
    machine.schedule(2.5 + noise, 1, "early phase", 0)
    assert min(machine.agenda)[6] == "early phase"


@pytest.mark.parametrize("off_deg", [-5e-5, -1e-9, 0.0, 1e-9, 5e-5])
@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.6, -0.8, 0.0)])
def test_a_line_with_half_a_turn_turns_one_way(axis: tuple[float, float, float], off_deg: float) -> None:
    """Poses that are computed with numbers of four bytes are half a turn apart within some millionths of a degree."""
    turn = np.array(axis) * np.deg2rad(180.0 + off_deg)
    path = Line(np.eye(4), pose_matrix([0.0, 0.0, 100.0], rotation_vector_to_matrix(turn)))
    lead = next(part for part in path.turn if abs(part) > 0.1)
    assert lead > 0.0
    assert np.allclose(path.poses([1.0])[0], path.end, atol=1e-9)


def test_a_turn_that_is_meant_to_go_back_goes_back() -> None:
    turn = np.array([0.0, 0.0, np.deg2rad(-179.9998)])
    path = Line(np.eye(4), pose_matrix([0.0, 0.0, 100.0], rotation_vector_to_matrix(turn)))
    assert np.allclose(path.turn, turn)
