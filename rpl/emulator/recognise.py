"""Is this six-axis chain an ortho-parallel arm with a spherical wrist? Then its inverse is known in closed form.

Given the joint axes of any serial arm at its zero position, `fit_opw` finds the lengths, signs and offsets that
reproduce it, whatever way its description places the frames. The caller checks the result against the original chain:
only an exact match counts.
"""

from dataclasses import dataclass

import numpy as np

from rpl.emulator.arms import Arm, Branch, Branches, OpwArm
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix

# Directions closer than this (sine or cosine) count as parallel or perpendicular; points closer than this (mm) as one.
ANGLE = 1e-7
DISTANCE = 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class PlacedArm:
    """An arm whose own base and flange lie elsewhere: pose = base · arm · tip (4, 4, mm)."""

    arm: Arm
    base: FloatArray
    tip: FloatArray

    @property
    def branches(self) -> tuple[Branch, ...]:
        return self.arm.branches

    def forward(self, theta: FloatArray) -> FloatArray:
        return np.asarray(self.base @ self.arm.forward(theta) @ self.tip)

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        points, directions = self.arm.axes(theta)
        turn = self.base[:3, :3]
        return points @ turn.T + self.base[:3, 3], directions @ turn.T

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        return self.arm.inverse(invert_pose(self.base) @ flange @ invert_pose(self.tip), reference)

    def branch(self, theta: FloatArray) -> Branch:
        return self.arm.branch(theta)


@dataclass(frozen=True, slots=True, eq=False)
class OpwFit:
    """theta = signs * q - offsets (radians) makes `arm` the chain that was given."""

    arm: PlacedArm
    signs: FloatArray
    offsets: FloatArray


def fit_opw(points: FloatArray, directions: FloatArray, tip: FloatArray) -> OpwFit | None:
    """The ortho-parallel arm with these joint axes at zero: points (6, 3) mm, unit directions (6, 3), tip pose (4, 4).

    None when the axes do not have that structure. Sides are chosen so that the front is where the base frame's x axis
    points, and the wrist's zero is the one nearest to the given zero position.
    """
    wrist = _wrist_centre(points, directions)
    if wrist is None or not _structured(directions):
        return None
    signs = np.ones(6)
    signs[0] = 1.0 if directions[0, 2] >= 0.0 else -1.0
    z = signs[0] * directions[0]
    y = directions[1]
    if np.cross(y, z)[0] < -ANGLE or (abs(np.cross(y, z)[0]) <= ANGLE and y[1] < 0.0):
        y, signs[1] = -y, -1.0
    signs[2] = 1.0 if directions[2] @ y > 0.0 else -1.0
    x = np.cross(y, z)
    turn = np.stack([x, y, z], axis=1)
    origin = points[0] - (points[0] @ z) * z
    local = (points - origin) @ turn
    centre = (wrist - origin) @ turn
    upper = local[2, [0, 2]] - local[1, [0, 2]]
    lean = float(np.arctan2(upper[0], upper[1]))
    forearm, signs[3] = turn.T @ directions[3], 1.0
    across = centre[[0, 2]] - local[2, [0, 2]]
    if forearm[[0, 2]] @ across < 0.0:
        forearm, signs[3] = -forearm, -1.0
    bend = float(np.arctan2(forearm[0], forearm[2]))
    side = np.array([np.cos(bend), -np.sin(bend)])
    fore = np.stack([[np.cos(bend), 0.0, -np.sin(bend)], [0.0, 1.0, 0.0], forearm], axis=1)
    fifth = fore.T @ turn.T @ directions[4]
    if fifth[1] < -ANGLE or (abs(fifth[1]) <= ANGLE and fifth[0] > 0.0):
        fifth, signs[4] = -fifth, -1.0
    roll = float(np.arctan2(-fifth[0], fifth[1]))
    last = turn.T @ directions[5]
    reach = (turn.T @ (tip[:3, 3] - origin) - centre) @ last
    if reach < -DISTANCE or (abs(reach) <= DISTANCE and last @ forearm < 0.0):
        last, signs[5] = -last, -1.0
    seen = fore.T @ last
    pitch = float(np.arctan2(np.cos(roll) * seen[0] + np.sin(roll) * seen[1], seen[2]))
    arm = OpwArm(
        a1=float(local[1, 0]),
        a2=float(across @ side),
        b=float(centre[1]),
        c1=float(local[1, 2]),
        c2=float(np.linalg.norm(upper)),
        c3=float(across @ forearm[[0, 2]]),
        c4=float(abs(reach)),
    )
    zero = np.array([0.0, lean, bend - lean, roll, pitch, 0.0])
    base = pose_matrix(origin, turn)
    rest = invert_pose(base @ arm.forward(zero)) @ tip
    return OpwFit(PlacedArm(arm, base, rest), signs, -zero)


def _structured(directions: FloatArray) -> bool:
    products = np.abs(directions @ directions.T)
    perpendicular = (products[0, 1], products[1, 3], products[3, 4], products[4, 5])
    return bool(products[1, 2] > 1.0 - ANGLE and max(perpendicular) < ANGLE)


def _wrist_centre(points: FloatArray, directions: FloatArray) -> FloatArray | None:
    """The common point of the last three axes, None when they have none (or axes 4 and 5 are parallel)."""
    # Least squares: the point with the least squared distance to the three lines.
    across = np.eye(3) - directions[3:, :, None] * directions[3:, None, :]
    if np.linalg.svd(across[0] + across[1], compute_uv=False)[-1] < 1e-3:
        return None
    centre = np.linalg.solve(across.sum(axis=0), (across @ points[3:, :, None]).sum(axis=0))[:, 0]
    distances = np.linalg.norm((across @ (centre - points[3:])[:, :, None])[..., 0], axis=1)
    return centre if distances.max() < DISTANCE else None
