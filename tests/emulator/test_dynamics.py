"""Torques against hand calculation, published constants and the balance of energy; following errors against theory."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.emulator.dynamics import GRAVITY_M_S2, ArmDynamics
from rpl.emulator.following import lagged, off_path
from rpl.emulator.inertias import LAG_S, Body, inertia_matrix, together
from rpl.emulator.model import RobotModel, load_robot
from rpl.emulator.robotfile import RobotError
from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_x, rotation_y, rotation_z

G = GRAVITY_M_S2
# Upper arm 0.5 m with 10 kg in its middle, forearm 0.4 m with 6 kg in its middle; the other links weigh nothing.
TWO_LINKS = """
name = "two_links"
kind = "opw"
[geometry]
a1 = 0
a2 = 0
b = 0
c1 = 300
c2 = 500
c3 = 400
c4 = 50
{coupling}
[axes]
limits = [[-180, 180], [-180, 180], [-180, 180], [-180, 180], [-180, 180], [-180, 180]]
speeds = [100, 100, 100, 100, 100, 100]
home = [0, 0, 0, 0, 0, 0]
[dynamics]
source = "made up"
torques = [100, 40, 20, 10, 10, 10]
[[link]]
mass = 0
centre = [0, 0, 0]
[[link]]
mass = 10
centre = [250, 0, 0]
origin = [0, 0, 300]
axes = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
[[link]]
mass = 6
centre = [0, 0, 1000]
[[link]]
mass = 0
centre = [0, 0, 0]
[[link]]
mass = 0
centre = [0, 0, 0]
[[link]]
mass = 0
centre = [0, 0, 0]
"""
ANGLES = st.lists(st.floats(-170.0, 170.0), min_size=6, max_size=6).map(np.array)
RATES = st.lists(st.floats(-200.0, 200.0), min_size=6, max_size=6).map(np.array)


def robot(folder: Path, coupling: str = "") -> RobotModel:
    path = folder / "two_links.toml"
    path.write_text(TWO_LINKS.format(coupling=coupling))
    return load_robot(str(path))


@pytest.fixture(scope="module")
def two_links(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return robot(tmp_path_factory.mktemp("two"))


@pytest.fixture(scope="module")
def coupled(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    """Joint 3 of the pendant is the angle of the forearm to the horizontal."""
    return robot(tmp_path_factory.mktemp("coupled"), "joint_3_follows_joint_2 = true\nsigns = [1, 1, -1, -1, -1, -1]")


@settings(max_examples=50, deadline=None)
@given(q=ANGLES)
def test_gravity_of_two_links_is_that_of_their_levers(two_links: RobotModel, q: FloatArray) -> None:
    """A weight at the horizontal distance x from an axis turns it by m g x; the drive holds against that."""
    still = np.zeros((1, 6))
    found = ArmDynamics(two_links).torques(q[None], still, still)[0]
    s2, s23 = np.sin(np.deg2rad([q[1], q[1] + q[2]]))
    assert found[1] == pytest.approx(-G * (10 * 0.25 * s2 + 6 * (0.5 * s2 + 0.2 * s23)), abs=1e-9)
    assert found[2] == pytest.approx(-G * 6 * 0.2 * s23, abs=1e-9)
    assert found[[0, 3, 4, 5]] == pytest.approx(0.0, abs=1e-9)


@settings(max_examples=50, deadline=None)
@given(q=ANGLES, v=RATES, a=RATES)
def test_motion_of_two_links_is_the_textbooks(
    two_links: RobotModel, q: FloatArray, v: FloatArray, a: FloatArray
) -> None:
    """The equations of a planar arm of two point masses (Craig, Introduction to robotics, 6.7), axis 1 at rest."""
    for values in (v, a):
        values[[0, 3, 4, 5]] = 0.0
    q[[3, 4, 5]] = 0.0
    found = ArmDynamics(two_links).torques(q[None], v[None], a[None])[0]
    t2, t3 = np.deg2rad(q[1:3])
    (v2, v3), (a2, a3) = np.deg2rad(v[1:3]), np.deg2rad(a[1:3])
    m1, m2, l1, r1, r2 = 10.0, 6.0, 0.5, 0.25, 0.2
    c3, s3 = np.cos(t3), np.sin(t3)
    m11 = m1 * r1**2 + m2 * (l1**2 + r2**2 + 2 * l1 * r2 * c3)
    m12, m22 = m2 * (r2**2 + l1 * r2 * c3), m2 * r2**2
    first = m11 * a2 + m12 * a3 - m2 * l1 * r2 * s3 * (2 * v2 * v3 + v3**2)
    second = m12 * a2 + m22 * a3 + m2 * l1 * r2 * s3 * v2**2
    first -= G * (m1 * r1 * np.sin(t2) + m2 * (l1 * np.sin(t2) + r2 * np.sin(t2 + t3)))
    second -= G * m2 * r2 * np.sin(t2 + t3)
    assert found[1:3] == pytest.approx([first, second], rel=1e-9, abs=1e-9)


def swing(model: RobotModel, count: int = 4001) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """All joints swinging by sines for one second: times, joints, speeds, accelerations."""
    t = np.linspace(0.0, 1.0, count)[:, None]
    size, rate = np.linspace(20.0, 60.0, model.axes), np.linspace(2.0, 5.0, model.axes)
    return (
        t[:, 0],
        model.home + size * np.sin(rate * t),
        size * rate * np.cos(rate * t),
        -size * rate**2 * np.sin(rate * t),
    )


@pytest.mark.parametrize("name", ["puma560", "ur5e", "ur10e", "ur3e", "two_links", "coupled"])
def test_the_drives_work_is_the_energy_of_the_arm(name: str, request: pytest.FixtureRequest) -> None:
    model = request.getfixturevalue(name) if name in ("two_links", "coupled") else load_robot(name)
    load = Body(3.0, np.array([20.0, -10.0, 80.0]), inertia_matrix((0.02, 0.03, 0.01, 0.002, 0.0, 0.001)))
    dynamics = ArmDynamics(model, load)
    times, joints, speeds, accelerations = swing(model)
    power = (dynamics.torques(joints, speeds, accelerations) * np.deg2rad(speeds)).sum(axis=1)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(times))])
    energy = dynamics.energy(joints, speeds)
    assert np.ptp(energy) > 1.0
    assert work == pytest.approx(energy - energy[0], abs=1e-4 * np.ptp(energy))


@settings(max_examples=30, deadline=None)
@given(q=ANGLES, v=RATES, a=RATES, mass=st.floats(0.1, 20.0))
def test_a_load_adds_torque_in_proportion(q: FloatArray, v: FloatArray, a: FloatArray, mass: float) -> None:
    model = load_robot("puma560")

    def torques(kg: float) -> FloatArray:
        load = Body(kg, np.array([10.0, 20.0, 90.0]), kg * np.diag([0.01, 0.02, 0.03]))
        return ArmDynamics(model, load).torques(q[None], v[None], a[None])[0]

    empty = ArmDynamics(model).torques(q[None], v[None], a[None])[0]
    assert torques(2.0 * mass) - empty == pytest.approx(2.0 * (torques(mass) - empty), rel=1e-9, abs=1e-8)
    dynamics = ArmDynamics(model, Body(mass, np.zeros(3), np.zeros((3, 3))))
    dynamics.carry(None)
    assert dynamics.torques(q[None], v[None], a[None])[0] == pytest.approx(empty, abs=1e-12)


@pytest.mark.parametrize("name", ["puma560", "ur5e", "coupled"])
def test_the_load_is_lifted_where_the_flange_is(name: str, request: pytest.FixtureRequest) -> None:
    """The rigid bodies move as the kinematics do: a kilogram's potential energy is its height."""
    model = request.getfixturevalue(name) if name == "coupled" else load_robot(name)
    joints = np.random.default_rng(3).uniform(-170.0, 170.0, (20, 6))
    still = np.zeros_like(joints)
    centre = np.array([30.0, -40.0, 120.0, 1.0])
    loaded = ArmDynamics(model, Body(1.0, centre[:3], np.zeros((3, 3)))).energy(joints, still)
    empty = ArmDynamics(model).energy(joints, still)
    heights = (model.forward(joints) @ centre)[:, 2] / 1000.0
    assert loaded - empty == pytest.approx(G * heights, abs=1e-9)


