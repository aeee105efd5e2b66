"""Arms from URDF: recognised where a closed form fits, solved by iteration where none does."""

from pathlib import Path

import numpy as np
import pytest

from rpl.emulator.model import RobotError, RobotModel, load_robot
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray

pin = pytest.importorskip("pinocchio")

Joint = tuple[str, str, str, str]
# Laid out as the ROS-Industrial descriptions of these arms are: type, axis, origin xyz, origin rpy.
KUKA: list[Joint] = [
    ("revolute", "0 0 -1", "0 0 0.4", "0 0 0"),
    ("revolute", "0 1 0", "0.025 0 0", "0 0 0"),
    ("revolute", "0 1 0", "0.455 0 0", "0 0 0"),
    ("revolute", "-1 0 0", "0 0 0.035", "0 0 0"),
    ("revolute", "0 1 0", "0.42 0 0", "0 0 0"),
    ("continuous", "-1 0 0", "0.08 0 0", "0 0 0"),
]
TILTED: list[Joint] = [("revolute", "0 0 -1", "0.1 -0.2 0.4", "0.5 0.2 1.0"), *KUKA[1:]]
OFFSET_WRIST: list[Joint] = [
    *KUKA[:4],
    ("revolute", "0 1 0", "0.42 0.03 0.02", "0 0 0"),
    ("revolute", "-1 0 0", "0.08 0 0.04", "0 0 0"),
]
SEVEN: list[Joint] = [
    ("revolute", "0 0 1", "0 0 0.3", "0 0 0"),
    ("revolute", "0 1 0", "0 0 0", "0 0 0"),
    ("revolute", "0 0 1", "0 0 0.3", "0 0 0"),
    ("revolute", "0 -1 0", "0 0 0.1", "0 0 0"),
    ("revolute", "0 0 1", "0 0 0.3", "0 0 0"),
    ("revolute", "0 1 0", "0 0 0.1", "0 0 0"),
    ("revolute", "0 0 1", "0 0 0.1", "0 0 0"),
]
ON_RAIL: list[Joint] = [("prismatic", "0 1 0", "0 0 0", "0 0 0"), *KUKA]


def written(folder: Path, joints: list[Joint]) -> Path:
    """A URDF with a gripper finger beside the arm and a tool frame turned to z forward."""
    parts = ['<robot name="arm"><link name="link0"/>']
    for i, (kind, axis, xyz, rpy) in enumerate(joints, start=1):
        low, high = (-1.5, 1.5) if kind == "prismatic" else (-2.9, 2.9)
        parts.append(
            f'<link name="link{i}"/><joint name="j{i}" type="{kind}"><origin xyz="{xyz}" rpy="{rpy}"/>'
            f'<parent link="link{i - 1}"/><child link="link{i}"/><axis xyz="{axis}"/>'
            f'<limit effort="0" velocity="3" lower="{low}" upper="{high}"/></joint>'
        )
    last = f"link{len(joints)}"
    parts.append(
        f'<link name="tool0"/><joint name="end" type="fixed"><origin xyz="0 0 0" rpy="0 {np.pi / 2!r} 0"/>'
        f'<parent link="{last}"/><child link="tool0"/></joint>'
        f'<link name="finger"/><joint name="grip" type="prismatic"><origin xyz="0 0 0.1"/><parent link="{last}"/>'
        '<child link="finger"/><axis xyz="0 0 1"/><limit effort="0" velocity="1" lower="0" upper="0.1"/></joint>'
        "</robot>"
    )
    path = folder / "arm.urdf"
    path.write_text("".join(parts))
    return path


def pinocchio_flanges(path: Path, model: RobotModel, joints: FloatArray) -> FloatArray:
    whole = pin.buildModelFromXML(path.read_text().replace("continuous", "revolute"))
    data, poses = whole.createData(), []
    for q in joints:
        configuration = np.zeros(whole.nq)
        for i, (value, kind) in enumerate(zip(q, model.joint_kinds, strict=True), start=1):
            at = whole.joints[whole.getJointId(f"j{i}")].idx_q
            configuration[at] = np.deg2rad(value) if kind == "revolute" else value / 1000.0
        pin.framesForwardKinematics(whole, data, configuration)
        pose = data.oMf[whole.getFrameId("tool0")].homogeneous.copy()
        pose[:3, 3] *= 1000.0
        poses.append(pose)
    return np.array(poses)


