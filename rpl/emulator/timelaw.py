"""How far along its path a move is at each moment: the law s(t), s from 0 to 1.

A law is a row of pieces of constant acceleration, which covers the plain trapezoid and a speed profile that slows down
near a singularity alike, and evaluates exactly in both directions. Controllers smooth that with a moving average over
the speed (an S-curve: the acceleration rises and falls evenly): the law keeps its knots and the width of that average,
and evaluates the average exactly. Every move gets its law from its `Profile`, so a controller with another way of
accelerating has one place to go to.
"""

from bisect import bisect_right
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from rpl.emulator.rotations import FloatArray

# Halvings of the width of an average: 0.2 s ends below a picosecond.
BISECTIONS = 38
# Most of the way that is left over by the ramps which may be driven evenly for the sake of the average.
EVEN_SHARE = 0.98
# A narrower average would be lost in rounding.
NARROWEST_S = 1e-5


@dataclass(frozen=True, slots=True, eq=False)
class TimeLaw:
    """Knots (m,) of time s, path fraction and its speed 1/s; the acceleration is constant between two knots.

    `smoothing_s`: the width of the moving average that is driven instead of the knots themselves. Outside of the knots
    the first and last speed go on for ever, so a law that stands or goes evenly for half that width at its ends (as
    `Profile.law` makes them) begins and ends exactly where its knots do.
    """

    times: FloatArray
    fractions: FloatArray
    speeds: FloatArray
    smoothing_s: float = 0.0

    @property
    def duration(self) -> float:
        """Length of the move, s."""
        return float(self.times[-1])

    def _piece(self, knots: FloatArray, value: FloatArray) -> np.ndarray[tuple[int, ...], np.dtype[np.intp]]:
        # The inner knots alone: what lies outside of all belongs to the first or the last piece.
        return np.searchsorted(knots[1:-1], value, side="right")

    def _accelerations(self) -> FloatArray:
        return np.diff(self.speeds) / np.maximum(np.diff(self.times), 1e-300)

    def _knot_fraction(self, t: FloatArray) -> FloatArray:
        """Path fractions by the knots alone, going on evenly outside of them."""
        i = self._piece(self.times, t)
        inside = np.clip(t, 0.0, self.duration)
        local = inside - self.times[i]
        fraction = self.fractions[i] + self.speeds[i] * local + 0.5 * self._accelerations()[i] * local * local
        outside = t - inside
        return np.asarray(fraction + np.where(outside < 0.0, self.speeds[0], self.speeds[-1]) * outside)

    def _integral(self, t: FloatArray) -> FloatArray:
        """The integral of `_knot_fraction` from 0 to times t."""
        steps, accelerations = np.diff(self.times), self._accelerations()
        pieces = steps * (self.fractions[:-1] + steps * (self.speeds[:-1] / 2.0 + steps * accelerations / 6.0))
        sums = np.cumsum(pieces) - pieces
        i = self._piece(self.times, t)
        inside = np.minimum(np.maximum(t, 0.0), self.times[-1])
        local = inside - self.times[i]
        halves, sixths = self.speeds / 2.0, accelerations / 6.0
        whole = sums[i] + local * (self.fractions[i] + local * (halves[i] + local * sixths[i]))
        out = t - inside
        edge = np.where(out < 0.0, self.fractions[0], self.fractions[-1])
        return np.asarray(whole + out * (edge + out * np.where(out < 0.0, self.speeds[0], self.speeds[-1]) / 2.0))

    def at(self, time_s: ArrayLike) -> FloatArray:
        """Path fractions at times (...), 0 before the start and 1 after the end."""
        t = np.clip(np.asarray(time_s, dtype=np.float64), 0.0, self.duration)
        half = 0.5 * self.smoothing_s
        if half > 0.0:
            ahead, behind = self._integral(np.stack([t + half, t - half]))
            inside = (ahead - behind) / self.smoothing_s
        else:
            inside = self._knot_fraction(t)
        return np.asarray(np.where(t >= self.duration, 1.0, np.clip(inside, 0.0, 1.0)))

    def fraction_at(self, time_s: float) -> float:
        """What `at` gives for one time, many times faster."""
        if self.smoothing_s > 0.0:
            return float(self.at(time_s))
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
        t = np.asarray(time_s, dtype=np.float64)
        half = 0.5 * self.smoothing_s
        if half <= 0.0:
            return np.interp(t, self.times, self.speeds)
        t = np.clip(t, 0.0, self.duration)
        return np.asarray((self._knot_fraction(t + half) - self._knot_fraction(t - half)) / self.smoothing_s)

    def time_of(self, fraction: ArrayLike) -> FloatArray:
        """The times (...) at which the move is at these path fractions: the inverse of `at`."""
        s = np.clip(np.asarray(fraction, dtype=np.float64), 0.0, 1.0)
        i = self._piece(self.fractions, s)
        span = np.maximum(self.times[i + 1] - self.times[i], 1e-300)
        acceleration = (self.speeds[i + 1] - self.speeds[i]) / span
        ahead = s - self.fractions[i]
        root = np.sqrt(np.maximum(self.speeds[i] ** 2 + 2.0 * acceleration * ahead, 0.0))
        local = 2.0 * ahead / np.maximum(self.speeds[i] + root, 1e-300)
        base = self.times[i] + np.minimum(local, span)
        if self.smoothing_s > 0.0:
            base = self._smoothed_time_of(s, base)
        return np.asarray(np.where(s >= 1.0, self.duration, base))

    def _smoothed_time_of(self, s: FloatArray, near: FloatArray) -> FloatArray:
        """By bisection: the average is never further from the knots than half its width."""
        low, high = near - 0.5 * self.smoothing_s, near + 0.5 * self.smoothing_s
        low, high = np.clip(low, 0.0, self.duration), np.clip(high, 0.0, self.duration)
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            before = self.at(middle) < s
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return np.asarray(0.5 * (low + high))