def test_gravity_constants_of_the_puma_are_the_published_ones() -> None:
    """Armstrong, Khatib, Burdick 1986, appendix A6, constants of the gravity terms in N m: of cos(t2) 37.2, of
    sin(t2 + t3) 8.44, of sin(t2) 1.02, of cos(t2 + t3) 0.249; joints 4 to 6 at zero. 4 % for the last digits."""
    model = load_robot("puma560")
    dynamics, still = ArmDynamics(model), np.zeros((1, 6))

    def held(second: float, third: float) -> FloatArray:
        return dynamics.torques(np.array([[0.0, second, third, 0.0, 0.0, 0.0]]), still, still)[0]

    assert held(0.0, 0.0)[1] - held(0.0, 0.0)[2] == pytest.approx(37.2, rel=0.01)
    assert abs(held(90.0, 0.0)[1] - held(90.0, 0.0)[2]) == pytest.approx(1.02, rel=0.04)
    assert abs(held(0.0, 90.0)[2]) == pytest.approx(8.44, rel=0.02)
    assert abs(held(0.0, 0.0)[2]) == pytest.approx(0.249, rel=0.04)


@pytest.mark.parametrize("name", ["ur3e", "ur5e", "ur10e"])
def test_frames_of_the_links_are_those_of_the_dh_parameters(name: str) -> None:
    """The file writes the frames out; here they are multiplied from the arm's lengths (standard DH, all angles 0)."""
    import tomllib
    from importlib import resources

    data = tomllib.loads((resources.files("rpl.robots") / f"{name}.toml").read_text("utf-8"))
    sizes = data["geometry"]
    frame = np.eye(4)
    rows = zip(
        (sizes["d1"], 0, 0, sizes["d4"], sizes["d5"], sizes["d6"]),
        (0, sizes["a2"], sizes["a3"], 0, 0, 0),
        (90, 0, 0, 90, -90, 0),
        data["link"],
        strict=True,
    )
    for d, a, twist, link in rows:
        frame = frame @ pose_matrix(np.array([a, 0.0, d]), rotation_x(np.deg2rad(twist)))
        assert link["origin"] == pytest.approx(frame[:3, 3].tolist(), abs=1e-6)
        turn = np.array(link["axes"]).T
        assert turn == pytest.approx(frame[:3, :3], abs=1e-9)


