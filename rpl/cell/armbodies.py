"""The bodies of an arm: capsules along its links, those that its robot file gives, or the meshes of its URDF.

Each body is rigid to a link: link 0 stands still, link i is what joint i moves. The frame of every link is the base
frame at the posture where all the arm's own joint variables are zero (theta = 0: an `opw` arm straight up, a `ur` arm
stretched out level), so that points of a body are given as they lie in the arm then; `link_poses` carries them from
there. Where the capsules lie follows from the lengths of the arm. How thick they are is nowhere published for all arms:
it is worked out of reach and payload (`THICKNESS`), an assumption.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rpl.cell.shapes import Capsule, Cylinder, Shape, Sphere
from rpl.cell.urdfbodies import urdf_bodies
from rpl.emulator.arms import OpwArm, ScaraArm, UrArm
from rpl.emulator.recognise import PlacedArm
from rpl.emulator.rotations import FloatArray, pose_matrix

if TYPE_CHECKING:
    from rpl.emulator.arms import Arm
    from rpl.emulator.model import RobotModel

# Radius in mm = factor * 1000 * reach^power * payload^power, reach of the wrist in m and payload in kg: of the foot, of
# what turns on it, of upper arm, forearm, wrist and flange. Fitted to the hulls of the collision meshes of 37 arms as
# published by ROS-Industrial (capsules of equal volume); the standard deviation is 11 to 18 %, 25 % for the flange.
THICKNESS = {
    "foot": (0.101, 0.35, 0.18),
    "column": (0.076, 0.45, 0.18),
    "upper": (0.054, -0.04, 0.25),
    "fore": (0.056, 0.38, 0.16),
    "wrist": (0.034, 0.09, 0.25),
    "flange": (0.012, 0.04, 0.38),
}
# kg = factor * reach^power, where no payload is known: of the same arms.
USUAL_PAYLOAD = (7.6, 2.48)
# The same for the Universal Robots: mm for each root of a metre of reach, half the width of their meshes (within 15 %).
UR_THICKNESS = {"foot": 85.0, "column": 66.0, "upper": 66.0, "fore": 60.0, "wrist": 46.0, "flange": 41.0}
# How high the foot goes, as a share of the height of axis 2: the median of the same meshes.
FOOT_SHARE = 0.57
# How far along the forearm the body goes that joint 4 does not turn.
ELBOW_SHARE = 0.35
# Shorter than this, mm, a piece is no body of its own.
_SHORTEST = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class LinkBody:
    """A form that goes with a link. `at` (4, 4): where it is in the frame of the link, mm."""

    link: int
    shape: Shape
    at: FloatArray


@dataclass(frozen=True, slots=True)
class ArmBodies:
    """The bodies of an arm. `source`: where they come from; `notes`: what could not be had; `fitted`: all are capsules
    by the lengths of the arm."""

    bodies: tuple[LinkBody, ...]
    source: str
    notes: tuple[str, ...] = ()
    fitted: bool = True


def arm_bodies(model: RobotModel) -> tuple[LinkBody, ...]:
    """The bodies of an arm, link by link."""
    return bodies_of(model).bodies


@lru_cache(maxsize=64)
def bodies_of(model: RobotModel) -> ArmBodies:
    """The bodies of an arm, and what is to be said of them.

    For each link those that the robot file gives, else those of the URDF, else capsules by the arm's lengths.
    """
    fitted = _fitted(model)
    source = "capsules by the lengths of the arm, radii by its reach and payload (an assumption)"
    given: tuple[LinkBody, ...] = ()
    lacking: dict[int, str] = {}
    if model.urdf is not None:
        read, lacking = urdf_bodies(model.urdf)
        given = tuple(LinkBody(*one) for one in read)
        given = (*given, *(body for body in fitted if body.link in lacking))
        source = "the meshes and forms of its URDF" if given else source
    if model.bodies:
        own = tuple(
            capsule_between(one.link, np.array(one.start), np.array(one.end), one.radius) for one in model.bodies
        )
        given = (*own, *_others(given, own))
        source = "those of its robot file"
    found = sorted((*given, *_others(fitted, given)), key=lambda body: body.link)
    return ArmBodies(tuple(found), source, tuple(lacking.values()), not given)


def _others(bodies: Sequence[LinkBody], said: Sequence[LinkBody]) -> list[LinkBody]:
    """Those of links that have none yet."""
    links = {body.link for body in said}
    return [body for body in bodies if body.link not in links]


def link_poses(model: RobotModel, joints: ArrayLike) -> FloatArray:
    """Where the frames of the links are, (k, links + 1, 4, 4) mm in the robot's base, for joints (k, n) in pendant
    units. Link 0 is the base itself.

    The product of exponentials over the joint axes at theta = 0 (Lynch and Park, Modern Robotics, 2017, ch. 4.1).
    """
    theta = model.theta(joints)
    poses = np.zeros((len(theta), model.axes + 1, 4, 4))
    poses[:, :, 3, 3] = 1.0
    poses[:, 0] = np.eye(4)
    sines, rests = np.sin(theta.T), 1.0 - np.cos(theta.T)
    # The numbers of all moments side by side: turned (3, 3, k) and shifted (3, k).
    turned = np.repeat(np.eye(3)[:, :, None], len(theta), axis=2)
    shifted = np.zeros((3, len(theta)))
    for joint, screw in enumerate(_screws(model)):
        if screw.turning:
            before = screw.point @ turned
            # Rodrigues: R (I + sin K + (1 - cos) K K), about the point.
            first = screw.across @ turned
            turned = turned + sines[joint] * first + rests[joint] * (screw.across @ first)
            shifted = shifted + before - screw.point @ turned
        else:
            shifted = shifted + (screw.direction @ turned) * theta[:, joint]
        poses[:, joint + 1, :3, :3] = turned.transpose(2, 0, 1)
        poses[:, joint + 1, :3, 3] = shifted.T
    return poses


@dataclass(frozen=True, slots=True, eq=False)
class _Screw:
    """A joint at theta = 0: a point on its axis and its direction (3,); `across` @ v is v x direction for columns."""

    turning: bool
    point: FloatArray
    direction: FloatArray
    across: FloatArray


@lru_cache(maxsize=64)
def _screws(model: RobotModel) -> tuple[_Screw, ...]:
    found = []
    for point, direction, turning in zip(*model.arm.axes(np.zeros(model.axes)), model.revolute, strict=True):
        x, y, z = direction
        across = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        found.append(_Screw(bool(turning), point, direction, across))
    return tuple(found)


def capsule_between(link: int, start: FloatArray, end: FloatArray, radius: float) -> LinkBody:
    """A capsule about the way between two points (3,), a ball where they are one."""
    length = float(np.linalg.norm(end - start))
    if length < _SHORTEST:
        return LinkBody(link, Sphere(2.0 * radius), pose_matrix((start + end) / 2.0))
    return LinkBody(link, Capsule(2.0 * radius, length), _along(start, end))


def _cylinder(link: int, start: FloatArray, end: FloatArray, radius: float) -> list[LinkBody]:
    """A cylinder with its flat ends in two points (3,); nothing where they are one."""
    length = float(np.linalg.norm(end - start))
    return [] if length < _SHORTEST else [LinkBody(link, Cylinder(2.0 * radius, length), _along(start, end))]


def _along(start: FloatArray, end: FloatArray) -> FloatArray:
    """The pose in the middle of two points (3,) whose z goes from one to the other."""
    z = (end - start) / np.linalg.norm(end - start)
    helper = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(helper, z)
    x /= np.linalg.norm(x)
    return pose_matrix((start + end) / 2.0, np.stack([x, np.cross(z, x), z], axis=1))


def _fitted(model: RobotModel) -> list[LinkBody]:
    """Capsules by the lengths of the arm, in the frame of its base."""
    arm: Arm = model.arm
    placed = np.eye(4)
    if isinstance(arm, PlacedArm):
        placed, arm = arm.base, arm.arm
    match arm:
        case OpwArm():
            bodies = _of_opw(arm, model.foot_mm, model.payload_kg)
        case UrArm():
            bodies = _of_ur(arm)
        case ScaraArm():
            bodies = _of_scara(arm, float(model.limits[2, 1] - model.limits[2, 0]), model.payload_kg)
        case _:
            return _of_chain(model)
    return [LinkBody(body.link, body.shape, placed @ body.at) for body in bodies]


def _radii(reach_mm: float, payload_kg: float | None) -> dict[str, float]:
    """Of the bodies of an arm, mm."""
    reach = max(reach_mm, 50.0) / 1000.0
    factor, power = USUAL_PAYLOAD
    payload = payload_kg if payload_kg is not None else factor * reach**power
    return {name: 1000.0 * a * reach**b * payload**c for name, (a, b, c) in THICKNESS.items()}


def _of_opw(arm: OpwArm, foot_mm: float, payload_kg: float | None) -> list[LinkBody]:
    """Straight up over axis 1: the foot, the column to axis 2, the upper arm, the elbow and the forearm, which joint 4
    turns from a third of its way on, the wrist, and a disc that ends at the flange and keeps clear of the forearm."""
    radius = _radii(math.hypot(arm.a1 + arm.c2 + math.hypot(arm.a2, arm.c3), arm.b), payload_kg)
    foot, shoulder = np.array([0.0, 0.0, foot_mm]), np.array([arm.a1, 0.0, arm.c1])
    upper, elbow = np.array([arm.a1, arm.b, arm.c1]), np.array([arm.a1, arm.b, arm.c1 + arm.c2])
    bend = elbow + np.array([arm.a2, 0.0, 0.0])
    wrist = bend + np.array([0.0, 0.0, arm.c3])
    flange = wrist + np.array([0.0, 0.0, arm.c4])
    split = bend + ELBOW_SHARE * (wrist - bend)
    top = foot + FOOT_SHARE * (np.array([0.0, 0.0, arm.c1]) - foot)
    round_mm = min(radius["wrist"], 0.7 * arm.c4) if arm.c4 > _SHORTEST else radius["wrist"]
    disc = min(0.25 * arm.c4, 2.0 * radius["flange"])
    bodies = _cylinder(0, foot, top, radius["foot"])
    bodies.append(capsule_between(1, top, shoulder, radius["column"]))
    if abs(arm.b) > radius["column"]:
        bodies.append(capsule_between(1, shoulder, upper, radius["upper"]))
    bodies.append(capsule_between(2, upper, elbow, radius["upper"]))
    bodies.append(capsule_between(3, elbow, bend, radius["fore"]))
    bodies.append(capsule_between(3, bend, split, radius["fore"]))
    bodies.append(capsule_between(4, split, wrist, round_mm))
    bodies.append(capsule_between(5, wrist, wrist + 0.2 * (flange - wrist), 0.9 * round_mm))
    return [*bodies, *_cylinder(6, flange - np.array([0.0, 0.0, disc]), flange, radius["flange"])]


def _of_ur(arm: UrArm) -> list[LinkBody]:
    """The upper arm beside axis 1, the forearm back before it, three wrist joints of one size.

    How far the two tubes lie beside axis 1 is not part of the kinematics: in the makers' description it is about d4 and
    nothing (visual meshes of the UR5e: 138 and 7 mm beside 133 mm of d4).
    """
    root = math.sqrt(math.hypot(arm.a2 + arm.a3, arm.d4) / 1000.0)
    radius = {name: mm * root for name, mm in UR_THICKNESS.items()}
    points, directions = arm.axes(np.zeros(6))
    side = directions[1]
    shoulder, elbow, fore_end = points[1], points[2], points[3]
    wrist = fore_end + side * arm.d4
    below = wrist + directions[4] * arm.d5
    flange = arm.forward(np.zeros(6))[:3, 3]
    outside = side * arm.d4 * np.sign(arm.d4)
    low = np.array([0.0, 0.0, 0.5 * arm.d1])
    last = (flange - below) / max(float(np.linalg.norm(flange - below)), 1e-9)
    return [
        *_cylinder(0, np.zeros(3), low, radius["foot"]),
        capsule_between(1, low, shoulder, radius["column"]),
        capsule_between(2, shoulder, shoulder + outside, radius["upper"]),
        capsule_between(2, shoulder + outside, elbow + outside, radius["upper"]),
        capsule_between(3, elbow + outside, elbow, radius["fore"]),
        capsule_between(3, elbow, fore_end, radius["fore"]),
        capsule_between(4, fore_end, wrist, radius["wrist"]),
        capsule_between(5, wrist, below, radius["wrist"]),
        *_cylinder(6, flange - last * 0.3 * abs(arm.d6), flange, radius["flange"]),
    ]


def _of_scara(arm: ScaraArm, stroke: float, payload_kg: float | None) -> list[LinkBody]:
    """Both links stretched out along x over the flange at the top of its stroke, and the quill that goes through."""
    reach = arm.l1 + arm.l2
    radius = _radii(reach, payload_kg)
    level = arm.height + radius["upper"]
    axis, elbow, tool = (np.array([x, 0.0, level]) for x in (0.0, arm.l1, reach))
    low, high = np.array([reach, 0.0, arm.height]), np.array([reach, 0.0, arm.height + stroke])
    disc = np.array([0.0, 0.0, radius["flange"]])
    return [
        *_cylinder(0, np.zeros(3), np.array([0.0, 0.0, max(arm.height - radius["upper"], 0.0)]), radius["foot"]),
        capsule_between(1, axis, elbow, radius["upper"]),
        capsule_between(2, elbow, tool, 0.8 * radius["upper"]),
        *_cylinder(3, low + disc, high + disc, 0.6 * radius["flange"]),
        *_cylinder(4, low, low + disc, radius["flange"]),
    ]


def _of_chain(model: RobotModel) -> list[LinkBody]:
    """From joint to joint, by the origins of the joints in the URDF, and on to its tip."""
    points, _ = model.arm.axes(np.zeros(model.axes))
    if model.urdf is not None:
        from rpl.emulator.chains import joint_origins

        points = joint_origins(model.urdf.chain, model.urdf.zero)
    ends = np.vstack([np.zeros(3), points, model.arm.forward(np.zeros(model.axes))[:3, 3]])
    reach = float(np.linalg.norm(np.diff(ends, axis=0), axis=1).sum())
    sizes = _radii(reach, model.payload_kg)
    last = len(ends) - 2
    bodies = []
    for link, (start, end) in enumerate(itertools.pairwise(ends)):
        radius = sizes["upper"] + (sizes["wrist"] - sizes["upper"]) * link / max(last, 1)
        way = end - start
        length = float(np.linalg.norm(way))
        if link == last and length > radius:
            end = end - way * (radius / length)  # so that it ends at the tip
        bodies.append(capsule_between(link, start, end, min(radius, max(length, 0.5 * radius))))
    return bodies
