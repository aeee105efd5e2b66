"""The facts marked M in the tables, each named once, and the notation of postures."""

import numpy as np
import pytest
from inform_helpers import body_of, job
from rpl.dialects.inform import tables
from rpl.dialects.inform.configuration import NOTATION, is_flip
from rpl.postprocessors.inform.operands import Registers

from rpl import ir, registry
from rpl.emulator.model import load_robot

POINTS = "///TOOL 0\n///POSTYPE BASE\n///RECTAN\n///RCONF 1,0,0,0,0,0\nC00000=400,0,400,180,0,0"


def test_levels_are_those_of_the_rules() -> None:
    """M: the distances of PL; the one behind PL=8 is that of a move without PL."""
    levels = registry.dialect("inform").rules().blend_levels
    assert levels == tables.LEVELS
    assert levels[0] == 0.0
    assert len(levels) == tables.STANDARD_LEVEL + 1


@pytest.mark.parametrize(("tags", "level"), [("", 9), (" PL=0", 0), (" PL=4", 4)])
def test_a_move_has_a_level(tags: str, level: int) -> None:
    (move,) = body_of(job(f"MOVL C00000 V=10.0{tags}", POINTS))
    assert isinstance(move, ir.Move)
    assert move.blend == ir.BlendLevel(ir.IntLiteral(level))


@pytest.mark.parametrize(("tag", "part"), [("V", 10.0), ("VR", 10.0), ("VJ", 100.0)])
def test_speeds_in_variables_count_in_parts(tag: str, part: float) -> None:
    """M: 0.1 mm/s, 0.1 deg/s, 0.01 percent."""
    (move,) = body_of(job(f"MOVL C00000 {tag}=I000", POINTS))
    assert isinstance(move, ir.Move)
    assert move.speed is not None
    value = move.speed.path or move.speed.rotation or move.speed.joint
    assert value == ir.Binary("/", ir.Convert("real", ir.Name("I000")), ir.RealLiteral(part))


def test_elements_count_in_micrometres_and_ten_thousandths() -> None:
    """M: SETE in 0.001 mm and 0.0001 deg."""
    body = body_of(job("SETE P000 (1) 1500\nSETE P000 (6) 900000"))
    assert body == (
        ir.Assign(ir.Field(ir.Name("P000"), "x"), ir.RealLiteral(1.5)),
        ir.Assign(ir.Field(ir.Name("P000"), "a"), ir.RealLiteral(90.0)),
    )


@pytest.mark.parametrize(
    ("b", "r", "by_b", "by_r"), [(-60, 0, False, True), (60, 0, True, True), (-60, 120, False, False)]
)
def test_flip_by_the_sign_of_b_or_by_r(b: float, r: float, by_b: bool, by_r: bool) -> None:
    joints = np.array([0.0, 0.0, 0.0, r, b, 0.0])
    assert (is_flip(joints, "b"), is_flip(joints, "r")) == (by_b, by_r)


@pytest.mark.parametrize("robot", ["motoman_gp7", "motoman_mh24"])
def test_what_is_encoded_selects_the_same_posture(robot: str) -> None:
    model = load_robot(robot)
    random = np.random.default_rng(3)
    low, high = model.limits[:, 0], model.limits[:, 1]
    for _ in range(60):
        joints = random.uniform(0.8 * low, 0.8 * high)
        found = NOTATION.select(model, model.forward(joints), NOTATION.encode(model, joints), joints)
        assert found.joints is not None, found.reason
        assert np.abs(found.joints - joints).max() < 1e-6


def test_poses_are_written_and_read() -> None:
    model = load_robot("motoman_gp7")
    joints = np.array([10.0, 5.0, -10.0, 0.0, -70.0, 20.0])
    text = NOTATION.format_pose(model, model.forward(joints), joints)
    matrix, flags = NOTATION.parse_pose(text)
    assert np.abs(matrix - model.forward(joints)).max() < 1e-4
    assert flags == NOTATION.encode(model, joints)


def test_helpers_are_none_of_the_numbers_that_only_the_data_before_the_program_mentions() -> None:
    """An array that is read with a computed number alone: its elements have no other mention."""
    first = ir.Assign(ir.Index(ir.Name("D"), (ir.IntLiteral(99),)), ir.IntLiteral(5))
    program = ir.Program((ir.Module("M", "rpl", (ir.Initialise(first),)),))
    assert Registers.of(program).helper("D") == "D098"