def test_gravity_of_a_stretched_arm_by_hand() -> None:
    """UR5e stretched out level: each mass at its distance from the shoulder."""
    still = np.zeros((1, 6))
    found = ArmDynamics(load_robot("ur5e")).torques(still, still, still)[0]
    levers = 8.058 * 0.2125 + 2.846 * (0.425 + 0.3922 - 0.15) + (1.37 + 1.3 + 0.365) * (0.425 + 0.3922)
    assert found[1] == pytest.approx(-G * levers, rel=1e-9)


def test_bodies_together_have_one_centre() -> None:
    """Two kilograms 200 mm apart: 2 kg in the middle, 2 * 0.1^2 kg m2 about it, across their line."""
    point = np.zeros((3, 3))
    both = together((Body(1.0, np.array([0.0, 0.0, 0.0]), point), Body(1.0, np.array([200.0, 0.0, 0.0]), point)))
    assert both.mass == 2.0
    assert both.centre.tolist() == [100.0, 0.0, 0.0]
    assert both.inertia == pytest.approx(np.diag([0.0, 0.02, 0.02]))


def test_a_turned_body_keeps_its_principal_inertias() -> None:
    body = Body(2.0, np.array([10.0, 0.0, 0.0]), np.diag([1.0, 2.0, 3.0]))
    turn = rotation_z(0.3) @ rotation_y(0.5)
    seen = body.seen_from(pose_matrix(np.array([1.0, 2.0, 3.0]), turn))
    assert np.linalg.eigvalsh(seen.inertia) == pytest.approx([1.0, 2.0, 3.0])
    assert seen.centre == pytest.approx(np.array([1.0, 2.0, 3.0]) + 10.0 * turn[:, 0])


