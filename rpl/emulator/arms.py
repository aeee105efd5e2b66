"""Closed-form kinematics of the three families of arms that nearly every robot program is written for.

Everything here is in the family's own joint variables ("theta": radians, mm for a sliding joint) and in mm; turning a
robot's pendant degrees into theta is the business of `rpl.emulator.model`. Each arm offers the same four functions
(`Arm`), vectorised over leading axes, and returns every branch of the inverse in a fixed order.

Sources: ortho-parallel arms with spherical wrist, Brandstoetter, Angerer, Hofbaur (2014), in the convention of the
ROS-I `opw_kinematics` package; Universal Robots by their published standard DH parameters (Hawkins 2013); SCARA
elementary.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray, pose_matrix, rotation_x, rotation_y, rotation_z

BoolArray = NDArray[np.bool_]

# A pose may lie this far beyond the end of the reach through rounding and still count as reached there; where parallel
# axes follow the links (UR), a straight wrist loses more: there a cosine may exceed 1 by that much.
BEYOND_MM = 1e-9
COSINE_SLACK = 1e-9
# An arm as good as stretched is stretched: rounding alone would bend it by 1e-7 rad, which the pose does not show, but
# which turns the hand about where the wrist is straight too.
ROUNDING_COSINE = 4e-15
# A joint is free, and the reference decides, where turning it moves the flange by less than this. So small, because the
# pose is missed by as much; rounding stays a hundred times below.
STILL_MM = 5e-10
STILL_RAD = 1e-9
# Rounding in double precision: a wrist centre this close to axis 1, an angle this close to its boundary, is on it.
ON_AXIS_MM, ON_LINE_RAD = 1e-9, 1e-10
# Where axis 4 passes beside axis 1, front and back are one posture with the wrist centre as near as it can come.
SAME_MM = 1e-6


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
        """The branch that one joint vector (n,) lies on; on a boundary within rounding: the near side of it."""


def _rows(flange: FloatArray) -> FloatArray:
    """The upper rows of poses (k, 4, 4) as (3, 4, k): with the poses side by side each step is one pass over memory."""
    return np.ascontiguousarray(flange[:, :3].transpose(1, 2, 0))


def _circle(theta: FloatArray, joints: tuple[int, ...]) -> tuple[list[FloatArray | float], list[FloatArray | float]]:
    """Cosines and sines of these joints of (..., n), joint by joint."""
    cosines, sines = np.cos(theta), np.sin(theta)
    if theta.ndim == 1:  # one posture: plain numbers take a third of the time of arrays without a dimension
        return [cosines.item(joint) for joint in joints], [sines.item(joint) for joint in joints]
    return [cosines[..., joint] for joint in joints], [sines[..., joint] for joint in joints]


def _flanges(like: FloatArray | float) -> FloatArray:
    """Poses (..., 4, 4) whose upper rows are still to be filled."""
    pose = np.zeros((*np.shape(like), 4, 4))
    pose[..., 3, 3] = 1.0
    return pose


def _signed(root: FloatArray) -> FloatArray:
    """Both signs of a root (k,): (2, k)."""
    both = np.empty((2, len(root)))
    both[0], both[1] = root, -root
    return both


def _two_links(
    square: FloatArray, first: float, second: float, beyond: float | None = BEYOND_MM
) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
    """Two links in a plane whose ends are apart by the root of `square` (mm²), both lengths of one sign.

    The angle between them (0 stretched), the angle of the first to the line between the ends, reachable, and stretched
    or folded. By half angles, which stay exact where links of equal length fold upon each other.
    """
    share = (square - (first - second) ** 2) * (0.25 / (first * second))
    far = near = 0.5 * COSINE_SLACK
    if beyond is not None:
        far = (first + second) * beyond * (0.5 / (first * second))
        near = (abs(first - second) + 0.5 * beyond) * beyond * (0.5 / (first * second))
    ok = (share >= -near) & (share <= 1.0 + far)
    straight = (share <= 0.5 * COSINE_SLACK) | (share >= 1.0 - 0.5 * COSINE_SLACK)
    share = np.where(share >= 1.0 - ROUNDING_COSINE, 1.0, np.maximum(share, 0.0))
    across, along = np.sqrt(1.0 - share), np.sqrt(share)
    ahead = np.arctan2(2.0 * second * across * along, first - second + 2.0 * second * share)
    return 2.0 * np.arctan2(across, along), ahead, ok, straight


def _solutions(theta: FloatArray, valid: BoolArray, singular: BoolArray) -> Branches:
    """Results from joints (n, ..., k) of b branches in all, valid and singular (b, k): as views, nothing is copied."""
    joints = theta.reshape(len(theta), len(valid), -1)
    if not valid.all():
        np.copyto(joints, np.nan, where=~valid)
    return Branches(joints.T, valid.T, singular.T)


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
        return math.atan2(self.a2, self.c3)

    def forward(self, theta: FloatArray) -> FloatArray:
        reach, height = self.in_plane(theta)
        (c1, c4, c5, c6), (s1, s4, s5, s6) = _circle(theta, (0, 3, 4, 5))
        (c23,), (s23,) = _circle(theta[..., 1:2] + theta[..., 2:3], (0,))
        pose = _flanges(c1)
        # Columns of Rz(t4)·Ry(t5)·Rz(t6), each then turned by Ry(t23) and Rz(t1).
        c45, s45 = c4 * c5, s4 * c5
        wrist = (
            (c45 * c6 - s4 * s6, s45 * c6 + c4 * s6, -s5 * c6),
            (-c45 * s6 - s4 * c6, c4 * c6 - s45 * s6, s5 * s6),
            (c4 * s5, s4 * s5, c5),
        )
        for column, (x, y, z) in enumerate(wrist):
            ahead = c23 * x + s23 * z
            pose[..., 0, column] = c1 * ahead - s1 * y
            pose[..., 1, column] = s1 * ahead + c1 * y
            pose[..., 2, column] = c23 * z - s23 * x
        pose[..., 0, 3] = reach * c1 - self.b * s1 + self.c4 * pose[..., 0, 2]
        pose[..., 1, 3] = reach * s1 + self.b * c1 + self.c4 * pose[..., 1, 2]
        pose[..., 2, 3] = height + self.c4 * pose[..., 2, 2]
        return pose

    def in_plane(self, theta: FloatArray) -> tuple[FloatArray | float, FloatArray | float]:
        """The wrist centre in the plane of axis 1: distance from it (negative: behind) and height, mm."""
        t2, t23 = theta[..., 1], theta[..., 1] + theta[..., 2]
        reach = self.a1 + self.c2 * np.sin(t2) + self.a2 * np.cos(t23) + self.c3 * np.sin(t23)
        height = self.c1 + self.c2 * np.cos(t2) - self.a2 * np.sin(t23) + self.c3 * np.cos(t23)
        return (reach, height) if theta.ndim > 1 else (float(reach), float(height))

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
        rows, near = _rows(flange), reference.T
        centre = rows[:, 3] - self.c4 * rows[:, 2]
        theta = np.empty((6, 2, 2, 2, len(flange)))
        t1, reach, reachable, over_axis = self._shoulder(centre, near)
        t2, t3, ok, bent = self._elbow(reach, centre[2] - self.c1, near)
        theta[0], theta[1], theta[2] = t1[:, None, None], t2[:, :, None], t3[:, :, None]
        straight = self._spherical(rows, t1, t2 + t3, near, theta)
        singular = straight | (over_axis | bent)[:, None]
        return _solutions(theta, np.repeat(reachable & ok, 4, axis=0), np.repeat(singular.reshape(4, -1), 2, axis=0))

    def _shoulder(self, centre: FloatArray, near: FloatArray) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
        """Joint 1 and the wrist's distance from axis 2 along the arm, both (2, k); reachable and singular (k,)."""
        radius_squared = centre[0] * centre[0] + centre[1] * centre[1]
        square = radius_squared - self.b**2
        reachable = square >= -2.0 * STILL_MM * abs(self.b)  # that the wrist centre is nearer to axis 1 than it can be
        root = np.sqrt(np.maximum(square, 0.0))
        # Turned about, the wrist centre is off by twice its distance from the axis.
        over_axis = radius_squared <= (0.5 * STILL_MM) ** 2
        t1 = np.empty((2, len(root)))
        t1[:] = np.arctan2(centre[1], centre[0])
        # atan2(b, -root) is half a turn less atan2(b, root).
        skew = np.arctan2(self.b, root) if self.b else np.zeros(1)
        t1[0] -= skew
        t1[1] += skew - np.pi
        if over_axis.any():
            t1[0, over_axis] = near[0, over_axis]
            t1[1, over_axis] = near[0, over_axis] + np.pi
        return t1, _signed(root) - self.a1, reachable, over_axis | (root <= SAME_MM) if self.b else over_axis

    def _elbow(
        self, reach: FloatArray, height: FloatArray, near: FloatArray
    ) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
        """Joints 2 and 3 (shoulder, elbow, k); reachable and singular (stretched, folded) (shoulder, k)."""
        square = reach * reach + height * height
        bend, ahead, ok, straight = _two_links(square, self.c2, math.hypot(self.a2, self.c3))
        lean = np.arctan2(reach, height)
        folded = square <= STILL_MM**2
        t2, t3 = np.empty((2, 2, len(height))), np.empty((2, 2, len(height)))
        t2[:, 0], t2[:, 1] = lean - ahead, lean + ahead
        t3[:, 0], t3[:, 1] = bend - self.elbow_angle, -bend - self.elbow_angle
        if folded.any():
            t2 = np.where(folded[:, None], near[1], t2)
        return t2, t3, ok, folded | straight

    def _spherical(
        self, rows: FloatArray, t1: FloatArray, t23: FloatArray, near: FloatArray, theta: FloatArray
    ) -> BoolArray:
        """Fill joints 4, 5, 6 of `theta` (6, 2, 2, 2, k); where joint 4 is free (shoulder, elbow, k)."""
        c1, s1, c23, s23 = np.cos(t1), np.sin(t1), np.cos(t23), np.sin(t23)
        x, y, z = rows[0, :3, None], rows[1, :3, None], rows[2, :3, None, None]
        # M = (Rz(t1) Ry(t23))^T R, row by row: (column, shoulder, elbow, k), the second the same for both elbows.
        along = (c1 * x + s1 * y)[:, :, None]
        m0 = c23 * along - s23 * z
        m1 = (c1 * y - s1 * x)[:, :, None]
        m22 = s23 * along[2] + c23 * z[2]
        sine = np.sqrt(m0[2] * m0[2] + m1[2] * m1[2])
        straight = sine <= min(STILL_RAD, STILL_MM / max(self.c4, 1e-9))
        t4 = np.arctan2(m1[2], m0[2])
        with np.errstate(invalid="ignore"):
            c4, s4 = m0[2] / sine, m1[2] / sine
        if straight.any():
            t4 = np.where(straight, near[3], t4)
            c4, s4 = np.where(straight, np.cos(near[3]), c4), np.where(straight, np.sin(near[3]), s4)
            sine = np.where(straight, 0.0, sine)
        # With joint 4 known, the rest follows from the rows that do not vanish at joint 5 = 0.
        t5 = np.arctan2(sine, m22)
        t6 = np.arctan2(c4 * m1[0] - s4 * m0[0], c4 * m1[1] - s4 * m0[1])
        theta[3, :, :, 0], theta[4, :, :, 0], theta[5, :, :, 0] = t4, t5, t6
        theta[3, :, :, 1], theta[4, :, :, 1], theta[5, :, :, 1] = t4 + np.pi, -t5, t6 + np.pi
        return np.asarray(straight)

    def branch(self, theta: FloatArray) -> Branch:
        reach, _ = self.in_plane(theta)
        bend = _wrap(theta[2] + self.elbow_angle)
        return Branch(int(reach < -ON_AXIS_MM), int(bend < -ON_LINE_RAD), int(_wrap(theta[4]) < -ON_LINE_RAD))


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
        (c1, c5, c6), (s1, s5, s6) = _circle(theta, (0, 4, 5))
        reach, rise, total = self._in_plane(theta)
        c234, s234 = np.cos(total), np.sin(total)
        # The third axis of joint 4's frame is level; the other two lie in the plane of joints 2, 3 and 4.
        level = np.zeros_like(c1)
        x4, y4, z4 = (c1 * c234, s1 * c234, s234), (s1, -c1, level), (c1 * s234, s1 * s234, -c234)
        ahead = (c1 * reach, s1 * reach, self.d1 + rise)
        pose = _flanges(c1)
        for row, (x, y, z) in enumerate(zip(x4, y4, z4, strict=True)):
            bent = c5 * x + s5 * y
            last = c5 * y - s5 * x
            pose[..., row, 0] = c6 * bent - s6 * z
            pose[..., row, 1] = -s6 * bent - c6 * z
            pose[..., row, 2] = last
            pose[..., row, 3] = ahead[row] + self.d4 * y + self.d5 * z + self.d6 * last
        return pose

    def _in_plane(self, theta: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Where joint 4's axis lies in the plane of the links: ahead and up, mm; and t2 + t3 + t4."""
        t2, t23 = theta[..., 1], theta[..., 1] + theta[..., 2]
        reach = self.a2 * np.cos(t2) + self.a3 * np.cos(t23)
        return np.asarray(reach), self.a2 * np.sin(t2) + self.a3 * np.sin(t23), np.asarray(t23 + theta[..., 3])

    def axes(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        before = self._frames(theta)[:-1]
        return (
            np.stack([f[..., :3, 3] for f in before], axis=-2),
            np.stack([f[..., :3, 2] for f in before], axis=-2),
        )

    def inverse(self, flange: FloatArray, reference: FloatArray) -> Branches:
        rows = _rows(flange)
        centre = rows[:, 3] - self.d6 * rows[:, 2]
        square = centre[0] * centre[0] + centre[1] * centre[1] - self.d4**2
        reachable = square >= -2.0 * STILL_MM * abs(self.d4)
        root = np.sqrt(np.maximum(square, 0.0))
        t1 = np.arctan2(centre[1], centre[0]) + np.arctan2(self.d4, _signed(root))
        c1, s1 = np.cos(t1), np.sin(t1)
        theta = np.empty((6, 2, 2, 2, len(flange)))
        theta[0] = t1[:, None, None]
        x4, z4, sides, free = self._wrist(rows, centre, c1, s1, reference[:, 5], theta)
        # Where the planar links of joints 2 and 3 must end, and t2 + t3 + t4, each (shoulder, wrist, k).
        x = (c1 * centre[0] + s1 * centre[1])[:, None] - sides * (self.d5 * (c1 * z4[0] + s1 * z4[1]))[:, None]
        y = centre[2] - self.d1 - sides * (self.d5 * z4[2])[:, None]
        total = np.arctan2(sides * x4[2][:, None], sides * (c1 * x4[0] + s1 * x4[1])[:, None])
        bend, ahead, ok, straight = _two_links(x * x + y * y, self.a2, self.a3, None)
        lean = np.arctan2(y, x)
        for elbow, side in enumerate((1.0, -1.0)):
            turned = lean - side * ahead
            theta[1, :, elbow], theta[2, :, elbow] = turned, side * bend
            theta[3, :, elbow] = total - turned - side * bend
        singular = free[:, None] | straight | (root <= SAME_MM)
        flags = (2, 2, 2, len(flange))
        valid = np.broadcast_to((ok & reachable)[:, None], flags).reshape(8, -1)
        return _solutions(theta, valid, np.broadcast_to(singular[:, None], flags).reshape(8, -1))

    def _wrist(
        self,
        rows: FloatArray,
        centre: FloatArray,
        c1: FloatArray,
        s1: FloatArray,
        near: FloatArray,
        theta: FloatArray,
    ) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
        """Fill joints 5 and 6 of `theta` (6, 2, 2, 2, k) from the flange's axes seen along axes 2, 3, 4.

        Returns the x and z axes of frame 4 in the base for wrist 0, (3, shoulder, k), their sign for both wrists
        (shoulder or 1, wrist, k or 1), and where joint 6 is free (shoulder, k).
        """
        turn = rows[:, :3, None]
        x, y, z = s1 * turn[0] - c1 * turn[1]
        sine = np.sqrt(x * x + y * y)
        free = sine <= min(STILL_RAD, STILL_MM / (abs(self.d5) + abs(self.d6)))
        t6 = np.arctan2(-y, x)
        with np.errstate(invalid="ignore"):
            c6, s6 = x / sine, -y / sine
        sides = np.array([[[1.0], [-1.0]]])
        if free.any():
            t6 = np.where(free, near - np.sign(z) * self._out_of_reach(turn, centre, c1, s1, near), t6)
            c6, s6 = np.where(free, np.cos(t6), c6), np.where(free, np.sin(t6), s6)
            sine = np.where(free, 0.0, sine)
            sides = np.where(free[:, None], 1.0, sides)
        t5, length = np.arctan2(sine, z), np.sqrt(sine * sine + z * z)
        c5, s5 = z / length, sine / length
        theta[4, :, :, 0], theta[5, :, :, 0] = t5[:, None], t6[:, None]
        theta[4, :, :, 1], theta[5, :, :, 1] = -t5[:, None], np.where(free, t6, t6 + np.pi)[:, None]
        # Frame 4 seen from the base: R·(Rz(t5)·Rx(-90)·Rz(t6))^T.
        x4 = c5 * (c6 * turn[:, 0] - s6 * turn[:, 1]) - s5 * turn[:, 2]
        return x4, -s6 * turn[:, 0] - c6 * turn[:, 1], sides, np.asarray(free)

    def _out_of_reach(
        self, turn: FloatArray, centre: FloatArray, c1: FloatArray, s1: FloatArray, near: FloatArray
    ) -> FloatArray:
        """How far joint 6 must leave `near` (k,) for joints 2 and 3 to reach, joint 5 being zero; (shoulder, k)."""
        z4 = -np.sin(near) * turn[:, 0] - np.cos(near) * turn[:, 1]
        x, y = c1 * centre[0] + s1 * centre[1], centre[2] - self.d1
        away = np.sqrt(x * x + y * y)
        # The wrist's end lies on a circle about the centre, at this angle to the way from axis 2.
        angle = _wrap(np.arctan2(z4[2], c1 * z4[0] + s1 * z4[1]) - np.arctan2(y, x))
        whole, twice = away * away + self.d5**2, 2.0 * np.maximum(away, 1e-9) * self.d5
        nearest, farthest = (whole - (self.a2 - self.a3) ** 2) / twice, (whole - (self.a2 + self.a3) ** 2) / twice
        cosine = np.cos(angle)
        possible = np.minimum(np.maximum(cosine, farthest), nearest)
        moved = np.copysign(np.arccos(np.minimum(np.maximum(possible, -1.0), 1.0)), angle) - angle
        return np.where(possible == cosine, 0.0, moved)

    def branch(self, theta: FloatArray) -> Branch:
        reach, _, total = self._in_plane(theta)
        along = reach + self.d5 * np.sin(total)
        bend, wrist = _wrap(theta[2]), _wrap(theta[4])
        return Branch(int(along < -ON_AXIS_MM), int(bend < -ON_LINE_RAD), int(wrist < -ON_LINE_RAD))


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
        bend, ahead, ok, straight = _two_links(square, self.l1, self.l2)
        upright = (np.hypot(flange[:, 0, 2], flange[:, 1, 2]) <= self.tilt) & (flange[:, 2, 2] < 0.0)
        sides = np.array([1.0, -1.0])
        q2 = bend[:, None] * sides
        q1 = np.arctan2(y, x)[:, None] - ahead[:, None] * sides
        on_axis = square <= STILL_MM**2
        q1 = np.where(on_axis[:, None], reference[:, :1], q1)
        yaw = np.arctan2(flange[:, 1, 0], flange[:, 0, 0])[:, None]
        stroke = np.broadcast_to((self.height - flange[:, 2, 3])[:, None], q1.shape)
        theta = np.stack([q1, q2, stroke, q1 + q2 - yaw], axis=-1)
        valid = np.broadcast_to((ok & upright)[:, None], q1.shape).copy()
        theta[~valid] = np.nan
        singular = on_axis | straight
        return Branches(theta, valid, np.broadcast_to(singular[:, None], q1.shape).copy())

    def branch(self, theta: FloatArray) -> Branch:
        return Branch(0, int(_wrap(theta[1]) < -ON_LINE_RAD), 0)
