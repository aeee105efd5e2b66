"""Every convention against published golden values, against each other, and back again for any rotation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.rotations import (
    CONVENTIONS,
    invert_pose,
    matrix_to_zyx,
    matrix_to_zyz,
    pose_matrix,
    quaternion_to_matrix,
    rotation_angle,
    slerp,
    zyx_to_matrix,
)

MATRIX = np.array([[0.813798, -0.440970, 0.378522], [0.469846, 0.882564, 0.018028], [-0.342020, 0.163176, 0.925417]])
# Rz(30)·Ry(20)·Rx(10) in every convention.
GOLDEN = {
    "zyx": (30.0, 20.0, 10.0),
    "xyz_fixed": (10.0, 20.0, 30.0),
    "quaternion": (0.951549, 0.038135, 0.189308, 0.239298),
    "rotation_vector": (0.077525, 0.384852, 0.486479),
    "zyz": (2.7268, 22.2687, 25.5056),
    "xyz_moving": (-1.1161, 22.2422, 28.4518),
}
QUATERNIONS = [
    ("zyx", (10.0, 20.0, 30.0), (0.951549, 0.239298, 0.189308, 0.038135)),
    ("zyz", (10.0, 20.0, 30.0), (0.925417, 0.030154, 0.171010, 0.336824)),
    ("xyz_moving", (10.0, 20.0, 30.0), (0.943714, 0.127679, 0.144878, 0.268536)),
]

component = st.floats(-1.0, 1.0, allow_nan=False)
quaternions = st.tuples(component, component, component, component).filter(lambda q: sum(v * v for v in q) > 1e-3)


@pytest.mark.parametrize("name", CONVENTIONS)
def test_golden_value(name: str) -> None:
    convention = CONVENTIONS[name]
    assert convention.to_matrix(GOLDEN[name]) == pytest.approx(MATRIX, abs=2e-6)
    assert convention.from_matrix(zyx_to_matrix([30, 20, 10])) == pytest.approx(GOLDEN[name], abs=1e-4)


@pytest.mark.parametrize(("name", "angles", "quaternion"), QUATERNIONS)
def test_golden_quaternion(name: str, angles: tuple[float, ...], quaternion: tuple[float, ...]) -> None:
    from_angles = CONVENTIONS["quaternion"].from_matrix(CONVENTIONS[name].to_matrix(angles))
    assert from_angles == pytest.approx(quaternion, abs=1e-6)


@pytest.mark.parametrize("name", CONVENTIONS)
@given(quaternion=quaternions)
@settings(max_examples=150, deadline=None)
def test_there_and_back(name: str, quaternion: tuple[float, ...]) -> None:
    rotation = quaternion_to_matrix(quaternion)
    convention = CONVENTIONS[name]
    numbers = convention.from_matrix(rotation)
    assert numbers.shape == (convention.count,)
    assert convention.to_matrix(numbers) == pytest.approx(rotation, abs=5e-9)


@pytest.mark.parametrize("name", CONVENTIONS)
@pytest.mark.parametrize("first", [0, 37, 90, 180, -90])
@pytest.mark.parametrize("second", [0, 90, -90, 180])
@pytest.mark.parametrize("third", [0, -63, 90, 180])
def test_there_and_back_at_right_angles(name: str, first: float, second: float, third: float) -> None:
    convention = CONVENTIONS[name]
    for rotation in (
        CONVENTIONS["zyx"].to_matrix([first, second, third]),
        CONVENTIONS["zyz"].to_matrix([first, second, third]),
    ):
        assert convention.to_matrix(convention.from_matrix(rotation)) == pytest.approx(rotation, abs=1e-9)


@given(quaternion=quaternions, tiny=st.floats(-1e-7, 1e-7))
def test_next_to_the_gimbal(quaternion: tuple[float, ...], tiny: float) -> None:
    a, _, c = matrix_to_zyx(quaternion_to_matrix(quaternion))
    rotation = zyx_to_matrix([a, 90.0 + tiny, c])
    assert zyx_to_matrix(matrix_to_zyx(rotation)) == pytest.approx(rotation, abs=2e-9)


def test_gimbal_puts_the_whole_turn_into_one_angle() -> None:
    assert matrix_to_zyx(zyx_to_matrix([40, 90, 10])) == pytest.approx([30, 90, 0])
    assert matrix_to_zyz(CONVENTIONS["zyz"].to_matrix([40, 180, 10])) == pytest.approx([0, 180, -30])


def test_angles_are_printed_as_controllers_do() -> None:
    assert matrix_to_zyx(zyx_to_matrix([-180, 0, 180])).tolist() == [180.0, 0.0, 180.0]
    assert not np.signbit(matrix_to_zyx(np.eye(3))).any()


def test_vectorised_like_one_by_one() -> None:
    rng = np.random.default_rng(1)
    rotations = quaternion_to_matrix(rng.normal(size=(50, 4)))
    for convention in CONVENTIONS.values():
        together = convention.from_matrix(rotations)
        assert together == pytest.approx(np.array([convention.from_matrix(r) for r in rotations]))


@given(first=quaternions, second=quaternions, share=st.floats(0, 1))
def test_slerp_turns_evenly(first: tuple[float, ...], second: tuple[float, ...], share: float) -> None:
    start, end = quaternion_to_matrix(first), quaternion_to_matrix(second)
    whole = rotation_angle(start.T @ end)
    part = slerp(start, end, np.array([0.0, share, 1.0]))
    assert part[0] == pytest.approx(start, abs=1e-12)
    assert part[2] == pytest.approx(end, abs=1e-7)
    assert rotation_angle(start.T @ part[1]) == pytest.approx(share * whole, abs=1e-7)


def test_inverse_pose() -> None:
    turned = quaternion_to_matrix([0.3, 0.1, -0.7, 0.2])
    pose = pose_matrix([[1.0, -2.0, 3.0], [0, 0, 0]], turned)
    assert pose @ invert_pose(pose) == pytest.approx(np.stack([np.eye(4)] * 2), abs=1e-12)


@pytest.mark.parametrize("bad", [[1.0, 2.0], np.eye(2), [0.0, 0.0, 0.0, 0.0]])
def test_wrong_shapes_are_refused(bad: object) -> None:
    with pytest.raises(ValueError, match=r"shape|zero"):
        quaternion_to_matrix(bad)  # type: ignore[arg-type]
