"""How far the joints follow behind their command: one first-order lag per axis.

A position loop with a proportional gain K and without feed-forward is a lag with the time constant T = 1/K: at the
speed v a joint is v T behind. Real drives feed the speed forward and are nearer; that is what the time constant is for.
"""

import numpy as np

from rpl.emulator.rotations import FloatArray


def lagged(times: FloatArray, joints: FloatArray, lag_s: FloatArray | float) -> FloatArray:
    """Joints (k, n) that follow commanded ones (k, n), which run straight between times (k,) s, with time constants
    `lag_s` (n,) or one for all; exact for such a command, from rest on it. T y' = u - y."""
    constants = np.broadcast_to(np.asarray(lag_s, dtype=np.float64), joints.shape[1:])
    if not np.all(constants > 0.0):
        return joints.copy()
    steps = np.diff(times)
    slopes = np.divide(
        np.diff(joints, axis=0), steps[:, None], out=np.zeros((len(steps), joints.shape[1])), where=steps[:, None] > 0.0
    )
    behind = slopes * constants
    decay = np.exp(-steps[:, None] / constants)
    gain = behind * (1.0 - decay)
    gap = np.zeros(joints.shape[1])
    gaps = np.empty_like(joints)
    gaps[0] = 0.0
    for row in range(len(steps)):
        gap = gap * decay[row] + gain[row]
        gaps[row + 1] = gap
    return joints - gaps


def off_path(path: FloatArray, points: FloatArray, back: int) -> FloatArray:
    """Distance (k,) of each point (k, 3) from the polyline through path (k, 3) between `back` samples before it and its
    own: how far the tool leaves its way, however late it is."""
    nearest = np.linalg.norm(points - path, axis=1)
    for offset in range(min(back, len(path) - 1)):
        begin, end = path[: len(path) - offset - 1], path[1 : len(path) - offset]
        here = points[offset + 1 :]
        way = end - begin
        length = np.maximum((way * way).sum(axis=1), 1e-300)
        share = np.clip(((here - begin) * way).sum(axis=1) / length, 0.0, 1.0)
        distance = np.linalg.norm(here - begin - share[:, None] * way, axis=1)
        nearest[offset + 1 :] = np.minimum(nearest[offset + 1 :], distance)
    return np.asarray(nearest)
