"""Closed-form kinematics of the three families of arms that nearly every robot program is written for.

Everything here is in the family's own joint variables ("theta": radians, mm for a sliding joint) and in mm; turning a
robot's pendant degrees into theta is the business of `rpl.emulator.model`. Each arm offers the same four functions
(`Arm`), vectorised over leading axes, and returns every branch of the inverse in a fixed order.

Sources: ortho-parallel arms with spherical wrist, Brandstoetter, Angerer, Hofbaur (2014), in the convention of the
ROS-I `opw_kinematics` package; Universal Robots by their published standard DH parameters (Hawkins 2013); SCARA
elementary.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_x, rotation_y, rotation_z

BoolArray = NDArray[np.bool_]

# A cosine may exceed 1 by this much through rounding and still count as the stretched arm.
COSINE_SLACK = 1e-9
# Below this sine (or relative radius) a joint axis has no direction of its own and the reference decides.
SINGULAR = 1e-9


@dataclass(frozen=True, slots=True)
class Branch:
    """Which of the solutions of the inverse: 0 or 1 for shoulder, elbow and wrist.

    Shoulder 0: the wrist centre is in front of axis 1. Elbow 0: joint 3 bends the forearm forward of the stretched arm
    (the joint-sided elbow that controllers name; seen from outside it looks "up" in front and "down" behind).
    Wrist 0: joint 5 on the side that points the tool down when joint 4 is 0.
    """

    shoulder: int
    elbow: int
    wrist: int

    @property
    def index(self) -> int:
        """Position in `BRANCHES`."""
        return 4 * self.shoulder + 2 * self.elbow + self.wrist

    @property
    def name(self) -> str:
        """Stable name such as `front-forward-plus`."""
        return "-".join(
            (
                ("front", "back")[self.shoulder],
                ("forward", "backward")[self.elbow],
                ("plus", "minus")[self.wrist],
            )
        )


BRANCHES = tuple(Branch(s, e, w) for s in (0, 1) for e in (0, 1) for w in (0, 1))


@dataclass(frozen=True, slots=True)
class Branches:
    """Solutions for k flange poses: theta (k, b, n), NaN where there is none; valid and singular (k, b)."""

    theta: FloatArray
    valid: BoolArray
    singular: BoolArray


class Arm(Protocol):
    """What the robot model needs of an arm. `theta` is (..., n); poses are of the flange in the arm's base, mm."""

    @property
    def branches(self) -> tuple[Branch, ...]:
        """The branches in the order of `inverse`."""

    def forward(self, theta: FloatArray) -> FloatArray:
        """Flange poses (..., 4, 4)."""

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A point on each joint axis and its direction, both (..., n, 3)."""

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        """All branches for flanges (k, 4, 4); free joints of singular postures follow `reference` (k, n)."""

    def branch(self, theta: FloatArray) -> Branch:
        """The branch that one joint vector (n,) lies on, by strict signs."""


@dataclass(frozen=True, slots=True)
class OpwArm:
    """Six joints, axes 2 and 3 parallel, spherical wrist.

    R = Rz(t1)·Ry(t2+t3)·Rz(t4)·Ry(t5)·Rz(t6); elbow at c2, wrist centre at (a2, b, c3) past the elbow, flange c4 along
    the wrist's z. Lengths in mm.
    """

    a1: float
    a2: float
    b: float
    c1: float
    c2: float
    c3: float
    c4: float

    @property
    def branches(self) -> tuple[Branch, ...]:
        return BRANCHES

    @property
    def elbow_angle(self) -> float:
        """psi = atan2(a2, c3), radians: the arm is stretched where theta3 = -psi."""
        return float(np.arctan2(self.a2, self.c3))

    def forward(self, theta: FloatArray) -> FloatArray:
        t1, t23 = theta[..., 0], theta[..., 1] + theta[..., 2]
        turn = rotation_z(t1) @ rotation_y(t23) @ rotation_z(theta[..., 3]) @ rotation_y(theta[..., 4])
        turn = turn @ rotation_z(theta[..., 5])
        return pose_matrix(self._wrist(theta) + self.c4 * turn[..., :, 2], turn)

    def in_plane(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The wrist centre in the plane of axis 1: distance from it (negative: behind) and height, mm."""
        t2, t23 = theta[..., 1], theta[..., 1] + theta[..., 2]
        reach = self.a1 + self.c2 * np.sin(t2) + self.a2 * np.cos(t23) + self.c3 * np.sin(t23)
        height = self.c1 + self.c2 * np.cos(t2) - self.a2 * np.sin(t23) + self.c3 * np.cos(t23)
        return np.asarray(reach), np.asarray(height)

    def _wrist(self, theta: FloatArray) -> FloatArray:
        reach, height = self.in_plane(theta)
        c, s = np.cos(theta[..., 0]), np.sin(theta[..., 0])
        return np.stack([reach * c - self.b * s, reach * s + self.b * c, height], axis=-1)

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        c, s = np.cos(theta[..., 0]), np.sin(theta[..., 0])
        t2, zero, one = theta[..., 1], np.zeros_like(c), np.ones_like(c)
        wrist = self._wrist(theta)
        shoulder = np.stack([self.a1 * c, self.a1 * s, self.c1 * one], axis=-1)
        radius = self.a1 + self.c2 * np.sin(t2)
        elbow = np.stack([radius * c, radius * s, self.c1 + self.c2 * np.cos(t2)], axis=-1)
        forearm = rotation_z(theta[..., 0]) @ rotation_y(t2 + theta[..., 2])
        bend = forearm @ rotation_z(theta[..., 3])
        flange = bend @ rotation_y(theta[..., 4])
        side = np.stack([-s, c, zero], axis=-1)
        up = np.stack([zero, zero, one], axis=-1)
        points = np.stack([np.zeros_like(wrist), shoulder, elbow, wrist, wrist, wrist], axis=-2)
        directions = np.stack([up, side, side, forearm[..., :, 2], bend[..., :, 1], flange[..., :, 2]], axis=-2)
        return points, directions

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        turn = flange[:, :3, :3]
        centre = flange[:, :3, 3] - self.c4 * turn[:, :, 2]
        t1, x1, reachable, free1 = self._shoulder(centre, reference)
        t2, t3, ok, free2 = self._elbow(x1, centre[:, 2] - self.c1, reference)
        t1 = np.broadcast_to(t1[:, :, None], t2.shape)
        t4, t5, t6, free4 = self._spherical(turn, t1, t2 + t3, reference)
        valid, free = reachable[:, :, None] & ok, free1[:, :, None] | free2
        theta = np.empty((len(flange), 2, 2, 2, 6))
        for axis, value in enumerate((t1, t2, t3)):
            theta[..., axis] = value[..., None]
        for axis, wrist in enumerate((t4, t5, t6), start=3):
            theta[..., axis] = wrist
        theta[~valid] = np.nan
        shape = (len(flange), 8)
        return Branches(
            theta.reshape(*shape, 6),
            np.repeat(valid.reshape(-1, 4), 2, axis=1),
            np.repeat(free.reshape(-1, 4), 2, axis=1) | np.repeat(free4.reshape(-1, 4), 2, axis=1),
        )

    def _shoulder(
        self, centre: FloatArray, reference: FloatArray
    ) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
        """Joint 1 (k, 2), the wrist's distance from axis 2 along the arm (k, 2), reachable, and singular."""
        radius_squared = centre[:, 0] ** 2 + centre[:, 1] ** 2
        square = radius_squared - self.b**2
        scale = max(self.c2 + self.c3, 1.0) ** 2
        reachable = square >= -COSINE_SLACK * scale
        root = np.sqrt(np.maximum(square, 0.0))
        over_axis = radius_squared <= (SINGULAR**2) * scale
        heading = np.arctan2(centre[:, 1], centre[:, 0])
        front = np.where(over_axis, reference[:, 0], heading - np.arctan2(self.b, root))
        back = np.where(over_axis, reference[:, 0] + np.pi, heading - np.arctan2(self.b, -root))
        both = np.stack([reachable, reachable], axis=1)
        singular = np.stack([over_axis, over_axis], axis=1)
        return np.stack([front, back], axis=1), np.stack([root - self.a1, -root - self.a1], axis=1), both, singular

    def _elbow(
        self, x1: FloatArray, z1: FloatArray, reference: FloatArray
    ) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
        """Joints 2 and 3, each (k, 2, 2), with reachable and singular (stretched, folded) of the same shape."""
        forearm = float(np.hypot(self.a2, self.c3))
        height = np.broadcast_to(z1[:, None], x1.shape)
        square = x1**2 + height**2
        cosine = (square - self.c2**2 - forearm**2) / (2.0 * self.c2 * forearm)
        ok = np.abs(cosine) <= 1.0 + COSINE_SLACK
        cosine = np.clip(cosine, -1.0, 1.0)
        sine = np.sqrt((1.0 - cosine) * (1.0 + cosine))
        sines = np.stack([sine, -sine], axis=-1)
        bend = np.arctan2(sines, cosine[..., None])
        folded = square <= (SINGULAR * (self.c2 + forearm)) ** 2
        lean = np.arctan2(x1, height)[..., None] - np.arctan2(forearm * sines, (self.c2 + forearm * cosine)[..., None])
        t2 = np.where(folded[..., None], reference[:, 1][:, None, None], lean)
        singular = folded | (np.abs(cosine) >= 1.0 - COSINE_SLACK)
        pair = (*x1.shape, 2)
        return (
            t2,
            bend - self.elbow_angle,
            np.broadcast_to(ok[..., None], pair),
            np.broadcast_to(singular[..., None], pair),
        )

    @staticmethod
    def _spherical(
        turn: FloatArray, t1: FloatArray, t23: FloatArray, reference: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
        """Joints 4, 5, 6, each (k, 2, 2, 2), and where joint 4 is free (k, 2, 2)."""
        c1, s1, c23, s23 = np.cos(t1), np.sin(t1), np.cos(t23), np.sin(t23)
        # M = (Rz(t1) Ry(t23))^T R, row by row, each (k, 2, 2, 3).
        row = turn[:, None, None, :, :]
        along = c1[..., None] * row[..., 0, :] + s1[..., None] * row[..., 1, :]
        m0 = c23[..., None] * along - s23[..., None] * row[..., 2, :]
        m1 = c1[..., None] * row[..., 1, :] - s1[..., None] * row[..., 0, :]
        m22 = s23 * along[..., 2] + c23 * row[..., 2, 2]
        free = np.hypot(m0[..., 2], m1[..., 2]) <= SINGULAR
        plus = np.where(free, reference[:, 3][:, None, None], np.arctan2(m1[..., 2], m0[..., 2]))
        c4, s4 = np.cos(plus), np.sin(plus)
        # With joint 4 known, the rest follows from the rows that do not vanish at joint 5 = 0.
        t5 = np.where(free & (m22 > 0), 0.0, np.arctan2(np.where(free, 0.0, c4 * m0[..., 2] + s4 * m1[..., 2]), m22))
        t6 = np.arctan2(c4 * m1[..., 0] - s4 * m0[..., 0], c4 * m1[..., 1] - s4 * m0[..., 1])
        return (
            np.stack([plus, plus + np.pi], axis=-1),
            np.stack([t5, -t5], axis=-1),
            np.stack([t6, t6 + np.pi], axis=-1),
            free,
        )

    def branch(self, theta: FloatArray) -> Branch:
        reach, _ = self.in_plane(theta)
        bend = _wrap(theta[2] + self.elbow_angle)
        return Branch(int(reach < 0.0), int(bend < 0.0), int(_wrap(theta[4]) < 0.0))


def _wrap(angle: FloatArray | float) -> FloatArray:
    """Radians into [-pi, pi), leaving angles that are already inside untouched."""
    a = np.asarray(angle, dtype=np.float64)
    return np.where(np.abs(a) <= np.pi, a, (a + np.pi) % (2.0 * np.pi) - np.pi)


@dataclass(frozen=True, slots=True)
class UrArm:
    """Universal Robots: standard DH (d1,0,90) (0,a2,0) (0,a3,0) (d4,0,90) (d5,0,-90) (d6,0,0), mm.

    The base frame is the one the controller shows, half a turn about z from the mounting frame of the ROS models.
    Shoulder 0: the wrist on the +x side of joint 1's frame. Elbow 0: joint 3 >= 0. Wrist 0: joint 5 >= 0.
    """

    d1: float
    a2: float
    a3: float
    d4: float
    d5: float
    d6: float

    @property
    def branches(self) -> tuple[Branch, ...]:
        return BRANCHES

    def _frames(self, theta: FloatArray) -> list[FloatArray]:
        lengths = (self.d1, 0.0, 0.0, self.d4, self.d5, self.d6)
        offsets = (0.0, self.a2, self.a3, 0.0, 0.0, 0.0)
        twists = (np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0)
        frames = [np.broadcast_to(np.eye(4), (*theta.shape[:-1], 4, 4))]
        for i, (d, a, alpha) in enumerate(zip(lengths, offsets, twists, strict=True)):
            turn = rotation_z(theta[..., i])
            origin = np.stack(np.broadcast_arrays(a * turn[..., 0, 0], a * turn[..., 1, 0], d), axis=-1)
            frames.append(frames[-1] @ pose_matrix(origin, turn @ rotation_x(alpha)))
        return frames

    def forward(self, theta: FloatArray) -> FloatArray:
        return self._frames(theta)[-1]

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        before = self._frames(theta)[:-1]
        return (
            np.stack([f[..., :3, 3] for f in before], axis=-2),
            np.stack([f[..., :3, 2] for f in before], axis=-2),
        )

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        centre = flange[:, :3, 3] - self.d6 * flange[:, :3, 2]
        square = centre[:, 0] ** 2 + centre[:, 1] ** 2 - self.d4**2
        reachable = square >= -COSINE_SLACK * self.d4**2
        sides = np.array([1.0, -1.0])
        root = np.sqrt(np.maximum(square, 0.0))[:, None] * sides
        t1 = np.arctan2(centre[:, 1], centre[:, 0])[:, None] + np.arctan2(self.d4, root)
        t5, t6, free = self._wrist(flange, t1, reference)
        x, y, total = self._linkage(flange, t1, t5, t6)
        cosine = (x * x + y * y - self.a2**2 - self.a3**2) / (2.0 * self.a2 * self.a3)
        ok = (np.abs(cosine) <= 1.0 + COSINE_SLACK) & reachable[:, None, None]
        cosine = np.clip(cosine, -1.0, 1.0)
        stretched = np.abs(cosine) >= 1.0 - COSINE_SLACK
        # Axes of the result: pose, shoulder, elbow, wrist.
        t3 = np.arccos(cosine)[:, :, None, :] * sides[:, None]
        t2 = np.arctan2(y, x)[:, :, None, :] - np.arctan2(self.a3 * np.sin(t3), self.a2 + self.a3 * np.cos(t3))
        theta = np.empty((*t3.shape, 6))
        theta[..., 0] = t1[:, :, None, None]
        theta[..., 1], theta[..., 2] = t2, t3
        theta[..., 3] = total[:, :, None, :] - t2 - t3
        theta[..., 4], theta[..., 5] = t5[:, :, None, :], t6[:, :, None, :]
        valid = np.broadcast_to(ok[:, :, None, :], t3.shape).reshape(-1, 8).copy()
        singular = np.broadcast_to((free[:, :, None] | stretched)[:, :, None, :], t3.shape).reshape(-1, 8).copy()
        theta = theta.reshape(-1, 8, 6)
        theta[~valid] = np.nan
        return Branches(theta, valid, singular)

    @staticmethod
    def _wrist(flange: FloatArray, t1: FloatArray, reference: FloatArray) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Joints 5 and 6 (k, shoulder, wrist) from the flange axes seen along axes 2, 3, 4; where 6 is free (k, 2)."""
        row = np.sin(t1)[..., None] * flange[:, None, 0, :3] - np.cos(t1)[..., None] * flange[:, None, 1, :3]
        x, y, z = row[..., 0, None], row[..., 1, None], row[..., 2, None]
        free = np.hypot(x, y) <= SINGULAR
        sides = np.array([1.0, -1.0])
        t6 = np.where(free, reference[:, 5][:, None, None], np.arctan2(-sides * y, sides * x))
        sine = np.where(free, 0.0, np.cos(t6) * x - np.sin(t6) * y)
        return np.arctan2(sine, z), t6, free[..., 0]

    def _linkage(
        self, flange: FloatArray, t1: FloatArray, t5: FloatArray, t6: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Where the planar links of joints 2 and 3 must end (x, y) and t2 + t3 + t4, each (k, shoulder, wrist)."""
        turn = flange[:, None, None, :3, :3]
        c5, s5, c6, s6 = np.cos(t5), np.sin(t5), np.cos(t6), np.sin(t6)
        # Frame 4 seen from the base: R·(Rz(t5)·Rx(-90)·Rz(t6))^T, its x and z axes.
        x4 = turn[..., 0] * (c5 * c6)[..., None] - turn[..., 1] * (c5 * s6)[..., None] - turn[..., 2] * s5[..., None]
        z4 = -turn[..., 0] * s6[..., None] - turn[..., 1] * c6[..., None]
        origin = (flange[:, :3, 3] - self.d6 * flange[:, :3, 2])[:, None, None] - self.d5 * z4
        c1, s1 = np.cos(t1)[..., None], np.sin(t1)[..., None]
        x, y = c1 * origin[..., 0] + s1 * origin[..., 1], origin[..., 2] - self.d1
        return x, y, np.arctan2(x4[..., 2], c1 * x4[..., 0] + s1 * x4[..., 1])

    def branch(self, theta: FloatArray) -> Branch:
        heading = self._frames(theta)[5][:3, 3]
        along = np.cos(theta[0]) * heading[0] + np.sin(theta[0]) * heading[1]
        return Branch(int(along < 0.0), int(_wrap(theta[2]) < 0.0), int(_wrap(theta[4]) < 0.0))


@dataclass(frozen=True, slots=True)
class ScaraArm:
    """Two parallel links, a vertical stroke, a tool axis pointing down: theta = (q1, q2, stroke down in mm, q4).

    x = l1 c1 + l2 c12, y = l1 s1 + l2 s12, z = height - stroke, R = Rz(q1 + q2 - q4)·Rx(180 deg).
    Elbow 0 is joint 2 >= 0. Poses whose tool axis is not vertical (within `tilt`, radians) have no solution.
    """

    l1: float
    l2: float
    height: float
    tilt: float = 1e-5

    @property
    def branches(self) -> tuple[Branch, ...]:
        return (Branch(0, 0, 0), Branch(0, 1, 0))

    def forward(self, theta: FloatArray) -> FloatArray:
        q1, q12 = theta[..., 0], theta[..., 0] + theta[..., 1]
        x = self.l1 * np.cos(q1) + self.l2 * np.cos(q12)
        y = self.l1 * np.sin(q1) + self.l2 * np.sin(q12)
        turn = rotation_z(q12 - theta[..., 3]) @ rotation_x(np.pi)
        return pose_matrix(np.stack([x, y, self.height - theta[..., 2]], axis=-1), turn)

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        flange = self.forward(theta)[..., :3, 3]
        zero = np.zeros_like(theta[..., 0])
        elbow = np.stack([self.l1 * np.cos(theta[..., 0]), self.l1 * np.sin(theta[..., 0]), zero], axis=-1)
        points = np.stack([np.zeros_like(flange), elbow, flange, flange], axis=-2)
        directions = np.zeros_like(points)
        directions[..., 2] = np.array([1.0, 1.0, -1.0, -1.0])
        return points, directions

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        x, y = flange[:, 0, 3], flange[:, 1, 3]
        square = x * x + y * y
        cosine = (square - self.l1**2 - self.l2**2) / (2.0 * self.l1 * self.l2)
        upright = (np.hypot(flange[:, 0, 2], flange[:, 1, 2]) <= self.tilt) & (flange[:, 2, 2] < 0.0)
        ok = (np.abs(cosine) <= 1.0 + COSINE_SLACK) & upright
        cosine = np.clip(cosine, -1.0, 1.0)
        q2 = np.arccos(cosine)[:, None] * np.array([1.0, -1.0])
        q1 = np.arctan2(y, x)[:, None] - np.arctan2(self.l2 * np.sin(q2), self.l1 + self.l2 * np.cos(q2))
        on_axis = square <= (SINGULAR * (self.l1 + self.l2)) ** 2
        q1 = np.where(on_axis[:, None], reference[:, :1], q1)
        yaw = np.arctan2(flange[:, 1, 0], flange[:, 0, 0])[:, None]
        stroke = np.broadcast_to((self.height - flange[:, 2, 3])[:, None], q1.shape)
        theta = np.stack([q1, q2, stroke, q1 + q2 - yaw], axis=-1)
        valid = np.broadcast_to(ok[:, None], q1.shape).copy()
        theta[~valid] = np.nan
        singular = on_axis | (np.abs(cosine) >= 1.0 - COSINE_SLACK)
        return Branches(theta, valid, np.broadcast_to(singular[:, None], q1.shape).copy())

    def branch(self, theta: FloatArray) -> Branch:
        return Branch(0, int(_wrap(theta[1]) < 0.0), 0)
