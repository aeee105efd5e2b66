"""Rotations in the conventions that robot controllers print, to and from matrices.

Every controller writes an orientation its own way: three angles about moving or fixed axes, a quaternion, a rotation
vector. Matrices are the common currency, so each convention is a pair of pure functions `..._to_matrix` and
`matrix_to_...`, vectorised over leading axes, degrees at the border (the rotation vector is in radians, as its only
users print it). Two rotations are compared as matrices, never angle by angle: at gimbal lock the angles are not unique,
and the functions here then put the whole turn into one angle and 0 into the other (said at each function).
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Below this sine the axis that an angle turns about has no direction left in double precision.
GIMBAL = 1e-9
# Half a turn backwards, within rounding (degrees): it is written as half a turn forwards.
HALF_TURN_BACK = -180.0 + 1e-9


def _stack(rows: list[list[FloatArray]]) -> FloatArray:
    """Matrices (..., r, c) from elements of one shape; filling is three times as fast as np.stack for a single one."""
    out = np.empty((*np.shape(rows[0][0]), len(rows), len(rows[0])))
    for i, row in enumerate(rows):
        for j, element in enumerate(row):
            out[..., i, j] = element
    return out


def _turned(angle_rad: ArrayLike, first: int, second: int) -> FloatArray:
    """Rotations that carry axis `first` towards axis `second`."""
    a = np.asarray(angle_rad, dtype=np.float64)
    out = np.zeros((*a.shape, 3, 3))
    out[..., first, first] = out[..., second, second] = np.cos(a)
    out[..., second, first] = sine = np.sin(a)
    out[..., first, second] = -sine
    out[..., 3 - first - second, 3 - first - second] = 1.0
    return out


def rotation_x(angle_rad: ArrayLike) -> FloatArray:
    """Elementary rotations about x, shape (..., 3, 3), of angles (...) in radians."""
    return _turned(angle_rad, 1, 2)


def rotation_y(angle_rad: ArrayLike) -> FloatArray:
    """Elementary rotations about y, shape (..., 3, 3), of angles (...) in radians."""
    return _turned(angle_rad, 2, 0)


def rotation_z(angle_rad: ArrayLike) -> FloatArray:
    """Elementary rotations about z, shape (..., 3, 3), of angles (...) in radians."""
    return _turned(angle_rad, 0, 1)


def _matrix(rotation: ArrayLike) -> FloatArray:
    """The upper left 3x3 of rotations or poses, as float64; `ValueError` for any other shape."""
    m = np.asarray(rotation, dtype=np.float64)
    if m.ndim < 2 or m.shape[-2:] not in ((3, 3), (4, 4)):
        raise ValueError(f"a rotation is a 3x3 matrix (or a 4x4 pose), not an array of shape {m.shape}")
    return m[..., :3, :3]


def _triple(angles: ArrayLike) -> FloatArray:
    v = np.asarray(angles, dtype=np.float64)
    if v.ndim < 1 or v.shape[-1] != 3:
        raise ValueError(f"three numbers describe this rotation, not an array of shape {v.shape}")
    return v


def zyx_to_matrix(angles_deg: ArrayLike) -> FloatArray:
    """Rz(a)·Ry(b)·Rx(c) of angles (..., 3) = (a, b, c): moving axes z, y', x''."""
    v = np.deg2rad(_triple(angles_deg))
    return rotation_z(v[..., 0]) @ rotation_y(v[..., 1]) @ rotation_x(v[..., 2])


def matrix_to_zyx(rotation: ArrayLike) -> FloatArray:
    """Angles (a, b, c) of Rz(a)·Ry(b)·Rx(c); a, c in (-180, 180], b in [-90, 90]. At b = ±90: c = 0, all in a."""
    m = _matrix(rotation)
    cos_b = np.hypot(m[..., 0, 0], m[..., 1, 0])
    a = np.where(
        cos_b > GIMBAL,
        np.arctan2(m[..., 1, 0], m[..., 0, 0]),
        np.arctan2(-m[..., 0, 1], m[..., 1, 1]),
    )
    s, c = np.sin(a), np.cos(a)
    # The second row of Rz(-a)·R never vanishes, so the last angle stays exact next to the gimbal.
    last = np.where(
        cos_b > GIMBAL,
        np.arctan2(s * m[..., 0, 2] - c * m[..., 1, 2], c * m[..., 1, 1] - s * m[..., 0, 1]),
        0.0,
    )
    return _degrees(a, np.arctan2(-m[..., 2, 0], cos_b), last)


def xyz_fixed_to_matrix(angles_deg: ArrayLike) -> FloatArray:
    """Rz(r)·Ry(p)·Rx(w) of angles (..., 3) = (w, p, r): fixed axes x, y, z."""
    return zyx_to_matrix(_triple(angles_deg)[..., ::-1])


def matrix_to_xyz_fixed(rotation: ArrayLike) -> FloatArray:
    """Angles (w, p, r) of Rz(r)·Ry(p)·Rx(w). At p = ±90: w = 0, all in r."""
    return matrix_to_zyx(rotation)[..., ::-1].copy()


