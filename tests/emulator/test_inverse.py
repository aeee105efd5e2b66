"""The closed-form inverse returns every branch, exactly, in singular postures and next to them too.

Exactly: each solution reaches the pose within 1e-9 mm, and 1e-9 in every entry of the rotation.
"""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.arms import OpwArm, ScaraArm, UrArm
from rpl.emulator.model import RobotModel, load_robot, robot_names
from rpl.emulator.rotations import FloatArray, matrix_to_rotation_vector

pytestmark = pytest.mark.filterwarnings("error")

NAMES = robot_names()
CLOSE = 1e-9
# Where links are stretched and the wrist next to straight on an arm with parallel axes, joint 6 is lost in rounding and
# the arm a little short: as much as the clamp of the elbow allows.
CLAMPED = 1e-6
# How far from a singular posture: exactly in it, and at every power of ten on either side.
OFFS = [0.0, *(sign * 10.0**-power for power in range(1, 16) for sign in (1.0, -1.0))]


def worst(model: RobotModel, flanges: FloatArray, near: FloatArray) -> tuple[float, int]:
    """The largest residual of all solutions (mm, or entry of the rotation), and the least number of solutions."""
    found = model.inverse_batch(flanges, near)
    missed = np.abs(model.forward(np.nan_to_num(found.joints)) - flanges[:, None]).max(axis=(2, 3))
    return float(missed[found.valid].max()), int(found.valid.sum(axis=1).min())


def drawn(rows: int, axes: int, seed: int) -> FloatArray:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (rows, axes))


@pytest.mark.parametrize("name", NAMES)
def test_every_solution_is_exact(name: str) -> None:
    model = load_robot(name)
    joints = np.random.default_rng(5).uniform(model.limits[:, 0], model.limits[:, 1], (2000, model.axes))
    residual, least = worst(model, model.forward(joints), model.home)
    assert residual <= CLOSE
    assert least >= (4 if isinstance(model.arm, OpwArm) else 2)


def bent(theta: FloatArray, joint: int, at: float) -> FloatArray:
    """One joint at each distance from a value, the others as they are."""
    theta[:, joint] = at + np.resize(OFFS, len(theta))
    return theta


def over_the_base(arm: OpwArm, theta: FloatArray) -> FloatArray:
    """Joint 2 such that the wrist centre lies that many metres from axis 1's plane through it; only where it can."""
    t3 = theta[:, 2]
    along, across = arm.c2 - arm.a2 * np.sin(t3) + arm.c3 * np.cos(t3), arm.a2 * np.cos(t3) + arm.c3 * np.sin(t3)
    sine = (1000.0 * np.resize(OFFS, len(theta)) - arm.a1) / np.hypot(along, across)
    theta[:, 1] = np.arcsin(np.clip(sine, -1.0, 1.0)) - np.arctan2(across, along)
    return theta[np.abs(sine) < 1.0]


def beside_the_shoulder(arm: UrArm, theta: FloatArray) -> FloatArray:
    """Joint 4 such that the wrist is nearly beside axis 1, where joint 1 has one solution."""
    reach = arm.a2 * np.cos(theta[:, 1]) + arm.a3 * np.cos(theta[:, 1] + theta[:, 2])
    sine = (1000.0 * np.resize(OFFS, len(theta)) - reach) / arm.d5
    theta[:, 3] = np.arcsin(np.clip(sine, -1.0, 1.0)) - theta[:, 1] - theta[:, 2]
    return theta[np.abs(sine) < 1.0]


