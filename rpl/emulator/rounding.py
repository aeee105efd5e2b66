"""Values that decide something are rounded before they decide it.

Sines and arc tangents of two mathematical libraries differ in their last place, and so do sums that two processors add
in another order. What is counted, chosen or compared here must not hang on that: where a value lies on a boundary by
design (a way of exactly 100 mm, an axis half a turn away), noise would put it on either side.
"""

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.rotations import FloatArray

# Far above the noise of double precision in mm, degrees, seconds and shares, and far below what a robot repeats.
PLACES = 9
NOISE = 1e-9
# Shorter ways (mm) and smaller turns (degrees) of a path are what rounding leaves of none.
NO_WAY = 1e-6


def steps_of(whole: float, each: float, fewest: int, most: int) -> int:
    """Into how many steps of at most `each` a whole is cut, between `fewest` and `most`."""
    return int(np.clip(np.ceil(whole / each - NOISE), fewest, most))


def whole_turns(degrees: ArrayLike) -> FloatArray:
    """The nearest whole numbers of turns (...) in degrees (...); exactly between two, the even one."""
    return np.asarray(np.round(np.round(np.asarray(degrees, dtype=np.float64) / 360.0, PLACES)))


def first_least(values: ArrayLike, axis: int = -1) -> np.ndarray[tuple[int, ...], np.dtype[np.intp]]:
    """Where the least of the values stands along an axis; of equal ones, as far as rounding lets them be equal, the
    first."""
    return np.asarray(np.argmin(np.round(np.asarray(values, dtype=np.float64), PLACES), axis=axis))


def settled(joints_deg: ArrayLike) -> FloatArray:
    """Angles (...), of which those as good as a multiple of 90 degrees are that: where controllers' flags change."""
    angles = np.asarray(joints_deg, dtype=np.float64)
    quarters = np.rint(angles / 90.0) * 90.0
    return np.where(np.abs(angles - quarters) < NOISE, quarters + 0.0, angles)
