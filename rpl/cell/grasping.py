"""What a gripper holds when it closes: which part, and how it comes to lie between the jaws or on the cup.

The rules are those of the textbook's off-line programming system (Craig, Introduction to Robotics, ch. 13; M, at second
hand): a part can be grasped whose box contains the tool centre point; of several the nearest is. Parallel jaws turn a
part about their own z until its width between them is at a minimum and centre it: squeezing without friction, quasi-
static, as of Goldberg, Orienting Polygonal Parts without Sensors, Algorithmica 10 (1993), whose diameter function only
has minima where an edge lies flat on a jaw. A cup takes the facet that its axis pierces, and turns the part by the
least rotation that brings the facet's normal onto its axis.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rpl.cell.layout import Gripper, Part
from rpl.cell.shapes import bounds_at, moved
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix, rotation_vector_to_matrix, rotation_z

# A width that differs by less than this share when the part turns is that of something round: jaws do not turn it.
_ROUND_SHARE = 0.01
# How far the facet under a cup may lean (degrees) for its lip to close. M: bellows allow about this much.
MOST_LEAN_DEG = 20.0
# How wide jaws are along their x, for what else is between them. M.
JAW_MM = 20.0


@dataclass(frozen=True, slots=True, eq=False)
class Hold:
    """A part and its pose (4, 4) in the frame of the grip point. `width_mm`: of the jaws then. `too`: what else is
    between them, each as it lay: a double pick."""

    part: Part
    pose: FloatArray
    width_mm: float
    too: tuple[tuple[Part, FloatArray], ...] = ()


@dataclass(frozen=True, slots=True)
class Miss:
    """Nothing is held, and why; `part`: which one it was about."""

    why: str
    part: str = ""


Free = Sequence[tuple[Part, FloatArray]]  # parts that nobody holds, and their poses (4, 4) in the cell


def grasp(gripper: Gripper, grip: FloatArray, free: Free) -> Hold | Miss:
    """What the gripper takes that closes with its grip point at a pose (4, 4) in the cell."""
    return _between(gripper, grip, free) if gripper.kind == "jaws" else _sucked(gripper, grip, free)


def _between(gripper: Gripper, grip: FloatArray, free: Free) -> Hold | Miss:
    point = grip[:3, 3]
    near = []
    for part, pose in free:
        low, high = bounds_at(part.shape, pose)
        if (point >= low - gripper.reach_mm).all() and (point <= high + gripper.reach_mm).all():
            near.append((float(np.linalg.norm(point - (low + high) / 2.0)), part, pose))
    if not near:
        return Miss("no part between the jaws")
    _, part, pose = min(near, key=lambda one: one[0])
    in_grip = invert_pose(grip) @ pose
    corners = moved(part.shape.facets.vertices, in_grip)
    low_mm, high_mm = gripper.opening
    open_for = _width(corners[:, :2], 0.0)
    if open_for > high_mm:
        return Miss(f"{open_for:.1f} mm wide between jaws that open {high_mm:g} mm", part.name)
    turn = squeezed(corners[:, :2])
    about = np.eye(4)
    about[:3, :3] = rotation_z(turn)
    middle = in_grip[:3, 3].copy()
    about[:3, 3] = middle - about[:3, :3] @ middle
    about[2, 3] = 0.0
    held = about @ in_grip
    too = tuple(_beside(gripper, grip, [one for one in free if one[0] is not part]))
    rows = [moved(each.shape.facets.vertices, place)[:, 1] for each, place in ((part, held), *too)]
    low_y, high_y = min(float(row.min()) for row in rows), max(float(row.max()) for row in rows)
    width, middle_y = high_y - low_y, (low_y + high_y) / 2.0
    for place in (held, *(place for _, place in too)):
        place[1, 3] -= middle_y
    if width < low_mm:
        return Miss(f"{width:.1f} mm wide between jaws that close to {low_mm:g} mm", part.name)
    return Hold(part, held, width, too)


def _beside(gripper: Gripper, grip: FloatArray, others: Free) -> Iterator[tuple[Part, FloatArray]]:
    """Further parts that are wholly between the open jaws, with their poses in the frame of the grip point."""
    half = gripper.opening[1] / 2.0
    for part, pose in others:
        in_grip = invert_pose(grip) @ pose
        low, high = bounds_at(part.shape, in_grip)
        between = low[1] >= -half and high[1] <= half
        if between and low[0] <= JAW_MM / 2.0 and high[0] >= -JAW_MM / 2.0 and low[2] <= 0.0 <= high[2]:
            yield part, in_grip


def squeezed(corners: FloatArray) -> float:
    """By which angle (rad) about z jaws that close along y turn a part of these corners (n, 2).

    From where it lies to the next minimum of its width, on the side on which the width falls.
    """
    outline = hull_2d(corners)
    edges = np.roll(outline, -1, axis=0) - outline
    # An edge lies on a jaw where it is along x: turns that bring it there, within a quarter turn.
    turns = -np.arctan2(edges[:, 1], edges[:, 0])
    stops = np.unique(np.round((turns + math.pi / 2.0) % math.pi - math.pi / 2.0, 12))
    stops = np.unique(np.concatenate([stops - math.pi, stops, stops + math.pi]))
    here = _width(outline, 0.0)
    widths = [_width(outline, float(stop)) for stop in stops]
    if max(*widths, here) - min(widths) <= _ROUND_SHARE * here:
        return 0.0
    step = 1e-6
    up, down = _width(outline, step), _width(outline, -step)
    if min(up, down) >= here - 1e-12:
        return 0.0
    sign = 1.0 if up < down else -1.0
    for stop in sorted(float(sign * one) for one in stops if sign * one > step / 2):
        if _width(outline, sign * (stop + step)) >= _width(outline, sign * stop):
            return sign * stop  # from a flat edge on it would have to open the jaws
    return 0.0


def _width(corners: FloatArray, turn_rad: float) -> float:
    """Along y, of corners (n, 2) turned about z."""
    across = corners[:, 0] * math.sin(turn_rad) + corners[:, 1] * math.cos(turn_rad)
    return float(across.max() - across.min())


def hull_2d(points: FloatArray) -> FloatArray:
    """The corners (k, 2) of the convex hull of points (n, 2), counter-clockwise: Andrew's monotone chain (1979)."""
    ordered = sorted({(round(float(x), 9), round(float(y), 9)) for x, y in points})

    def half(rows: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        chain: list[tuple[float, float]] = []
        for row in rows:
            while len(chain) > 1 and _left(chain[-2], chain[-1], row) <= 1e-9:
                chain.pop()
            chain.append(row)
        return chain[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))


