"""Where a recorded robot moves and where it rests, and what kind of move each motion is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rpl.emulator.rotations import FloatArray

# A robot rests while it moves slower than this share of its highest speed in the log, for at least this long.
SLOW = 0.01
REST_S = 0.03
# How far a motion may leave the straight line between its ends, as a share of it.
STRAIGHT = 0.004


@dataclass(frozen=True, slots=True)
class Motion:
    """From one rest to the next: rows of the log, the first and the last with a rest on their outer side; start and end
    of the motion in s."""

    first: int
    last: int
    start_s: float
    end_s: float


def motions(times: FloatArray, values: FloatArray) -> list[Motion]:
    """The motions of a log: times (k,), values (k, n). The noise is told from rests by its size in the first rows."""
    window = max(round(REST_S / float(np.median(np.diff(times)))), 1)
    span = values[window:] - values[:-window]
    speeds = np.abs(span).max(axis=1) / (times[window:] - times[:-window])
    noise = 3.0 * float(np.quantile(speeds, 0.02))
    moving = speeds > max(SLOW * float(speeds.max()), min(noise, 0.1 * float(speeds.max())))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], moving, [False]]).astype(int)))
    found: list[Motion] = []
    for begin, end in edges.reshape(-1, 2):
        if end - begin < window:
            continue
        first, last = int(begin), int(min(end + window, len(times) - 1))
        start, stop = float(times[min(first + window // 2, last)]), float(times[max(last - window // 2, first)])
        found.append(Motion(first, last, start, stop))
    return found


def is_straight(values: FloatArray) -> bool:
    """Do values (k, n) lie on the line from the first to the last?"""
    way = values[-1] - values[0]
    length = float(np.linalg.norm(way))
    if length < 1e-6:
        return False
    along = (values - values[0]) @ way / length**2
    off = np.linalg.norm(values - values[0] - along[:, None] * way, axis=1)
    return bool(np.quantile(off, 0.95) < STRAIGHT * length)