def zyz_to_matrix(angles_deg: ArrayLike) -> FloatArray:
    """Rz(a)·Ry(b)·Rz(c) of angles (..., 3) = (a, b, c): moving axes z, y', z''."""
    v = np.deg2rad(_triple(angles_deg))
    return rotation_z(v[..., 0]) @ rotation_y(v[..., 1]) @ rotation_z(v[..., 2])


def matrix_to_zyz(rotation: ArrayLike) -> FloatArray:
    """Angles (a, b, c) of Rz(a)·Ry(b)·Rz(c); b in [0, 180]. At b = 0 or 180: a = 0, all in c."""
    m = _matrix(rotation)
    sin_b = np.hypot(m[..., 0, 2], m[..., 1, 2])
    a = np.where(sin_b > GIMBAL, np.arctan2(m[..., 1, 2], m[..., 0, 2]), 0.0)
    s, c = np.sin(a), np.cos(a)
    last = np.arctan2(c * m[..., 1, 0] - s * m[..., 0, 0], c * m[..., 1, 1] - s * m[..., 0, 1])
    return _degrees(a, np.arctan2(sin_b, m[..., 2, 2]), last)


def xyz_moving_to_matrix(angles_deg: ArrayLike) -> FloatArray:
    """Rx(a)·Ry(b)·Rz(c) of angles (..., 3) = (a, b, c): moving axes x, y', z''."""
    v = np.deg2rad(_triple(angles_deg))
    return rotation_x(v[..., 0]) @ rotation_y(v[..., 1]) @ rotation_z(v[..., 2])


def matrix_to_xyz_moving(rotation: ArrayLike) -> FloatArray:
    """Angles (a, b, c) of Rx(a)·Ry(b)·Rz(c); b in [-90, 90]. At b = ±90: c = 0, all in a."""
    m = _matrix(rotation)
    cos_b = np.hypot(m[..., 1, 2], m[..., 2, 2])
    a = np.where(
        cos_b > GIMBAL,
        np.arctan2(-m[..., 1, 2], m[..., 2, 2]),
        np.arctan2(m[..., 2, 1], m[..., 1, 1]),
    )
    s, c = np.sin(a), np.cos(a)
    last = np.where(
        cos_b > GIMBAL,
        np.arctan2(c * m[..., 1, 0] + s * m[..., 2, 0], c * m[..., 1, 1] + s * m[..., 2, 1]),
        0.0,
    )
    return _degrees(a, np.arctan2(m[..., 0, 2], cos_b), last)


def _degrees(*angles_rad: FloatArray) -> FloatArray:
    """Stack radians as degrees in (-180, 180], without negative zeros; -180 within rounding is 180."""
    d = np.rad2deg(np.stack(np.broadcast_arrays(*angles_rad), axis=-1))
    return np.asarray(np.where(d <= HALF_TURN_BACK, np.minimum(d + 360.0, 180.0), d) + 0.0)


def quaternion_to_matrix(quaternion_wxyz: ArrayLike) -> FloatArray:
    """Rotations (..., 3, 3) of quaternions (..., 4) = (w, x, y, z), normalised first; `ValueError` for a zero one."""
    q = np.asarray(quaternion_wxyz, dtype=np.float64)
    if q.ndim < 1 or q.shape[-1] != 4:
        raise ValueError(f"a quaternion has four numbers, not shape {q.shape}")
    norm = np.linalg.norm(q, axis=-1, keepdims=True)
    if not np.all(norm > 1e-12):
        raise ValueError("a quaternion of length zero describes no rotation")
    w, x, y, z = np.moveaxis(q / norm, -1, 0)
    return _stack(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def matrix_to_quaternion(rotation: ArrayLike) -> FloatArray:
    """Unit quaternions (..., 4) = (w, x, y, z), w >= 0, and the first non-zero component positive when w is 0.

    Of the four equivalent formulas (Shepperd 1978) the one with the largest divisor is taken, per element.
    """
    m = _matrix(rotation)
    if m.ndim == 2:
        return _one_quaternion(m)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = _stack([[1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz]])[..., 0, :]
    wx, wy, wz = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    xy, xz, yz = m[..., 0, 1] + m[..., 1, 0], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 2] + m[..., 2, 1]
    candidates = _stack(
        [
            [squares[..., 0], wx, wy, wz],
            [wx, squares[..., 1], xy, xz],
            [wy, xy, squares[..., 2], yz],
            [wz, xz, yz, squares[..., 3]],
        ]
    )
    best = np.argmax(squares, axis=-1)
    q = np.take_along_axis(candidates, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    q = np.where(np.abs(q) < 1e-17, 0.0, q)
    lead = np.take_along_axis(q, np.argmax(np.abs(q) > 1e-12, axis=-1)[..., None], axis=-1)
    return np.where(lead < 0, -q, q) + 0.0


def _one_quaternion(rotation: FloatArray) -> FloatArray:
    """`matrix_to_quaternion` of a single rotation (3, 3) in plain numbers, a tenth of the arrays' time."""
    (xx, x_y, x_z), (y_x, yy, y_z), (z_x, z_y, zz) = rotation.tolist()
    squares = (1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz)
    wx, wy, wz, xy, xz, yz = z_y - y_z, x_z - z_x, y_x - x_y, x_y + y_x, x_z + z_x, y_z + z_y
    candidates = (
        (squares[0], wx, wy, wz),
        (wx, squares[1], xy, xz),
        (wy, xy, squares[2], yz),
        (wz, xz, yz, squares[3]),
    )
    q = candidates[squares.index(max(squares))]
    norm = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    lead = next((value for value in q if abs(value) > 1e-12 * norm), 1.0)
    scale = -1.0 / norm if lead < 0.0 else 1.0 / norm
    return np.array([0.0 if abs(value) < 1e-17 * norm else value * scale for value in q])


def rotation_vector_to_matrix(vector_rad: ArrayLike) -> FloatArray:
    """exp([r]×) of rotation vectors (..., 3): axis times angle, radians."""
    v = _triple(vector_rad)
    half = 0.5 * np.linalg.norm(v, axis=-1, keepdims=True)
    # sin(h)/h by numpy's sinc(x) = sin(pi x)/(pi x), which is exact at zero.
    return quaternion_to_matrix(np.concatenate([np.cos(half), 0.5 * v * np.sinc(half / np.pi)], axis=-1))


def matrix_to_rotation_vector(rotation: ArrayLike) -> FloatArray:
    """Rotation vectors (..., 3) in radians, length in [0, pi]."""
    q = matrix_to_quaternion(rotation)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., :1])
    scale = np.where(sine > 1e-15, angle / np.where(sine > 1e-15, sine, 1.0), 2.0)
    return q[..., 1:] * scale + 0.0


