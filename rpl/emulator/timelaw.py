"""How far along its path a move is at each moment: the law s(t), s from 0 to 1.

A law is a row of pieces of constant acceleration, which covers the plain trapezoid and a speed profile that slows down
near a singularity alike, and evaluates exactly in both directions. Every move gets its law from its `Profile`, so a
controller with another way of accelerating has one place to go to.
"""

from bisect import bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.rotations import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class TimeLaw:
    """Knots (m,) of time s, path fraction and its speed 1/s; the acceleration is constant between two knots."""

    times: FloatArray
    fractions: FloatArray
    speeds: FloatArray

    @property
    def duration(self) -> float:
        """Length of the move, s."""
        return float(self.times[-1])

    def _piece(self, knots: FloatArray, value: FloatArray) -> np.ndarray[tuple[int, ...], np.dtype[np.intp]]:
        return np.clip(np.searchsorted(knots, value, side="right") - 1, 0, len(knots) - 2)

    def at(self, time_s: ArrayLike) -> FloatArray:
        """Path fractions at times (...), 0 before the start and 1 after the end."""
        t = np.clip(np.asarray(time_s, dtype=np.float64), 0.0, self.duration)
        i = self._piece(self.times, t)
        span = np.maximum(self.times[i + 1] - self.times[i], 1e-300)
        acceleration = (self.speeds[i + 1] - self.speeds[i]) / span
        local = t - self.times[i]
        inside = self.fractions[i] + self.speeds[i] * local + 0.5 * acceleration * local * local
        return np.asarray(np.where(t >= self.duration, 1.0, np.clip(inside, 0.0, 1.0)))

    def fraction_at(self, time_s: float) -> float:
        """What `at` gives for one time, many times faster."""
        times, fractions, speeds = self.times.tolist(), self.fractions.tolist(), self.speeds.tolist()
        t = min(max(time_s, 0.0), times[-1])
        if t >= times[-1]:
            return 1.0
        i = min(max(bisect_right(times, t) - 1, 0), len(times) - 2)
        acceleration = (speeds[i + 1] - speeds[i]) / max(times[i + 1] - times[i], 1e-300)
        local = t - times[i]
        inside: float = fractions[i] + speeds[i] * local + 0.5 * acceleration * local * local
        return min(max(inside, 0.0), 1.0)

    def speed_at(self, time_s: ArrayLike) -> FloatArray:
        """Speeds of the path fraction, 1/s, at times (...)."""
        return np.interp(np.asarray(time_s, dtype=np.float64), self.times, self.speeds)

    def time_of(self, fraction: ArrayLike) -> FloatArray:
        """The times (...) at which the move is at these path fractions: the inverse of `at`."""
        s = np.clip(np.asarray(fraction, dtype=np.float64), 0.0, 1.0)
        i = self._piece(self.fractions, s)
        span = np.maximum(self.times[i + 1] - self.times[i], 1e-300)
        acceleration = (self.speeds[i + 1] - self.speeds[i]) / span
        ahead = s - self.fractions[i]
        root = np.sqrt(np.maximum(self.speeds[i] ** 2 + 2.0 * acceleration * ahead, 0.0))
        local = 2.0 * ahead / np.maximum(self.speeds[i] + root, 1e-300)
        return np.asarray(np.where(s >= 1.0, self.duration, self.times[i] + np.minimum(local, span)))


def at_rest() -> TimeLaw:
    """The law of a move that has nowhere to go: over at once."""
    return TimeLaw(np.zeros(2), np.array([0.0, 1.0]), np.zeros(2))


def travel(speed: float, acceleration: float, start_speed: float = 0.0, end_speed: float = 0.0) -> TimeLaw:
    """The trapezoid (or triangle) over the whole path at a top speed in 1/s and an acceleration in 1/s².

    Start and end speed (1/s) are not zero next to a corner. Where the path is too short to get from one to the other,
    the acceleration is raised as far as it takes. Infinite speed and acceleration mean there is nothing to do.
    """
    if not np.isfinite(speed) or not np.isfinite(acceleration):
        return at_rest()
    squares = start_speed * start_speed, end_speed * end_speed
    acceleration = max(acceleration, 0.5 * abs(squares[1] - squares[0]))
    top = min(max(speed, end_speed), float(np.sqrt(0.5 * (squares[0] + squares[1]) + acceleration)))
    first = abs(top * top - squares[0]) / (2.0 * acceleration)
    last = min((top * top - squares[1]) / (2.0 * acceleration), 1.0 - first)
    cruise = max(1.0 - first - last, 0.0)
    ramps = abs(top - start_speed) / acceleration, (top - end_speed) / acceleration
    return TimeLaw(
        np.cumsum([0.0, ramps[0], cruise / top, ramps[1]]),
        np.array([0.0, first, first + cruise, 1.0]),
        np.array([start_speed, top, top, end_speed]),
    )