def at_rest() -> TimeLaw:
    """The law of a move that has nowhere to go: over at once."""
    return TimeLaw(np.zeros(2), np.array([0.0, 1.0]), np.zeros(2))


def travel(
    speed: float,
    acceleration: float,
    start_speed: float = 0.0,
    end_speed: float = 0.0,
    braking: float | None = None,
) -> TimeLaw:
    """The trapezoid (or triangle) over the whole path at a top speed in 1/s and an acceleration in 1/s².

    Start and end speed (1/s) are not zero next to a corner; `braking` (1/s²) slows down to the end speed, where that is
    not the same. Where the path is too short to get from one to the other, the acceleration is raised as far as it
    takes. Infinite speed and acceleration mean there is nothing to do.
    """
    if not np.isfinite(speed) or not np.isfinite(acceleration):
        return at_rest()
    squares = start_speed * start_speed, end_speed * end_speed
    up = max(acceleration, 0.5 * (squares[1] - squares[0]))
    down = max(acceleration if braking is None else braking, 0.5 * (squares[0] - squares[1]))
    peak = (2.0 * up * down + down * squares[0] + up * squares[1]) / (up + down)
    top = min(max(speed, end_speed), float(np.sqrt(peak)))
    begin = up if top >= start_speed else down
    first = abs(top * top - squares[0]) / (2.0 * begin)
    last = min((top * top - squares[1]) / (2.0 * down), 1.0 - first)
    cruise = max(1.0 - first - last, 0.0)
    ramps = abs(top - start_speed) / begin, (top - end_speed) / down
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


def of_constant_time(speed: float, ramp_s: float) -> float:
    """The acceleration (1/s²) of a controller that speeds up in one time at any speed: a move at top `speed` (1/s)
    lasts 1/speed + ramp_s, also where it is too short to reach that speed (measured: fidelity, joint moves)."""
    if ramp_s * speed <= 1.0:
        return speed / ramp_s
    return 4.0 / (1.0 / speed + ramp_s) ** 2