URDF = """<robot name="pendulum"><link name="base"/>
<link name="upper"><inertial><origin xyz="0.25 0 0"/><mass value="10"/>
  <inertia ixx="0" iyy="0.3" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="lower"><inertial><origin xyz="0.2 0 0"/><mass value="6"/>
  <inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hook"><inertial><origin xyz="0 0 0"/><mass value="1"/>
  <inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="tool0"/>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 -1 0"/>
  <limit lower="-3" upper="3" velocity="1" effort="90"/></joint>
<joint name="b" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/><axis xyz="0 -1 0"/>
  <limit lower="-3" upper="3" velocity="1" effort="0"/></joint>
<joint name="c" type="fixed"><parent link="lower"/><child link="hook"/><origin xyz="0.4 0 0"/></joint>
<joint name="d" type="fixed"><parent link="lower"/><child link="tool0"/><origin xyz="0.4 0 0"/></joint>
</robot>"""


@pytest.mark.parametrize("masses", [True, False])
def test_a_urdf_brings_its_masses(tmp_path: Path, masses: bool) -> None:
    """Level from rest: m g x at each axis, the hook a part of the link that carries it; 0 is no known effort."""
    import re

    path = tmp_path / "pendulum.urdf"
    path.write_text(URDF if masses else re.sub("<inertial>.*?</inertial>", "", URDF, flags=re.S))
    model = load_robot(str(path))
    if not masses:
        assert model.inertias is None
        return
    assert model.inertias is not None
    assert model.inertias.torques is not None
    assert model.inertias.torques.tolist() == [90.0, 0.0]
    joints, still = np.array([[0.0, 0.0], [90.0, 0.0], [60.0, -60.0]]), np.zeros((3, 2))
    found = ArmDynamics(model).torques(joints, still, still)
    lower = G * (6 * 0.2 + 1 * 0.4)
    assert found[0] == pytest.approx([G * (10 * 0.25 + 7 * 0.5) + lower, lower])
    assert found[1] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert found[2] == pytest.approx([0.5 * G * (10 * 0.25 + 7 * 0.5) + lower, lower])


SIX = [
    ("0 0 0", "0 0 1"),
    ("0.1 0 0.3", "0 1 0"),
    ("0 0 0.5", "0 -1 0"),
    ("0.4 0 0.05", "-1 0 0"),
    ("0 0 0", "0 1 0"),
    ("0 0 0", "1 0 0"),
]


def six_axis_urdf() -> str:
    """A bent arm at zero, with signs of its own, every link with a mass beside its axis."""
    parts = ['<robot name="six"><link name="l0"/>']
    for n, (origin, axis) in enumerate(SIX, start=1):
        parts.append(
            f'<link name="l{n}"><inertial><origin xyz="0.0{n} 0.02 0.1"/><mass value="{7 - n}"/>'
            f'<inertia ixx="0.0{n}" iyy="0.02" izz="0.03" ixy="0.001" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{n}" type="revolute"><parent link="l{n - 1}"/><child link="l{n}"/>'
            f'<origin xyz="{origin}"/><axis xyz="{axis}"/>'
            '<limit lower="-3" upper="3" velocity="2" effort="10"/></joint>'
        )
    parts.append(
        '<link name="tool0"/><joint name="t" type="fixed"><parent link="l6"/><child link="tool0"/>'
        '<origin xyz="0.1 0 0" rpy="0 1.5707963267948966 0"/></joint></robot>'
    )
    return "".join(parts)


def test_torques_of_a_recognised_urdf_arm_are_those_of_the_urdf(tmp_path: Path) -> None:
    """Its closed form has other zeros and signs than the URDF, on which Pinocchio itself is asked."""
    import pinocchio as pin

    path = tmp_path / "six.urdf"
    path.write_text(six_axis_urdf())
    model = load_robot(str(path))
    assert model.kind == "opw"
    urdf = pin.buildModelFromXML(path.read_text())
    random = np.random.default_rng(5)
    joints, speeds, accelerations = random.uniform(-120.0, 120.0, (3, 10, 6))
    found = ArmDynamics(model).torques(joints, speeds, accelerations)
    data = urdf.createData()
    for row in range(len(joints)):
        asked = (np.deg2rad(values[row]) for values in (joints, speeds, accelerations))
        assert found[row] == pytest.approx(pin.rnea(urdf, data, *asked), rel=1e-5, abs=1e-5)


def test_an_arm_without_inertias_is_refused() -> None:
    with pytest.raises(RobotError, match="no inertias in the robot file"):
        ArmDynamics(load_robot("kuka_kr6r900sixx"))