def families(model: RobotModel, seed: int) -> dict[str, FloatArray]:
    """Postures in and around each singular family of the arm, and around two at a time."""
    arm, rows = model.arm, 10 * len(OFFS)
    if isinstance(arm, ScaraArm):
        return {"stretched": bent(drawn(rows, 4, seed), 1, 0.0), "folded": bent(drawn(rows, 4, seed), 1, np.pi)}
    if isinstance(arm, UrArm):
        found = {name: bent(drawn(rows, 6, seed), 2, at) for name, at in (("stretched", 0.0), ("folded", np.pi))}
        found["shoulder"] = beside_the_shoulder(arm, drawn(rows, 6, seed))
    else:
        assert isinstance(arm, OpwArm)
        straight = -arm.elbow_angle
        found = {
            name: bent(drawn(rows, 6, seed), 2, straight + at) for name, at in (("stretched", 0.0), ("folded", np.pi))
        }
        found["over the base"] = over_the_base(arm, drawn(rows, 6, seed))
        both = over_the_base(arm, drawn(rows, 6, seed))
        found["over the base, straight wrist"] = bent(both[np.random.default_rng(seed).permutation(len(both))], 4, 0.0)
    found["straight wrist"] = bent(drawn(rows, 6, seed), 4, 0.0)
    found["wrist turned back"] = bent(drawn(rows, 6, seed), 4, np.pi)
    stretched = found["stretched"][np.random.default_rng(seed).permutation(rows)]
    found["stretched, straight wrist"] = bent(stretched.copy(), 4, 0.0)
    return {name: theta for name, theta in found.items() if len(theta)}


def allowed(model: RobotModel, family: str) -> float:
    """The residual allowed in a family."""
    return CLAMPED if isinstance(model.arm, UrArm) and family == "stretched, straight wrist" else CLOSE


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(NAMES), st.integers(0, 2**32 - 1))
def test_solutions_are_exact_in_and_around_singular_postures(name: str, seed: int) -> None:
    model = load_robot(name)
    near = np.random.default_rng(seed).uniform(-170.0, 170.0, model.axes)
    for family, theta in families(model, seed).items():
        residual, least = worst(model, model.arm.forward(theta), near)
        assert residual <= allowed(model, family), family
        assert least >= 1 or allowed(model, family) == CLAMPED, family


@pytest.mark.parametrize("name", NAMES)
def test_solutions_are_exact_in_every_singular_family(name: str) -> None:
    model = load_robot(name)
    for family, theta in families(model, 1).items():
        assert worst(model, model.arm.forward(theta), model.home)[0] <= allowed(model, family), family


@pytest.mark.parametrize("name", [n for n in NAMES if load_robot(n).kind == "opw"])
def test_an_arm_that_is_singular_twice_is_found_where_it_stands(name: str) -> None:
    """Stretched with a straight wrist: rounding of the elbow must not turn the hand about."""
    model = load_robot(name)
    assert isinstance(model.arm, OpwArm)
    theta = drawn(500, 6, 12)
    theta[:, 2], theta[:, 4] = -model.arm.elbow_angle, 0.0
    joints = model.pendant(theta)
    found = model.inverse_batch(model.forward(joints), joints)
    off = np.abs(found.joints - joints[:, None]) % 360.0
    assert np.nanmin(np.minimum(off, 360.0 - off).max(axis=-1), axis=-1).max() < 1e-5


@pytest.mark.parametrize("name", NAMES)
def test_branches_differ_where_no_joint_is_free(name: str) -> None:
    model = load_robot(name)
    for family, theta in families(model, 3).items():
        found = model.inverse_batch(model.arm.forward(theta), model.home)
        for one, other in itertools.combinations(range(found.joints.shape[1]), 2):
            free = found.singular[:, one] | found.singular[:, other]
            both = found.valid[:, one] & found.valid[:, other] & ~free
            off = np.abs(found.joints[both, one] - found.joints[both, other]) % 360.0
            assert (np.minimum(off, 360.0 - off).max(axis=-1) > 1e-7).all(), family


