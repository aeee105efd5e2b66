"""Bodies of arms go with their links: by the lengths of the arm, by its robot file, or by its URDF."""

from pathlib import Path

import numpy as np
import pytest

from rpl.cell.armbodies import arm_bodies, bodies_of, link_poses
from rpl.cell.shapes import Box, Capsule, Cylinder, Mesh, Sphere, bounds_at
from rpl.emulator.model import RobotError, RobotModel, load_robot, robot_names


def postures(model: RobotModel, count: int) -> np.ndarray:
    draws = np.random.default_rng(7)
    return draws.uniform(model.limits[:, 0], model.limits[:, 1], (count, model.axes))


@pytest.mark.parametrize("name", robot_names())
def test_the_last_link_carries_the_flange(name: str) -> None:
    model = load_robot(name)
    joints = postures(model, 20)
    flange_in_link = model.arm.forward(np.zeros(model.axes))
    assert np.allclose(link_poses(model, joints)[:, -1] @ flange_in_link, model.forward(joints), atol=1e-9)


@pytest.mark.parametrize("name", robot_names())
def test_every_link_has_a_body_between_foot_and_flange(name: str) -> None:
    model = load_robot(name)
    bodies = arm_bodies(model)
    links = set(range(model.axes + 1)) - ({6} if name == "puma560" else set())  # its flange is its wrist centre
    assert {body.link for body in bodies} == links
    foot = [bounds_at(body.shape, body.at) for body in bodies if body.link == 0]
    assert min(corners[0, 2] for corners in foot) == pytest.approx(model.foot_mm)
    into_flange = np.linalg.inv(model.arm.forward(np.zeros(model.axes)))
    ends = [bounds_at(body.shape, into_flange @ body.at)[1, 2] for body in bodies if body.link == model.axes]
    assert all(end == pytest.approx(0.0, abs=1e-6) for end in ends)


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "fanuc_lrmate200id", "ur5e", "puma560", "abb_irb140"])
def test_capsules_reach_from_axis_to_axis(name: str) -> None:
    """The ends of upper arm and forearm lie on the axes of joints 2 and 3 whatever the posture."""
    model = load_robot(name)
    joints = postures(model, 10)
    poses = link_poses(model, joints)
    points, directions = model.arm.axes(model.theta(joints))
    for link, before, after in ((2, 1, 2),):
        body = next(body for body in reversed(arm_bodies(model)) if body.link == link)
        assert isinstance(body.shape, Capsule)
        placed = poses[:, link] @ body.at
        for end, axis in ((-0.5, before), (0.5, after)):
            tip = placed[:, :3, 3] + placed[:, :3, 2] * body.shape.length * end
            off = np.cross(tip - points[:, axis], directions[:, axis])
            assert np.abs(off).max() < 1e-9


OWN = """\
name = "arm"
kind = "scara"

[geometry]
l1 = 325
l2 = 275
height = 387

[axes]
limits = [[-105, 105], [-150, 150], [0, 210], [-360, 360]]
speeds = [386, 720, 1100, 1200]
home = [0, 0, 0, 0]

[[body]]
link = 2
radius = 55
from = [325, 0, 450]
to = [600, 0, 450]

[[body]]
link = 2
radius = 80
from = [600, 0, 500]
"""


def test_a_robot_file_gives_bodies_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text(OWN, encoding="utf-8")
    model = load_robot(str(tmp_path / "arm.toml"))
    second = [body for body in arm_bodies(model) if body.link == 2]
    assert [body.shape for body in second] == [Capsule(110.0, 275.0), Sphere(160.0)]
    assert np.allclose(bounds_at(second[0].shape, second[0].at), [[270, -55, 395], [655, 55, 505]])
    assert bodies_of(model).source == "those of its robot file"
    assert {body.link for body in arm_bodies(model)} == {0, 1, 2, 3, 4}


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("link = 2\nradius = 55", "link = 5\nradius = 55", 15, "'link' must be the number of a joint"),
        ("link = 2\nradius = 55", "link = true\nradius = 55", 15, "'link' must be the number of a joint"),
        ("radius = 55", "radius = 0", 16, "'radius' must be a number of mm above 0, found 0"),
        ("radius = 80", "", 20, "'radius' must be a number, found nothing"),
        ("from = [325, 0, 450]", "", 14, "'from' must be a list of 3 numbers, found nothing"),
        ("to = [600, 0, 450]", "to = [600, 0]", 18, "'to' must be a list of 3 numbers, found [600, 0]"),
        ("to = [600, 0, 450]", "too = [600, 0, 450]", 18, "'too' is not known here: did you mean 'to'?"),
        ("to = [600, 0, 450]", "to = [6e8, 0, 450]", 18, "'to' must be three numbers of at most 1,000,000"),
    ],
)
def test_wrong_bodies_are_refused_with_line_and_key(
    tmp_path: Path, old: str, new: str, line: int, message: str
) -> None:
    assert OWN.count(old) == 1
    path = tmp_path / "arm.toml"
    path.write_text(OWN.replace(old, new), encoding="utf-8")
    with pytest.raises(RobotError) as caught:
        load_robot(str(path))
    assert f"arm.toml:{line}: " in str(caught.value)
    assert message in str(caught.value)