WRONG = [
    ("mass = 10\n", "mass = -1\n", "wrong.toml:24: 'mass' must be a number of at least 0"),
    ("mass = 10\n", 'mass = "heavy"\n', "wrong.toml:24: 'mass' must be a number"),
    ("centre = [250, 0, 0]", "centre = [250, 0]", "wrong.toml:25: 'centre' must be a list of 3 numbers"),
    ("[-1, 0, 0]]", "[1, 0, 0]]", "wrong.toml:27: 'axes' must be three unit vectors"),
    (
        "centre = [0, 0, 1000]",
        "centre = [0, 0, 1000]\ninertia = [1, -1, 1, 0, 0, 0]",
        "wrong.toml:31: 'inertia' must be six",
    ),
    ("torques = [100, 40,", "torques = [100, -40,", "'torques' must be a list of numbers of at least 0"),
    ('source = "made up"\n', "", "'source' must be a text"),
    ("[[link]]\nmass = 0\ncentre = [0, 0, 0]\n[[link]]\nmass = 10", "[[link]]\nmass = 10", "one [[link]] for each"),
    ("home = [0,", "lag = [0.1, 0, 0, 0, 0, -1]\nhome = [0,", "'lag' must be a list of numbers of at least 0"),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_wrong_weights_are_named_with_their_place(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = TWO_LINKS.format(coupling="")
    assert old in text
    path = tmp_path / "wrong.toml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(RobotError) as error:
        load_robot(str(path))
    assert said in str(error.value)


# ---- following


@given(speed=st.floats(-300.0, 300.0), lag=st.floats(0.001, 0.1), step=st.sampled_from([0.001, 0.004, 0.012]))
def test_a_joint_at_constant_speed_is_behind_by_speed_times_lag(speed: float, lag: float, step: float) -> None:
    times = np.arange(0.0, 2.0, step)
    command = (speed * times)[:, None]
    behind = (command - lagged(times, command, lag))[:, 0]
    assert behind == pytest.approx(speed * lag * (1.0 - np.exp(-times / lag)), abs=1e-9)
    assert behind[-1] == pytest.approx(speed * lag, rel=1e-6)


@given(seed=st.integers(0, 10_000), lag=st.floats(0.005, 0.2))
def test_more_samples_of_the_same_command_change_nothing(seed: int, lag: float) -> None:
    """The lag is solved exactly for commands that run straight between their samples."""
    random = np.random.default_rng(seed)
    times = np.cumsum(random.uniform(0.001, 0.05, 30))
    joints = np.cumsum(random.normal(size=(30, 2)), axis=0)
    fine = np.sort(np.concatenate([times, np.linspace(times[0], times[-1], 57)]))
    between = np.stack([np.interp(fine, times, joint) for joint in joints.T], axis=1)
    rows = np.searchsorted(fine, times)
    assert lagged(fine, between, lag)[rows] == pytest.approx(lagged(times, joints, lag), abs=1e-9)


def test_a_stopped_joint_arrives() -> None:
    times = np.array([0.0, 0.5, 2.0])
    late = lagged(times, np.array([[0.0], [100.0], [100.0]]), np.array([0.05]))
    assert late[1, 0] == pytest.approx(90.0, abs=1e-2)
    assert late[2, 0] == pytest.approx(100.0, abs=1e-6)


def test_without_a_lag_joints_are_where_they_should_be() -> None:
    joints = np.array([[0.0], [5.0]])
    assert lagged(np.array([0.0, 1.0]), joints, 0.0) == pytest.approx(joints)


def test_being_late_is_not_being_off_the_path() -> None:
    way = np.stack([np.linspace(0.0, 100.0, 101), np.zeros(101), np.zeros(101)], axis=1)
    late = np.maximum(way - np.array([7.5, 0.0, 0.0]), 0.0)
    assert off_path(way, late, 20) == pytest.approx(np.zeros(101), abs=1e-12)
    beside = late + np.array([0.0, 2.0, 0.0])
    assert off_path(way, beside, 20) == pytest.approx(np.full(101, 2.0))


def test_the_assumed_lag_is_a_position_loop_of_50() -> None:
    """M: drives are tuned between 20 and 100 1/s."""
    gain = 1.0 / LAG_S
    assert gain == pytest.approx(50.0)