def slowed_to(speed: float, acceleration: float, duration_s: float) -> float:
    """The top speed (1/s) that makes a move from rest to rest last that long; `speed` when it cannot be that short."""
    top = min(speed, float(np.sqrt(acceleration)))
    if duration_s <= 1.0 / top + top / acceleration:
        return speed
    wide = acceleration * duration_s
    return 2.0 * acceleration / (wide + float(np.sqrt(max(wide * wide - 4.0 * acceleration, 0.0))))


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """How fast a move may go along its whole path: top speed 1/s, acceleration 1/s², in fractions of the path.

    `ceilings` (m-1,) in 1/s lower the speed in the intervals between `knots` (m,), where an axis would be too slow.
    """

    speed: float
    acceleration: float
    knots: FloatArray | None = None
    ceilings: FloatArray | None = None

    def law(self, begin: float = 0.0, end: float = 1.0, start_speed: float = 0.0, end_speed: float = 0.0) -> TimeLaw:
        """The law over `begin`..`end` of the path, as fractions of that part; boundary speeds in 1/s of the path."""
        part = end - begin
        if part <= 1e-12:
            return at_rest()
        speeds = start_speed / part, end_speed / part
        if self.knots is None or self.ceilings is None:
            return travel(self.speed / part, self.acceleration / part, *speeds)
        inside = (self.knots > begin) & (self.knots < end)
        knots = np.concatenate([[begin], self.knots[inside], [end]])
        holder = np.clip(np.searchsorted(self.knots, knots[:-1], side="right") - 1, 0, len(self.ceilings) - 1)
        ceilings = np.minimum(self.ceilings[holder], self.speed) / part
        return limited((knots - begin) / part, ceilings, self.acceleration / part, *speeds)


def limited(
    fractions: FloatArray, ceilings: FloatArray, acceleration: float, start_speed: float = 0.0, end_speed: float = 0.0
) -> TimeLaw:
    """The fastest law under a speed ceiling (m-1,) in 1/s per interval of `fractions` (m,).

    Ceilings hold inside their interval; ramps are of constant acceleration (1/s²): one sweep forward for speeding up,
    one backward for slowing down (Bobrow 1985, without the dynamics).
    """
    steps = np.diff(fractions)
    top = np.minimum(np.append(ceilings, np.inf), np.insert(ceilings, 0, np.inf))
    top[0], top[-1] = start_speed, end_speed
    for i in range(1, len(top)):
        top[i] = min(top[i], float(np.sqrt(top[i - 1] ** 2 + 2.0 * acceleration * steps[i - 1])))
    for i in range(len(top) - 2, -1, -1):
        top[i] = min(top[i], float(np.sqrt(top[i + 1] ** 2 + 2.0 * acceleration * steps[i])))
    fractions, top = _with_peaks(fractions, top, ceilings, acceleration)
    steps = np.diff(fractions)
    times = np.insert(np.cumsum(2.0 * steps / np.maximum(top[1:] + top[:-1], 1e-300)), 0, 0.0)
    return TimeLaw(times, fractions, top)


def _with_peaks(
    fractions: FloatArray, speeds: FloatArray, ceilings: FloatArray, acceleration: float
) -> tuple[FloatArray, FloatArray]:
    """Insert the ramp-cruise-ramp corners inside intervals whose ceiling lies above both of their ends."""
    positions: list[float] = [float(fractions[0])]
    tops: list[float] = [float(speeds[0])]
    for i, ceiling in enumerate(ceilings):
        low, high, step = float(speeds[i]), float(speeds[i + 1]), float(fractions[i + 1] - fractions[i])
        peak = min(float(ceiling), float(np.sqrt(0.5 * (low * low + high * high) + acceleration * step)))
        up = (peak * peak - low * low) / (2.0 * acceleration)
        down = (peak * peak - high * high) / (2.0 * acceleration)
        if peak > max(low, high) * (1.0 + 1e-12) and up + down <= step * (1.0 + 1e-12):
            positions.append(float(fractions[i]) + up)
            tops.append(peak)
            if up + down < step:
                positions.append(float(fractions[i + 1]) - down)
                tops.append(peak)
        positions.append(float(fractions[i + 1]))
        tops.append(high)
    return np.array(positions), np.array(tops)