def mean_acceleration(up: float, down: float) -> float:
    """The one acceleration with which a move from rest to rest lasts as long as with two of them (1/s²)."""
    return up if up == down else 2.0 * up * down / (up + down)


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """How fast a move may go along its whole path: top speed 1/s, acceleration 1/s², in fractions of the path.

    `ceilings` (m-1,) in 1/s lower the speed in the intervals between `knots` (m,), where an axis would be too slow.
    `smoothing_s` is the width of the moving average over the speed. `deceleration` (1/s²): where slowing down differs
    from speeding up. `rising`, `braking`: the accelerations (1/s²) out of the corner before and into the corner behind,
    where ramps beside corners differ from those beside a stop. `stopping_s`: by how much the average is wider where the
    move comes to rest; the ramp there lasts longer by it (a model: it keeps its form).
    """

    speed: float
    acceleration: float
    knots: FloatArray | None = None
    ceilings: FloatArray | None = None
    smoothing_s: float = 0.0
    rising: float | None = None
    braking: float | None = None
    deceleration: float | None = None
    stopping_s: float = 0.0

    @property
    def down(self) -> float:
        """The acceleration (1/s²) with which it slows down, away from corners."""
        return self.acceleration if self.deceleration is None else self.deceleration

    @property
    def slowest(self) -> float:
        """The lowest of its accelerations, 1/s²."""
        return min(self.acceleration, self.down, self.rising or np.inf, self.braking or np.inf)

    @property
    def peak(self) -> float:
        """The highest speed (1/s) that a move from rest to rest comes to."""
        return min(self.speed, float(np.sqrt(mean_acceleration(self.acceleration, self.down))))

    def braked(self, braking: float, stop_ramp: float) -> "Profile":
        """The profile of one acceleration with another one for slowing down, `braking` times that for speeding up, and
        the same time from rest to rest; `stop_ramp`: the share of the rate at which its deceleration changes that it
        has before a stop."""
        wider = self.smoothing_s * (1.0 / stop_ramp - 1.0) if stop_ramp < 1.0 else 0.0
        if braking == 1.0:
            return replace(self, stopping_s=wider) if wider > 0.0 else self
        rising = self.acceleration * 0.5 * (1.0 + 1.0 / braking)
        return replace(self, acceleration=rising, deceleration=rising * braking, stopping_s=wider)

    def _into(self, end_speed: float) -> float:
        """The acceleration (1/s²) towards an end at that speed (1/s)."""
        if self.braking:
            return self.braking
        if end_speed > 0.0 or self.stopping_s <= 0.0 or not np.isfinite(self.speed):
            return self.down
        return 1.0 / (1.0 / self.down + self.stopping_s / self.peak)

    def law(self, begin: float = 0.0, end: float = 1.0, start_speed: float = 0.0, end_speed: float = 0.0) -> TimeLaw:
        """The law over `begin`..`end` of the path, as fractions of that part; boundary speeds in 1/s of the path.

        Where the part is too short for the whole average between two speeds, that is narrowed as far as it takes.
        """
        part = end - begin
        if part <= 1e-12:
            return at_rest()
        width = self._smoothing_of(part, start_speed, end_speed)
        lead, tail = 0.5 * width * start_speed, 0.5 * width * end_speed
        return _smoothed(self.unsmoothed(begin + lead, end - tail, start_speed, end_speed), lead, tail, part, width)

    def _smoothing_of(self, part: float, start_speed: float, end_speed: float) -> float:
        sum_of_speeds = start_speed + end_speed
        if sum_of_speeds <= 0.0 or self.smoothing_s <= 0.0:
            return self.smoothing_s if np.isfinite(self.speed) else 0.0
        if part < 1e-6:
            return 0.0
        needed = abs(end_speed * end_speed - start_speed * start_speed) / (2.0 * self.slowest)
        width = min(self.smoothing_s, 2.0 * (part - needed) / sum_of_speeds * EVEN_SHARE)
        return width if width > NARROWEST_S else 0.0

    def unsmoothed(self, begin: float, end: float, start_speed: float = 0.0, end_speed: float = 0.0) -> TimeLaw:
        """The law of constant accelerations over a part of the path: what `law` averages."""
        part = end - begin
        if part <= 1e-12:
            return at_rest()
        speeds = start_speed / part, end_speed / part
        up, down = (self.rising or self.acceleration) / part, self._into(end_speed) / part
        if self.knots is None or self.ceilings is None:
            return travel(self.speed / part, up, *speeds, down)
        inside = (self.knots > begin) & (self.knots < end)
        knots = np.concatenate([[begin], self.knots[inside], [end]])
        holder = np.clip(np.searchsorted(self.knots, knots[:-1], side="right") - 1, 0, len(self.ceilings) - 1)
        ceilings = np.minimum(self.ceilings[holder], self.speed) / part
        return limited((knots - begin) / part, ceilings, up, *speeds, down)


