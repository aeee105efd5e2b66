"""Rotations and poses of constants in plain Python: what the passes need to convert literals between conventions.

The emulator has the vectorised versions; a translation that needs no kinematics starts without NumPy, and passes do not
look upwards. Millimetres and degrees. R(a, b, c) = Rz(a)·Ry(b)·Rx(c); quaternions are w, x, y, z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from rpl.ir.columns import by_row

Triple = tuple[float, float, float]
Quadruple = tuple[float, float, float, float]
# Below this cosine of b the first and last angle turn about the same axis.
GIMBAL = 1e-9
# Half a turn backwards, within rounding (degrees): it is written as half a turn forwards.
HALF_TURN_BACK = -180.0 + 1e-9
# A smaller component of a unit quaternion is what rounding leaves of zero.
NOISE = 1e-13


@dataclass(frozen=True, slots=True)
class Vector:
    x: float
    y: float
    z: float

    def plus(self, other: Vector, factor: float = 1.0) -> Vector:
        return Vector(self.x + factor * other.x, self.y + factor * other.y, self.z + factor * other.z)

    def times(self, factor: float) -> Vector:
        return Vector(self.x * factor, self.y * factor, self.z * factor)

    def dot(self, other: Vector) -> float:
        return self.x * other.x + self.y * other.y + self.z * other.z

    def cross(self, other: Vector) -> Vector:
        return Vector(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )

    @property
    def length(self) -> float:
        return _root(self.dot(self))


@dataclass(frozen=True, slots=True)
class Rotation:
    """A rotation by its unit quaternion. `written` are the ZYX angles it was given by, when it was given by angles:
    they are kept because a reader wants to meet them again."""

    quaternion: Quadruple
    written: Triple | None = field(default=None, compare=False)

    @property
    def zyx(self) -> Triple:
        """Angles (a, b, c) in degrees; a and c in (-180, 180], b in [-90, 90] unless written otherwise."""
        return self.written or quaternion_to_zyx(self.quaternion)

    def then(self, other: Rotation) -> Rotation:
        """The product self·other."""
        return Rotation(_unit(multiply(self.quaternion, other.quaternion)))

    @property
    def inverse(self) -> Rotation:
        w, x, y, z = self.quaternion
        return Rotation((w, -x, -y, -z))

    @property
    def angle(self) -> float:
        """By how much it turns, degrees in 0..180; exact for small turns too."""
        return _turn(self.quaternion)

    def turn(self, vector: Vector) -> Vector:
        """The vector turned by this rotation."""
        rows = self.rows
        return Vector(*(row[0] * vector.x + row[1] * vector.y + row[2] * vector.z for row in rows))

    @property
    def rows(self) -> tuple[Triple, Triple, Triple]:
        """The matrix by rows."""
        w, x, y, z = self.quaternion
        return (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )


@dataclass(frozen=True, slots=True)
class Pose:
    position: Vector
    rotation: Rotation

    def then(self, other: Pose) -> Pose:
        """The product self:other."""
        return Pose(self.place(other.position), self.rotation.then(other.rotation))

    def place(self, vector: Vector) -> Vector:
        """A point given in this pose, in the pose's reference."""
        return self.position.plus(self.rotation.turn(vector))

    @property
    def inverse(self) -> Pose:
        back = self.rotation.inverse
        return Pose(back.turn(self.position).times(-1.0), back)

    @property
    def matrix(self) -> list[list[float]]:
        """4x4 matrix by rows, mm."""
        p = self.position
        rows = [list(row) for row in self.rotation.rows]
        return [[*rows[0], p.x], [*rows[1], p.y], [*rows[2], p.z], [0.0, 0.0, 0.0, 1.0]]