def _left(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _sucked(gripper: Gripper, grip: FloatArray, free: Free) -> Hold | Miss:
    axis = grip[:3, 2]
    start = grip[:3, 3] - axis * gripper.reach_mm  # a cup that is pressed down stands in the part
    met: list[tuple[float, Part, FloatArray, FloatArray, FloatArray]] = []
    for part, pose in free:
        back = invert_pose(pose)
        found = part.shape.facets.pierced(back[:3, :3] @ start + back[:3, 3], back[:3, :3] @ axis)
        if found is not None and found[0] <= 2.0 * gripper.reach_mm:
            on_way = back[:3, :3] @ (start + axis * found[0]) + back[:3, 3]
            point, normal = part.shape.on_surface(on_way)
            met.append((found[0], part, pose, point, normal))
    if not met:
        return Miss("no part under the cup")
    _, part, pose, point, normal = min(met, key=lambda one: one[0])
    in_grip = invert_pose(grip) @ pose
    outward = in_grip[:3, :3] @ normal
    lean = math.degrees(math.acos(min(max(-float(outward[2]), -1.0), 1.0)))
    if lean > MOST_LEAN_DEG:
        return Miss(f"the facet under the cup leans by {lean:.0f} degrees", part.name)
    turned = pose_matrix((0.0, 0.0, 0.0), _least_rotation(outward, np.array([0.0, 0.0, -1.0])) @ in_grip[:3, :3])
    turned[:3, 3] = -turned[:3, :3] @ point
    return Hold(part, turned, 0.0)


def _least_rotation(start: FloatArray, end: FloatArray) -> FloatArray:
    """The rotation (3, 3) by the least angle that brings one unit vector onto another, less than half a turn away."""
    axis = np.cross(start, end)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-15:
        return np.eye(3)
    return rotation_vector_to_matrix(axis / sine * math.atan2(sine, float(start @ end)))