def _smoothed(law: TimeLaw, lead: float, tail: float, part: float, width: float) -> TimeLaw:
    """The law with half an average's width of even motion (or rest) at both ends, as fractions of `part`."""
    if width <= 0.0 or law.duration <= 0.0:
        return law
    share = (part - lead - tail) / part
    fractions = (lead + law.fractions * (part - lead - tail)) / part
    speeds = law.speeds * share
    times = np.concatenate([[0.0], law.times + 0.5 * width, [law.duration + width]])
    return TimeLaw(
        times, np.concatenate([[0.0], fractions, [1.0]]), np.concatenate([speeds[:1], speeds, speeds[-1:]]), width
    )


def limited(
    fractions: FloatArray,
    ceilings: FloatArray,
    acceleration: float,
    start_speed: float = 0.0,
    end_speed: float = 0.0,
    braking: float | None = None,
) -> TimeLaw:
    """The fastest law under a speed ceiling (m-1,) in 1/s per interval of `fractions` (m,).

    Ceilings hold inside their interval; ramps are of constant acceleration (1/s²; `braking` where slowing down
    differs): one sweep forward for speeding up, one backward for slowing down (Bobrow 1985, without the dynamics).
    """
    down = acceleration if braking is None else braking
    steps = np.diff(fractions)
    top = np.minimum(np.append(ceilings, np.inf), np.insert(ceilings, 0, np.inf))
    top[0], top[-1] = start_speed, end_speed
    for i in range(1, len(top)):
        top[i] = min(top[i], float(np.sqrt(top[i - 1] ** 2 + 2.0 * acceleration * steps[i - 1])))
    for i in range(len(top) - 2, -1, -1):
        top[i] = min(top[i], float(np.sqrt(top[i + 1] ** 2 + 2.0 * down * steps[i])))
    fractions, top = _with_peaks(fractions, top, ceilings, acceleration, down)
    steps = np.diff(fractions)
    times = np.insert(np.cumsum(2.0 * steps / np.maximum(top[1:] + top[:-1], 1e-300)), 0, 0.0)
    return TimeLaw(times, fractions, top)


def _with_peaks(
    fractions: FloatArray, speeds: FloatArray, ceilings: FloatArray, rising: float, braking: float
) -> tuple[FloatArray, FloatArray]:
    """Insert the ramp-cruise-ramp corners inside intervals whose ceiling lies above both of their ends."""
    positions: list[float] = [float(fractions[0])]
    tops: list[float] = [float(speeds[0])]
    for i, ceiling in enumerate(ceilings):
        low, high, step = float(speeds[i]), float(speeds[i + 1]), float(fractions[i + 1] - fractions[i])
        highest = (2.0 * rising * braking * step + braking * low * low + rising * high * high) / (rising + braking)
        peak = min(float(ceiling), float(np.sqrt(highest)))
        up = (peak * peak - low * low) / (2.0 * rising)
        down = (peak * peak - high * high) / (2.0 * braking)
        if peak > max(low, high) * (1.0 + 1e-12) and up + down <= step * (1.0 + 1e-12):
            positions.append(float(fractions[i]) + up)
            tops.append(peak)
            if up + down < step:
                positions.append(float(fractions[i + 1]) - down)
                tops.append(peak)
        positions.append(float(fractions[i + 1]))
        tops.append(high)
    return np.array(positions), np.array(tops)