NO_TURN = Rotation((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
IDENTITY = Pose(Vector(0.0, 0.0, 0.0), NO_TURN)


def rotation_of_quaternion(w: float, x: float, y: float, z: float) -> Rotation | None:
    """The rotation of a quaternion of any length; None for one of length zero."""
    length = _root(w * w + x * x + y * y + z * z)
    return None if length < 1e-12 else Rotation(_of_length_one((w, x, y, z), length))


@by_row
def _of_length_one(quaternion: Quadruple, length: float) -> Quadruple:
    w, x, y, z = (0.0 if abs(part) < NOISE * length else part / length for part in quaternion)
    return w, x, y, z


def rotation_of_zyx(a: float, b: float, c: float) -> Rotation:
    """Rz(a)·Ry(b)·Rx(c) of angles in degrees."""
    turns = (_about(3, a), _about(2, b), _about(1, c))
    return Rotation(_unit(multiply(multiply(turns[0], turns[1]), turns[2])), (a, b, c))


def rotation_of_turns(*turns: tuple[int, float]) -> Rotation:
    """One turn after the other, each about an axis (1 x, 2 y, 3 z) of what the turns before have made, in degrees."""
    whole: Quadruple = (1.0, 0.0, 0.0, 0.0)
    for axis, degrees in turns:
        whole = multiply(whole, _about(axis, degrees))
    return Rotation(_unit(whole))


def rotation_of_rows(rows: tuple[Triple, Triple, Triple]) -> Rotation:
    """The rotation of a matrix by rows (Shepperd 1978: the formula with the largest divisor)."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows
    candidates = (
        (1 + xx + yy + zz, zy - yz, xz - zx, yx - xy),
        (zy - yz, 1 + xx - yy - zz, xy + yx, xz + zx),
        (xz - zx, xy + yx, 1 - xx + yy - zz, yz + zy),
        (yx - xy, xz + zx, yz + zy, 1 - xx - yy + zz),
    )
    best = max(range(4), key=lambda at: candidates[at][at])
    return Rotation(_unit(candidates[best]))


def pose_of_matrix(matrix: list[list[float]]) -> Pose:
    """The pose of a rigid 4x4 matrix by rows."""
    m = matrix
    rows = ((m[0][0], m[0][1], m[0][2]), (m[1][0], m[1][1], m[1][2]), (m[2][0], m[2][1], m[2][2]))
    return Pose(Vector(m[0][3], m[1][3], m[2][3]), rotation_of_rows(rows))


@by_row
def quaternion_to_zyx(quaternion: Quadruple) -> Triple:
    """Angles (a, b, c) in degrees, a and c in (-180, 180]. At b = ±90: c = 0, all in a."""
    (xx, xy, xz), (yx, yy, yz), (zx, _, _) = Rotation(quaternion).rows
    cosine = math.hypot(xx, yx)
    if cosine < GIMBAL:
        return angle_of(-xy, yy), math.copysign(90.0, -zx), 0.0
    a = math.atan2(yx, xx)
    s, k = math.sin(a), math.cos(a)
    c = math.atan2(s * xz - k * yz, k * yy - s * xy)
    b = math.atan2(-zx, cosine)
    return clean(_half_open(math.degrees(a))), clean(math.degrees(b)), clean(_half_open(math.degrees(c)))


@by_row
def angle_of(sine: float, cosine: float) -> float:
    """The angle in (-180, 180] degrees of a sine and a cosine times one length, without noise in its last places."""
    return clean(_half_open(math.degrees(math.atan2(sine, cosine))))


@by_row
def clean(value: float) -> float:
    """The value without the noise of the last binary places, and never a negative zero."""
    rounded = float(f"{value:.12g}")
    return 0.0 if abs(rounded) < 1e-10 else rounded


def multiply(p: Quadruple, q: Quadruple) -> Quadruple:
    """Hamilton product."""
    a, b, c, d = p
    e, f, g, h = q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


@by_row
def _about(axis: int, degrees: float) -> Quadruple:
    half = math.fmod(degrees, 720.0) / 2
    sine, cosine = _exact_sine(half), _exact_sine(half + 90.0)
    parts = [cosine, 0.0, 0.0, 0.0]
    parts[axis] = sine
    return (parts[0], parts[1], parts[2], parts[3])


def _exact_sine(degrees: float) -> float:
    """Sine that is exact at multiples of 90 degrees, so that 180 gives (0, 0, 1, 0) and no 6e-17."""
    if degrees % 90.0 == 0.0:
        return (0.0, 1.0, 0.0, -1.0)[round(degrees / 90.0) % 4]
    return math.sin(math.radians(degrees))


@by_row
def _turn(quaternion: Quadruple) -> float:
    w, *rest = quaternion
    return math.degrees(2.0 * math.atan2(math.hypot(*rest), abs(w)))


@by_row
def _root(square: float) -> float:
    return math.sqrt(square)


@by_row
def _unit(q: Quadruple) -> Quadruple:
    """Unit length, w >= 0, and the first component that is not zero positive when w is. What rounding leaves of a zero
    is zero, so that it chooses no sign."""
    length = math.sqrt(sum(part * part for part in q)) or 1.0
    w, x, y, z = (0.0 if abs(part) < NOISE * length else part / length for part in q)
    if (w or x or y or z) < 0.0:
        return 0.0 - w, 0.0 - x, 0.0 - y, 0.0 - z
    return w, x, y, z


def _half_open(degrees: float) -> float:
    """Within (-180, 180]; -180 within rounding is 180."""
    return min(degrees + 360.0, 180.0) if degrees <= HALF_TURN_BACK else degrees
