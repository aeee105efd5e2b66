"""Where a gripper takes a part by default: for each way in which the part can lie, the place of the grip point, and the
places before and behind it, all in the frame of the part, so that a program needs the frame of the part alone.

The rule is the textbook's (Craig, Introduction to Robotics, ch. 13; M, at second hand): they follow from the box of the
part as it lies and from the gripper, and whoever knows better overrides them. Jaws take the part from above across its
narrowest width between two flat sides that they can open for, in the middle of its height; a cup takes the facet above
the centre of mass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rpl.cell.grasping import MOST_LEAN_DEG, hull_2d
from rpl.cell.layout import Gripper, Part
from rpl.cell.shapes import Shape, moved
from rpl.cell.stable import StableState, stable_states
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix, quaternion_to_matrix, rotation_z

# A gripper comes from at least so far, and from farther where the part is higher. M.
LEAST_APPROACH_MM = 50.0
# An own grasp is used in states in which it comes from above, within so many degrees.
_FROM_ABOVE_DEG = 45.0


@dataclass(frozen=True, slots=True, eq=False)
class DefaultGrasp:
    """Of a stable state (its number): the grip point, where it comes from and where it goes, each (4, 4) in the frame
    of the part, z away from the gripper. `width_mm`: of the jaws, 0 for a cup. `own`: said in the cell file."""

    state: int
    grip: FloatArray
    approach: FloatArray
    depart: FloatArray
    width_mm: float
    own: bool = False


def default_grasps(
    part: Part, gripper: Gripper, states: Sequence[StableState] | None = None
) -> tuple[DefaultGrasp, ...]:
    """One for each stable state in which the gripper can take the part; states that it cannot are left out.

    `states`: those of the part where they are known already.
    """
    found = states if states is not None else stable_states(part.shape)
    made = (_of_state(part, gripper, number, state) for number, state in enumerate(found))
    return tuple(one for one in made if one is not None)


def _of_state(part: Part, gripper: Gripper, number: int, state: StableState) -> DefaultGrasp | None:
    lying = pose_matrix((0.0, 0.0, 0.0), quaternion_to_matrix(state.rotation))
    height = float(np.ptp(moved(part.shape.facets.vertices, lying)[:, 2]))
    far = max(LEAST_APPROACH_MM, height)
    for own in part.grasps:
        if float((lying[:3, :3] @ own.grip[:3, 2])[2]) < -math.cos(math.radians(_FROM_ABOVE_DEG)):
            return _with_ways(number, own.grip, own.approach_mm or far, own.depart_mm or far, 0.0, True)
    if gripper.kind == "suction":
        grip = _on_facet(part.shape, lying)
        return None if grip is None else _with_ways(number, grip, far, far, 0.0)
    taken = _across(moved(part.shape.facets.vertices, lying), gripper)
    if taken is None:
        return None
    return _with_ways(number, invert_pose(lying) @ taken[0], far, far, taken[1])


def _with_ways(
    number: int, grip: FloatArray, approach_mm: float, depart_mm: float, width_mm: float, own: bool = False
) -> DefaultGrasp:
    """Approach and depart along the z of the grip point."""
    before, behind = (grip @ pose_matrix((0.0, 0.0, -far)) for far in (approach_mm, depart_mm))
    return DefaultGrasp(number, grip, before, behind, width_mm, own)


def _across(corners: FloatArray, gripper: Gripper) -> tuple[FloatArray, float] | None:
    """The grip (4, 4) of jaws on a part of these corners (n, 3) as it lies, and its width; None: they do not fit."""
    outline = hull_2d(corners[:, :2])
    edges = np.roll(outline, -1, axis=0) - outline
    low, high = gripper.opening
    best: tuple[float, float] | None = None
    for turn in np.arctan2(edges[:, 1], edges[:, 0]):
        width = float(np.ptp(outline @ rotation_z(turn)[:2, 1]))
        if low <= width <= high and (best is None or width < best[0] - 1e-9):
            best = width, float(turn)
    if best is None:
        return None
    axes = rotation_z(best[1])  # x along the edge that lies on a jaw
    rotation = np.stack([axes[:, 0], -axes[:, 1], np.array([0.0, 0.0, -1.0])], axis=1)
    along, across = outline @ axes[:2, 0], outline @ axes[:2, 1]
    middle = axes[:, 0] * (along.min() + along.max()) / 2.0 + axes[:, 1] * (across.min() + across.max()) / 2.0
    middle[2] = (corners[:, 2].min() + corners[:, 2].max()) / 2.0
    return pose_matrix(middle, rotation), best[0]


def _on_facet(shape: Shape, lying: FloatArray) -> FloatArray | None:
    """The grip (4, 4) of a cup, in the frame of the part; None where the facet leans too much."""
    facets, down = shape.facets, lying[:3, :3].T @ np.array([0.0, 0.0, -1.0])
    size = float(np.ptp(facets.bounds, axis=0).max())
    start = facets.centre - down * 2.0 * size
    hit = facets.pierced(start, down)
    if hit is None:
        return None
    point, normal = shape.on_surface(start + down * hit[0])
    if float(-normal @ down) < math.cos(math.radians(MOST_LEAN_DEG)):
        return None
    side = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    side /= np.linalg.norm(side)
    rotation = np.stack([side, np.cross(-normal, side), -normal], axis=1)
    return pose_matrix(point, rotation)