@pytest.mark.parametrize(
    ("joints", "kind"),
    [(KUKA, "opw"), (TILTED, "opw"), (OFFSET_WRIST, "chain"), (SEVEN, "chain"), (ON_RAIL, "chain")],
)
def test_reaches_what_pinocchio_says(tmp_path: Path, joints: list[Joint], kind: str) -> None:
    path = written(tmp_path, joints)
    model = load_robot(str(path))
    assert (model.kind, model.axes) == (kind, len(joints))
    rng = np.random.default_rng(3)
    samples = 0.8 * rng.uniform(model.limits[:, 0], model.limits[:, 1], (12, model.axes))
    flanges = model.forward(samples)
    assert flanges == pytest.approx(pinocchio_flanges(path, model, samples), abs=1e-6)
    for flange, near in zip(flanges, samples, strict=True):
        solutions = model.inverse(flange, near + 3.0)
        assert solutions
        assert all(np.abs(model.forward(s.joints) - flange).max() < 1e-5 for s in solutions)
    assert model.jacobian(samples).shape == (12, 6, model.axes)


def test_recognised_arm_is_the_packaged_one(tmp_path: Path) -> None:
    """The KUKA layout read from a URDF and the packaged file agree in pose and in posture."""
    urdf, packaged = load_robot(str(written(tmp_path, KUKA))), load_robot("kuka_kr6r900sixx")
    for joints in np.random.default_rng(5).uniform(-100, 100, (20, 6)):
        assert urdf.forward(joints) == pytest.approx(packaged.forward(joints), abs=1e-6)
        assert urdf.posture(joints) == packaged.posture(joints)


def test_endless_joint_becomes_two_turns(tmp_path: Path) -> None:
    model = load_robot(str(written(tmp_path, KUKA)))
    assert model.limits[5] == pytest.approx([-360, 360])


@pytest.mark.parametrize("joints", [SEVEN, OFFSET_WRIST, ON_RAIL])
def test_lines_with_an_arm_without_closed_form(tmp_path: Path, joints: list[Joint]) -> None:
    model = load_robot(str(written(tmp_path, joints)))
    start = np.full(model.axes, 20.0)
    goal = model.forward(start)
    goal[:3, 3] += [-30, 20, -40]
    move = plan(model, start, MoveRequest("linear", target_pose=goal))
    assert isinstance(move, PlannedMove)
    samples = move.sample(20)
    assert model.forward(samples.joints) == pytest.approx(samples.tcp, abs=1e-5)


def test_far_targets_are_found_from_the_seeds_and_the_same_way_each_time(tmp_path: Path) -> None:
    model = load_robot(str(written(tmp_path, SEVEN)))
    flange = model.forward([100, -60, 80, 90, -110, 70, 30])
    first, second = (model.inverse(flange, model.home) for _ in range(2))
    assert first[0].joints.tolist() == second[0].joints.tolist()
    assert model.inverse(flange + np.array([[0, 0, 0, 5000]] + [[0] * 4] * 3)) == ()


def test_a_robot_file_may_describe_a_urdf(tmp_path: Path) -> None:
    written(tmp_path, SEVEN)
    robot = tmp_path / "mine.toml"
    robot.write_text(
        'name = "mine"\nkind = "chain"\n[geometry]\nurdf = "arm.urdf"\nsigns = [-1, 1, 1, 1, 1, 1, 1]\n[axes]\n'
        f"limits = {[[-90, 90]] * 7}\nspeeds = {[100] * 7}\nhome = {[0] * 7}\n"
    )
    model, bare = load_robot(str(robot)), load_robot(str(tmp_path / "arm.urdf"))
    assert model.limits[0].tolist() == [-90, 90]
    assert model.forward([30, 20, 10, 40, 0, 0, 0]) == pytest.approx(bare.forward([-30, 20, 10, 40, 0, 0, 0]))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<robot", "no URDF"),
        ('<robot name="r"><link name="a"/></robot>', "no moving joint"),
    ],
)
def test_bad_urdf(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bad.urdf"
    path.write_text(text)
    with pytest.raises(RobotError, match=message):
        load_robot(str(path))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("kind = [", "bad.toml"),
        ('kind = "delta"', "must be one of"),
        ('kind = "opw"', "'axes' must be a table"),
        ('name = "x"\nkind = "ur"\n[geometry]\nd1 = 1\n[axes]\nhome = [0, 0]', "'a2' must be a number"),
        ('name = "x"\nkind = "chain"\n[geometry]\n[axes]\nhome = [0, 0]', "needs 'urdf'"),
    ],
)
def test_bad_robot_file(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(RobotError, match=message):
        load_robot(str(path))
    with pytest.raises(RobotError, match="cannot be read"):
        load_robot(str(tmp_path / "missing.toml"))