def rotation_angle(rotation: ArrayLike) -> FloatArray:
    """The angle (...) in radians, 0..pi, that a rotation turns by."""
    return np.asarray(np.linalg.norm(matrix_to_rotation_vector(rotation), axis=-1), dtype=np.float64)


def slerp(start: ArrayLike, end: ArrayLike, fraction: ArrayLike) -> FloatArray:
    """Rotations (k, 3, 3) at fractions (k,) along the shortest turn from `start` to `end` (3x3), one fixed axis.

    At exactly half a turn the axis is not unique; the one `matrix_to_rotation_vector` chooses is taken.
    """
    first = _matrix(start)
    return turned(first, matrix_to_rotation_vector(first.T @ _matrix(end)), fraction)


def turned(start: FloatArray, turn_rad: FloatArray, fraction: ArrayLike) -> FloatArray:
    """Rotations (..., 3, 3) at fractions (...) of a turn by a rotation vector (3,) in the frame of `start` (3, 3).

    Rodrigues' formula with the matrices of the fixed axis built once for all fractions.
    """
    angle = float(np.linalg.norm(turn_rad))
    share = np.asarray(fraction, dtype=np.float64)
    if angle == 0.0:
        return np.broadcast_to(start, (*share.shape, 3, 3)).copy()
    x, y, z = turn_rad / angle
    across = start @ np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    back = across @ np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angles = share[..., None, None] * angle
    # 1 - cos, without losing the digits of small angles.
    return np.asarray(start + np.sin(angles) * across + 2.0 * np.sin(0.5 * angles) ** 2 * back)


def pose_matrix(xyz: ArrayLike, rotation: ArrayLike | None = None) -> FloatArray:
    """Poses (..., 4, 4) from positions (..., 3) in mm and rotations (..., 3, 3), default no rotation."""
    position = _triple(xyz)
    turn = _matrix(np.eye(3) if rotation is None else rotation)
    lead = np.broadcast_shapes(position.shape[:-1], turn.shape[:-2])
    pose = np.zeros((*lead, 4, 4))
    pose[..., :3, :3] = turn
    pose[..., :3, 3] = position
    pose[..., 3, 3] = 1.0
    return pose


def invert_pose(pose: ArrayLike) -> FloatArray:
    """The inverse of rigid poses (..., 4, 4), by transposition."""
    m = np.asarray(pose, dtype=np.float64)
    turn = np.swapaxes(m[..., :3, :3], -1, -2)
    return pose_matrix(-(turn @ m[..., :3, 3:])[..., 0], turn)


@dataclass(frozen=True, slots=True)
class Convention:
    """One way to write an orientation: how many numbers it takes and the two conversions."""

    count: int
    to_matrix: Callable[[ArrayLike], FloatArray]
    from_matrix: Callable[[ArrayLike], FloatArray]


CONVENTIONS: Mapping[str, Convention] = MappingProxyType(
    {
        "quaternion": Convention(4, quaternion_to_matrix, matrix_to_quaternion),
        "rotation_vector": Convention(3, rotation_vector_to_matrix, matrix_to_rotation_vector),
        "xyz_fixed": Convention(3, xyz_fixed_to_matrix, matrix_to_xyz_fixed),
        "xyz_moving": Convention(3, xyz_moving_to_matrix, matrix_to_xyz_moving),
        "zyx": Convention(3, zyx_to_matrix, matrix_to_zyx),
        "zyz": Convention(3, zyz_to_matrix, matrix_to_zyz),
    }
)