URDF = """\
<robot name="two">
  <link name="base_link">
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.3 0.3 0.2"/></geometry></collision>
  </link>
  <link name="arm">
    <visual><geometry>
      <mesh filename="package://two_support/meshes/arm.stl" scale="0.001 0.001 0.001"/>
    </geometry></visual>
  </link>
  <link name="cover">
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <link name="hand">
    <visual><geometry><mesh filename="meshes/hand.stl"/></geometry></visual>
    <collision><origin xyz="0 0 0.05" rpy="0 1.5707963267948966 0"/>
      <geometry><cylinder radius="0.04" length="0.1"/></geometry></collision>
  </link>
  <link name="tool0"/>
  <joint name="turn" type="revolute"><parent link="base_link"/><child link="arm"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="held" type="fixed"><parent link="arm"/><child link="cover"/><origin xyz="0.2 0 0"/></joint>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="hand"/>
    <origin xyz="0.4 0 0"/><axis xyz="0 0 1"/><limit lower="0" upper="0.3" velocity="1" effort="1"/></joint>
  <joint name="flange" type="fixed"><parent link="hand"/><child link="tool0"/><origin xyz="0 0 0.1"/></joint>
</robot>
"""


def stl(corners: np.ndarray) -> str:
    """A tetrahedron over the origin as text."""
    lines = ["solid one"]
    points = [np.zeros(3), *corners]
    for three in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*points[number]) for number in three]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid one", ""])


def urdf_arm(folder: Path) -> RobotModel:
    support = folder / "two_support"
    (support / "urdf").mkdir(parents=True)
    (support / "meshes").mkdir()
    (support / "meshes" / "arm.stl").write_text(stl(np.diag([300.0, 100.0, 50.0])), encoding="utf-8")
    (support / "urdf" / "two.urdf").write_text(URDF, encoding="utf-8")
    return load_robot(str(support / "urdf" / "two.urdf"))


def test_a_urdf_brings_its_forms_and_meshes(tmp_path: Path) -> None:
    model = urdf_arm(tmp_path)
    bodies = arm_bodies(model)
    assert [(body.link, type(body.shape)) for body in bodies] == [(0, Box), (1, Mesh), (1, Sphere), (2, Cylinder)]
    box, arm, cover, hand = bodies
    assert np.allclose(bounds_at(box.shape, box.at), [[-150, -150, 0], [150, 150, 200]])
    assert np.allclose(bounds_at(arm.shape, arm.at), [[0, 0, 200], [300, 100, 250]])
    assert np.allclose(cover.at[:3, 3], [200, 0, 200])
    # With the collision form the visual mesh, which is not there, is not asked for.
    assert bodies_of(model).notes == ()
    poses = link_poses(model, np.array([[90.0, 250.0]]))
    assert np.allclose((poses[0, 2] @ hand.at)[:3, 3], [0, 400, 200 + 250 + 50])
    assert np.allclose((poses[0, 1] @ cover.at)[:3, 3], [0, 200, 200])


@pytest.mark.parametrize(
    ("content", "note"),
    [
        (None, "two.urdf: link 'arm': the mesh 'package://two_support/meshes/arm.stl' is in no folder 'two_support'"),
        ("nothing of a mesh", "two.urdf: link 'arm': the mesh 'arm.stl' cannot be read"),
    ],
)
def test_a_mesh_that_cannot_be_had_leaves_the_capsule(tmp_path: Path, content: str | None, note: str) -> None:
    urdf_arm(tmp_path)
    mesh = tmp_path / "two_support" / "meshes" / "arm.stl"
    mesh.unlink()
    if content is not None:
        mesh.write_text(content, encoding="utf-8")
    found = bodies_of(load_robot(str(tmp_path / "two_support" / "urdf" / "two.urdf")))
    assert len(found.notes) == 1
    assert found.notes[0].startswith(note)
    assert [(body.link, type(body.shape)) for body in found.bodies if body.link == 1] == [(1, Sphere), (1, Capsule)]


def test_a_urdf_without_forms_has_capsules_from_joint_to_joint(tmp_path: Path) -> None:
    path = tmp_path / "bare.urdf"
    path.write_text(
        URDF.replace("<collision>", "<!--").replace("</collision>", "-->").replace("<visual>", "<!--")
        .replace("</visual>", "-->"),
        encoding="utf-8",
    )  # fmt: skip
    found = bodies_of(load_robot(str(path)))
    assert "assumption" in found.source
    assert {body.link for body in found.bodies} == {0, 1, 2}
