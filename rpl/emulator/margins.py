"""How far a posture is from where an arm loses a direction, and from the ends of its axes.

A singular posture is one where the Jacobian loses rank. For the families with a closed form its determinant is a
product of three factors, one for each way of losing it, so each is shown by itself: the wrist straight, the elbow
stretched or folded, the wrist centre over axis 1. All margins are 0 in the singular posture and at most about 1.
"""

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.arms import OpwArm, ScaraArm, UrArm
from rpl.emulator.model import RobotModel
from rpl.emulator.recognise import PlacedArm
from rpl.emulator.rotations import FloatArray

__all__ = ["conditioning", "limit_margins", "manipulability", "singular_factors"]


def singular_factors(model: RobotModel, joints: ArrayLike) -> dict[str, FloatArray]:
    """The factors of the Jacobian's determinant by name, each (k,) for joints (k, n), all non-negative.

    `wrist` and `elbow` are sines; `shoulder` is the distance of the wrist centre from axis 1 in the plane of the arm,
    by the length of the stretched arm. Empty for an arm without a closed form.
    """
    theta, arm = model.theta(joints), model.arm
    if isinstance(arm, PlacedArm):
        arm = arm.arm
    if isinstance(arm, OpwArm):
        reach, _ = arm.in_plane(theta)
        stretched = arm.c2 + float(np.hypot(arm.a2, arm.c3))
        return {
            "wrist": np.abs(np.sin(theta[..., 4])),
            "elbow": np.abs(np.sin(theta[..., 2] + arm.elbow_angle)),
            "shoulder": np.abs(reach) / stretched,
        }
    if isinstance(arm, UrArm):
        elbow, total = theta[..., 1] + theta[..., 2], theta[..., 1:4].sum(axis=-1)
        along = arm.a2 * np.cos(theta[..., 1]) + arm.a3 * np.cos(elbow) + arm.d5 * np.sin(total)
        return {
            "wrist": np.abs(np.sin(theta[..., 4])),
            "elbow": np.abs(np.sin(theta[..., 2])),
            "shoulder": np.abs(along) / (abs(arm.a2) + abs(arm.a3)),
        }
    if isinstance(arm, ScaraArm):
        return {"elbow": np.abs(np.sin(theta[..., 1]))}
    return {}


def _singular_values(model: RobotModel, joints: ArrayLike) -> FloatArray:
    """The values (k, m), m at most 6, of the Jacobian for joints (k, n), lengths by the distance of the flange from the
    base, so that lengths and angles can be compared."""
    jacobian = model.jacobian(joints)
    reach = np.maximum(np.linalg.norm(model.forward(joints)[..., :3, 3], axis=-1), 1.0)
    # A sliding joint is counted by the metre, or its column would vanish beside those of turning ones.
    jacobian = jacobian * np.where(model.revolute, 1.0, 1000.0)
    scaled = np.concatenate([jacobian[..., :3, :] / reach[..., None, None], jacobian[..., 3:, :]], axis=-2)
    return np.asarray(np.linalg.svd(scaled, compute_uv=False)[..., : min(model.axes, 6)])


def conditioning(model: RobotModel, joints: ArrayLike) -> FloatArray:
    """Smallest by largest singular value of the Jacobian (k,), 0 to 1: the inverse of its condition number."""
    values = _singular_values(model, joints)
    return np.asarray(values[..., -1] / np.maximum(values[..., 0], 1e-300))


def manipulability(model: RobotModel, joints: ArrayLike) -> FloatArray:
    """Yoshikawa's measure (k,): the product of the singular values, lengths by the flange's distance from the base."""
    return np.asarray(np.prod(_singular_values(model, joints), axis=-1))


def limit_margins(model: RobotModel, joints: ArrayLike) -> FloatArray:
    """How far each joint is from its nearer end (k, n), by half of its range: 1 in the middle, 0 at an end, negative
    outside. An axis without ends, or with nowhere to go, is 1."""
    q = np.asarray(joints, dtype=np.float64)
    low, high = model.limits[:, 0], model.limits[:, 1]
    half = 0.5 * (high - low)
    bounded = np.isfinite(half) & (half > 0.0)
    room = np.minimum(q - low, high - q)
    return np.where(bounded, room / np.where(bounded, half, 1.0), 1.0)