def searched(model: RobotModel, flange: FloatArray, seeds: int) -> list[FloatArray]:
    """Joints that Newton's method finds from random starts, all that differ, in radians (-pi, pi]."""
    joints = np.rad2deg(drawn(seeds, 6, 9))
    for _ in range(60):
        here = model.forward(joints)
        turn = matrix_to_rotation_vector(flange[:3, :3] @ np.swapaxes(here[:, :3, :3], 1, 2))
        error = np.concatenate([flange[:3, 3] - here[:, :3, 3], turn], axis=1)
        jacobian = model.jacobian(joints)
        flat = np.swapaxes(jacobian, 1, 2)
        damping = 1e-6 * np.minimum(np.abs(error).max(axis=1), 1.0)[:, None, None] + 1e-12
        step = np.linalg.solve(flat @ jacobian + damping * np.eye(6), flat @ error[..., None])[..., 0]
        joints = joints + np.rad2deg(np.clip(step, -0.4, 0.4))
    reached = np.abs(model.forward(joints) - flange).max(axis=(1, 2)) < 1e-6
    kept: list[FloatArray] = []
    for found in model.canonical(joints[reached]):
        if not any(apart(found, other) < 1e-3 for other in kept):
            kept.append(found)
    return kept


def apart(first: FloatArray, second: FloatArray) -> float:
    """The largest difference of two joint vectors in degrees, whole turns not counted."""
    off = np.abs(first - second) % 360.0
    return float(np.minimum(off, 360.0 - off).max())


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "fanuc_m20ia", "abb_irb6640", "staubli_tx90", "puma560", "ur5e"])
def test_no_other_solver_finds_a_solution_that_is_not_among_the_branches(name: str) -> None:
    model = load_robot(name)
    postures = np.random.default_rng(2).uniform(model.limits[:, 0], model.limits[:, 1], (3, 6)) * 0.5
    for joints in postures:
        flange = model.forward(joints)
        branches = [solution.joints for solution in model.inverse(flange)]
        by_search = searched(model, flange, 300)
        assert len(by_search) >= 2
        for found in by_search:
            assert min(apart(found, branch) for branch in branches) < 1e-3
        for branch in branches:
            assert min(apart(found, branch) for found in by_search) < 1e-3


@pytest.mark.parametrize("name", [n for n in NAMES if load_robot(n).kind == "opw"])
def test_a_pose_has_the_branches_that_its_distances_allow(name: str) -> None:
    model = load_robot(name)
    arm = model.arm
    assert isinstance(arm, OpwArm)
    flanges = arm.forward(drawn(500, 6, 4))
    centre = flanges[:, :3, 3] - arm.c4 * flanges[:, :3, 2]
    ahead = np.sqrt(np.maximum(np.hypot(centre[:, 0], centre[:, 1]) ** 2 - arm.b**2, 0.0))
    fore = np.hypot(arm.a2, arm.c3)
    found = model.inverse_batch(flanges)
    for shoulder, side in ((0, ahead), (1, -ahead)):
        away = np.hypot(side - arm.a1, centre[:, 2] - arm.c1)
        within = (away < arm.c2 + fore) & (away > abs(arm.c2 - fore))
        assert (found.valid[:, 4 * shoulder : 4 * shoulder + 4] == within[:, None]).all()


@pytest.mark.parametrize("name", ["ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e"])
def test_a_straight_wrist_keeps_joint_6_where_the_arm_reaches_so_and_else_stays_nearest(name: str) -> None:
    model = load_robot(name)
    arm = model.arm
    assert isinstance(arm, UrArm)
    theta = drawn(400, 6, 8)
    theta[:, 4] = 0.0
    near = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 100.0])
    found = model.inverse_batch(arm.forward(theta), near)
    kept = np.abs(found.joints[..., 5] - 100.0) < 1e-9
    straight = np.abs(found.joints[..., 4]) < 1e-9
    assert found.valid.any(axis=1).all()
    assert (kept & straight).sum() > 500
    # Where joint 6 could not stay, the links of joints 2 and 3 are stretched or folded: it has moved no farther.
    forced = straight & ~kept & found.valid
    bend = np.abs(np.deg2rad(found.joints[..., 2][forced]))
    assert forced.any()
    assert np.minimum(bend, np.pi - bend).max() < 1e-5
