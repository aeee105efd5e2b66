"""Small bounded least squares (Levenberg, Marquardt) with numeric derivatives, and how well each number is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rpl.emulator.rotations import FloatArray

STEP = 1e-3
ROUNDS = 25
ENOUGH = 1e-4
# A parameter that changes the residuals by less than this, in parts of the noise, has no say.
NO_SAY = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """Values (n,), their standard deviations (n,) (infinite: without any say), residuals (k,) and evaluations."""

    values: FloatArray
    deviations: FloatArray
    residuals: FloatArray
    evaluations: int


def least_squares(
    residuals: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    low: FloatArray,
    high: FloatArray,
    typical: FloatArray,
) -> Found:
    """Minimise the sum of squares of `residuals` (k,) over values (n,) within their bounds, from `start`; `typical`
    (n,) is the size of each value, which fixes the steps."""
    values, damping, count = np.clip(start, low, high), 1e-2, 1
    now = residuals(values)
    slopes = np.zeros((len(now), len(values)))
    for _ in range(ROUNDS):
        slopes = _slopes(residuals, values, now, low, high, typical)
        count += len(values)
        step, after = None, now
        for _ in range(8):
            square = slopes.T @ slopes
            grid = square + damping * np.diag(np.maximum(np.diag(square), 1e-12 * max(square.max(), 1e-300)))
            tried = np.clip(values + typical * np.linalg.lstsq(grid, -slopes.T @ now, rcond=None)[0], low, high)
            after = residuals(tried)
            count += 1
            if after @ after < now @ now:
                step = (tried - values) / typical
                damping = max(damping / 5.0, 1e-9)
                break
            damping *= 4.0
        if step is None:
            break
        values, now = values + step * typical, after
        if np.abs(step).max() < ENOUGH:
            break
    slopes = _slopes(residuals, values, now, low, high, typical)
    return Found(values, _deviations(slopes, now) * typical, now, count + len(values))


def _slopes(
    residuals: Callable[[FloatArray], FloatArray],
    values: FloatArray,
    now: FloatArray,
    low: FloatArray,
    high: FloatArray,
    typical: FloatArray,
) -> FloatArray:
    """Derivatives (k, n) by the values in parts of their typical size."""
    columns = []
    for place, size in enumerate(typical):
        moved = values.copy()
        step = STEP * size if values[place] + STEP * size <= high[place] else -STEP * size
        moved[place] = max(values[place] + step, low[place])
        columns.append((residuals(moved) - now) / ((moved[place] - values[place]) / size))
    return np.stack(columns, axis=1)


def _deviations(slopes: FloatArray, residuals: FloatArray) -> FloatArray:
    """Standard deviations (n,) in parts of the typical size: the noise is what is left over."""
    free = max(len(residuals) - slopes.shape[1], 1)
    noise = float(residuals @ residuals) / free
    says = np.linalg.norm(slopes, axis=0) > NO_SAY * max(np.sqrt(noise), 1e-9)
    found = np.full(slopes.shape[1], np.inf)
    if says.any():
        inner = slopes[:, says]
        found[says] = np.sqrt(np.maximum(np.diag(np.linalg.pinv(inner.T @ inner)) * noise, 0.0))
    return found
