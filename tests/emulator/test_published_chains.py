"""Forward kinematics against URDF models that owe nothing to the closed forms.

Most arms have a published description: its joint axes, kept as numbers in `data/published_chains.txt`, are written as a
URDF and moved by Pinocchio. Every arm, those without such a description too, is also built as a URDF from its file's
lengths, one joint after the other: the pendant's signs are directions of axes, its offsets turns of the frames.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from rpl.emulator.model import load_robot, robot_names
from rpl.emulator.robotfile import RobotFile, read_robot_file
from rpl.emulator.rotations import FloatArray

pin = pytest.importorskip("pinocchio")

TABLE = Path(__file__).parent / "data" / "published_chains.txt"
DIRECTIONS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
POSTURES = 200
CLOSE_MM = 1e-6
CLOSE_TURN = 1e-9

Numbers = tuple[float, ...]


@dataclass(frozen=True)
class Joint:
    """A place in the frame of the joint before (mm, degrees about fixed axes) and a direction; None: fixed."""

    place: Numbers
    turn: Numbers = (0.0, 0.0, 0.0)
    axis: Numbers | None = None
    kind: str = "revolute"


def urdf(joints: list[Joint]) -> str:
    """A URDF of links in a row, the last one named `tip`."""
    parts = ['<robot name="arm"><link name="link0"/>']
    for i, joint in enumerate(joints, start=1):
        xyz = " ".join(repr(value / 1000.0) for value in joint.place)
        rpy = " ".join(repr(float(np.deg2rad(value))) for value in joint.turn)
        axis = "" if joint.axis is None else f'<axis xyz="{" ".join(map(str, joint.axis))}"/>'
        child = "tip" if i == len(joints) else f"link{i}"
        parts.append(
            f'<link name="{child}"/><joint name="j{i}" type="{"fixed" if joint.axis is None else joint.kind}">'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><parent link="link{i - 1}"/><child link="{child}"/>{axis}'
            '<limit lower="-9" upper="9" effort="0" velocity="1"/></joint>'
        )
    return "".join([*parts, "</robot>"])


def poses(joints: list[Joint], values: FloatArray) -> FloatArray:
    """Poses (k, 4, 4) of the tip in mm for joint values (k, n) in radians and mm."""
    model = pin.buildModelFromXML(urdf(joints))
    data, tip, found = model.createData(), model.getFrameId("tip"), []
    scale = np.array([0.001 if j.kind == "prismatic" else 1.0 for j in joints if j.axis is not None])
    for row in values * scale:
        pin.framesForwardKinematics(model, data, row)
        found.append(data.oMf[tip].homogeneous.copy())
        found[-1][:3, 3] *= 1000.0
    return np.array(found)


def published() -> dict[str, tuple[list[Joint], bool]]:
    """The table: joints with the flange at the end, and whether the tip is the controller's flange."""
    chains = {}
    for line in TABLE.read_text("utf-8").splitlines():
        if not line or line.startswith("#"):
            continue
        name, *cells = (cell.strip() for cell in line.split("|"))
        joints = []
        for cell in cells:
            place, _, turn = cell.partition("/")
            words = place.split()
            axis = None
            if words[0][-1] in DIRECTIONS:
                sign = -1.0 if words[0][0] == "-" else 1.0
                axis = tuple(sign * value for value in DIRECTIONS[words.pop(0)[-1]])
            joints.append(Joint(tuple(map(float, words)), tuple(map(float, turn.split())) or (0.0, 0.0, 0.0), axis))
        chains[name.removeprefix("~")] = joints, not name.startswith("~")
    return chains


def moved(file: RobotFile, joints: FloatArray) -> FloatArray:
    """What the mechanism's joints do: a forearm that the pendant counts from the horizontal turns with joint 2."""
    turned = joints.copy()
    if file.joint_3_follows_joint_2:
        turned[:, 2] += turned[:, 1]
    return turned


def postures(name: str) -> tuple[FloatArray, FloatArray, RobotFile]:
    """Joints inside the limits, their flange poses by the closed form, and the robot file."""
    model = load_robot(name)
    joints = np.random.default_rng(11).uniform(model.limits[:, 0], model.limits[:, 1], (POSTURES, model.axes))
    return joints, model.forward(joints), read_robot_file(name)


@pytest.mark.parametrize("name", sorted(published()))
def test_forward_agrees_with_the_published_description(name: str) -> None:
    chain, is_flange = published()[name]
    joints, flanges, file = postures(name)
    found = poses(chain, np.deg2rad(moved(file, joints)))
    if file.origin_at_axis_2:
        found[:, 2, 3] -= file.lengths["c1"]
    assert np.abs(found[:, :3, 3] - flanges[:, :3, 3]).max() < CLOSE_MM
    between = np.swapaxes(found[:, :3, :3], 1, 2) @ flanges[:, :3, :3]
    expected = np.eye(3) if is_flange else between[0]
    # Published right angles are rounded to seven digits in some descriptions.
    assert np.abs(between - expected).max() < CLOSE_TURN


def test_most_arms_have_a_published_description() -> None:
    assert set(published()) <= set(robot_names())
    assert len(published()) >= 45


# Height of the frame `base` of the same descriptions, mm: where the controller's own coordinates begin.
BASES = {
    "abb_irb120_3_58": 0.0,
    "fanuc_lrmate200id": 330.0,
    "fanuc_m10ia": 450.0,
    "fanuc_m710ic50": 565.0,
    "fanuc_m900ia260l": 950.0,
    "kuka_kr6r900sixx": 0.0,
    "motoman_gp12": 450.0,
    "motoman_gp25": 505.0,
    "motoman_gp7": 330.0,
    "motoman_gp8": 330.0,
    "motoman_ma2010": 505.0,
    "motoman_mh12": 450.0,
    "motoman_mh50": 540.0,
}


@pytest.mark.parametrize(("name", "height"), sorted(BASES.items()))
def test_poses_are_in_the_coordinates_of_the_controller(name: str, height: float) -> None:
    chain, _ = published()[name]
    zero = np.zeros((1, 6))
    assert poses(chain, zero)[0, 2, 3] - load_robot(name).forward(zero)[0, 2, 3] == pytest.approx(height)


def test_arms_of_one_maker_count_from_the_same_place() -> None:
    files = [read_robot_file(name) for name in robot_names()]
    assert {file.maker for file in files if file.origin_at_axis_2} == {"FANUC", "Stäubli", "Yaskawa"}
    assert all(file.origin_at_axis_2 for file in files if file.maker in ("FANUC", "Stäubli", "Yaskawa"))


def built(file: RobotFile) -> list[Joint]:
    """The arm joint by joint from its file: signs turn axes round, an offset turns the frame in front of the joint."""
    g, base = file.lengths, 0.0 if file.origin_at_axis_2 else file.lengths.get("c1", 0.0)
    y, z = DIRECTIONS["y"], DIRECTIONS["z"]
    match file.kind:
        case "opw":
            steps = [
                (z, (0.0, 0.0, base)),
                (y, (g["a1"], 0.0, 0.0)),
                (y, (0.0, 0.0, g["c2"])),
                (z, (g["a2"], g["b"], g["c3"])),
                (y, (0.0, 0.0, 0.0)),
                (z, (0.0, 0.0, 0.0)),
            ]
            end = Joint((0.0, 0.0, g["c4"]))
        case "ur":
            # All joints at zero the arm lies along -x: axes 2, 3, 4 and 6 point along -y, axis 5 down.
            back = tuple(-value for value in y)
            steps = [
                (z, (0.0, 0.0, g["d1"])),
                (back, (0.0, 0.0, 0.0)),
                (back, (g["a2"], 0.0, 0.0)),
                (back, (g["a3"], 0.0, 0.0)),
                (tuple(-value for value in z), (0.0, -g["d4"], 0.0)),
                (back, (0.0, 0.0, -g["d5"])),
            ]
            end = Joint((0.0, -g["d6"], 0.0), (90.0, 0.0, 0.0))
        case _:
            down = tuple(-value for value in z)
            steps = [
                (z, (0.0, 0.0, g["height"])),
                (z, (g["l1"], 0.0, 0.0)),
                (down, (g["l2"], 0.0, 0.0)),
                (down, (0,) * 3),
            ]
            end = Joint((0.0, 0.0, 0.0), (180.0, 0.0, 0.0))
    joints = []
    for i, ((axis, place), sign, offset) in enumerate(zip(steps, file.signs, file.offsets, strict=True)):
        sliding = file.kind == "scara" and i == 2
        # About an axis that points along a frame's negative axis, the frame turns the other way.
        turn = tuple(-offset * value for value in axis)
        moved_place = tuple(p - offset * a for p, a in zip(place, axis, strict=True)) if sliding else place
        along = tuple(sign * value for value in axis)
        kind = "prismatic" if sliding else "revolute"
        joints.append(Joint(moved_place, (0.0, 0.0, 0.0) if sliding else turn, along, kind))
    return [*joints, end]


@pytest.mark.parametrize("name", robot_names())
def test_forward_agrees_with_a_model_built_joint_by_joint(name: str) -> None:
    joints, flanges, file = postures(name)
    values = moved(file, joints)
    sliding = np.array([file.kind == "scara" and i == 2 for i in range(joints.shape[1])])
    found = poses(built(file), np.where(sliding, values, np.deg2rad(values)))
    assert np.abs(found[:, :3, 3] - flanges[:, :3, 3]).max() < CLOSE_MM
    assert np.abs(found[:, :3, :3] - flanges[:, :3, :3]).max() < CLOSE_TURN
