"""The sweep of one pair of pieces along a block: all contacts, to within 10 microseconds, and the least distance.

Conservative advancement (Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996, ch. 2): where the
distance is d, nothing can touch until both together have gone d; so distances are measured only where the bounds of the
way and of the boxes about the pieces leave it open. Between two moments the pieces are where the plans of the robots
say.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray
from rpl.workcell.sweeping.tracks import STILL, Block, Piece, Track
from rpl.workcell.sweeping.ways import Way

if TYPE_CHECKING:
    import coal

# A contact is deeper than this, mm.
TOUCH_MM = 0.01
# Between two moments of the block a contact may be missed that is less deep than half of this, mm; where jaws slide
# along what they grip, which may touch them, it is not looked for as closely.
FINE_MM, COARSE_MM = TOUCH_MM / 2.0, 1.0
# Moments of beginning and end of a contact are known to this.
SHARP_S = 1e-5
_GOLDEN = 0.6180339887498949


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """Two pieces touch from `start_s` to `end_s`; `point` (3,) in the cell where they do first; `depth_mm` at most, at
    `deepest_s`."""

    start_s: float
    end_s: float
    deepest_s: float
    depth_mm: float
    point: FloatArray


@dataclass
class Least:
    """The least distance of two things so far, mm, below which one is looked for; `t` None while none was found."""

    distance_mm: float
    t: float | None = None
    point: FloatArray = field(default_factory=lambda: np.zeros(3))
    asked: Callable[[float], float] | None = None
    around: tuple[float, float] = (0.0, 0.0)


class Meter:
    """Measures distances of pieces by coal: at moments of a block, and at any other."""

    def __init__(self, ways: tuple[Way, ...]) -> None:
        import coal

        self.ways = ways
        self.request = coal.DistanceRequest()
        self.request.enable_signed_distance = True
        self.result = coal.DistanceResult()
        self.count = 0
        self._measure, self._pose = coal.distance, coal.Transform3s
        self._links: dict[tuple[int, float], FloatArray] = {}

    def at_knot(self, a: Track, b: Track, knot: int) -> float:
        """The signed distance in mm at a moment of the block."""
        return self.between(a.piece, a.transform(knot), b.piece, b.transform(knot))

    def at(self, a: Piece, b: Piece, t: float) -> float:
        """The signed distance in mm at any moment."""
        return self.between(a, self.pose(a, t), b, self.pose(b, t))

    def between(self, a: Piece, at_a: coal.Transform3s, b: Piece, at_b: coal.Transform3s) -> float:
        self.result.clear()
        self.count += 1
        return float(self._measure(a.solid.geometry, at_a, b.solid.geometry, at_b, self.request, self.result))

    def pose(self, piece: Piece, t: float) -> coal.Transform3s:
        """Where a piece is at a moment, by the plan that is driven then."""
        if piece.way == STILL:
            pose = piece.at
        else:
            links = self._links.get((piece.way, t))
            if links is None:
                if len(self._links) > 64:
                    self._links.clear()
                links = self._links[piece.way, t] = self.ways[piece.way].links(np.array([t]))[0]
            pose = links[piece.link] @ piece.at
        return self._pose(np.ascontiguousarray(pose[:3, :3]), np.ascontiguousarray(pose[:3, 3]))

    def point(self) -> FloatArray:
        """Between the nearest points of what was measured last (3,)."""
        return np.asarray((self.result.getNearestPoint1() + self.result.getNearestPoint2()) / 2.0)


class PairSweep:
    """Goes along one pair. `level_mm`: distances below it are contact (below zero for what rests on something);
    `least`: the least distance of both things, None where it is not asked for; `fine_mm`: see FINE_MM."""

    def __init__(
        self,
        meter: Meter,
        block: Block,
        tracks: tuple[Track, Track],
        level_mm: float,
        least: Least | None,
        fine_mm: float = FINE_MM,
    ) -> None:
        self.meter, self.times = meter, block.times
        self.a, self.b = tracks
        self.level, self.least, self.fine_mm = level_mm, least, fine_mm
        self.first = max(self.a.first, self.b.first)
        self.last = min(self.a.last, self.b.last)
        rows = [slice(track.row(self.first), track.row(self.last) + 1) for track in tracks]
        self.rows = rows
        bounds = [track.bound[row.start : row.stop - 1] for track, row in zip(tracks, rows, strict=True)]
        count = self.last - self.first
        self.bound = np.zeros(count) + sum(bound for bound in bounds if len(bound))
        self.summed = np.concatenate([[0.0], np.cumsum(self.bound)])
        self.found: list[Contact] = []

    def contacts(self) -> list[Contact]:
        """All contacts of the block in their order."""
        if self.last <= self.first:
            return []
        limit = 0.0 if self.least is None else max(self.least.distance_mm, 0.0)  # boxes do not say how deep
        open_intervals = self._open(limit)
        number, known = 0, -1
        before = 0.0
        while number < len(open_intervals):
            interval = int(open_intervals[number])
            here = before if known == interval else self._measured(interval)
            if here < self.level:
                known, before = self._along_contact(interval, self._time(interval), here)
                number = int(open_intervals.searchsorted(known))
                continue
            wanted = self.level if self.least is None else max(min(self.least.distance_mm, here), self.level)
            safe = int(self.summed.searchsorted(self.summed[interval] + here - wanted, side="right")) - 1
            if safe > interval:
                number = int(open_intervals.searchsorted(safe))
                continue
            before = self._measured(interval + 1)
            known = interval + 1
            touched = self._between(interval, here, before)
            if touched is not None:
                known, before = self._along_contact(interval + 1, touched, before)
            number = int(open_intervals.searchsorted(known))
        return self.found

    def _open(self, limit: float) -> NDArray[np.int64]:
        """Intervals in which the boxes about both may come nearer than the limit."""
        (centre_a, half_a), (centre_b, half_b) = (
            (track.centre[row], track.half[row]) for track, row in zip((self.a, self.b), self.rows, strict=True)
        )
        gaps = np.maximum(np.abs(centre_a - centre_b) - (half_a + half_b), 0.0)
        apart = np.sqrt((gaps * gaps).sum(axis=1))
        return np.flatnonzero((apart[1:] + apart[:-1] - self.bound) / 2.0 <= limit)

    def _time(self, knot: int) -> float:
        return float(self.times[self.first + knot])

    def _measured(self, knot: int) -> float:
        """The distance at a moment of the pair; remembers it where it is the least."""
        found = self.meter.at_knot(self.a, self.b, self.first + knot)
        least = self.least
        if least is not None and found < least.distance_mm:
            least.distance_mm, least.t = found, self._time(knot)
            least.asked = self._asked
            least.around = (self._time(max(knot - 1, 0)), self._time(min(knot + 1, self.last - self.first)))
        return found

    def _asked(self, t: float) -> float:
        return self.meter.at(self.a.piece, self.b.piece, t)

    def _between(self, interval: int, here: float, after: float) -> float | None:
        """When in an interval that begins without contact the first one begins; None without any."""
        start, end = self._time(interval), self._time(interval + 1)
        if after < self.level:
            return self._crossing(start, end)
        bound = float(self.bound[interval])
        if here + after - bound >= 2.0 * self.level:
            return None
        inside = self._dig((start, here), (end, after), bound)
        return None if inside is None else self._crossing(start, inside)

    def _dig(self, start: tuple[float, float], end: tuple[float, float], bound: float) -> float | None:
        """A moment of contact between two moments without, where both together go at most `bound`."""
        if start[1] + end[1] - bound >= 2.0 * self.level or bound < self.fine_mm or end[0] - start[0] < SHARP_S / 10.0:
            return None
        middle = (start[0] + end[0]) / 2.0
        there = self._asked(middle)
        if there < self.level:
            return middle
        found = self._dig(start, (middle, there), bound / 2.0)
        return found if found is not None else self._dig((middle, there), end, bound / 2.0)

    def _crossing(self, outside: float, inside: float) -> float:
        """Where contact begins or ends between a moment without and one with it."""
        while abs(inside - outside) > SHARP_S:
            middle = (inside + outside) / 2.0
            if self._asked(middle) < self.level:
                inside = middle
            else:
                outside = middle
        return inside

    def _along_contact(self, knot: int, start: float, here: float) -> tuple[int, float]:
        """Follows a contact that began at `start`, at or before a moment, to its end: the next moment without it, or
        the last one, and the distance there."""
        self._asked(start)
        point = self.meter.point()
        deepest, depth, end = start, -self._asked(start), start
        last = self.last - self.first
        inside = here < self.level
        while inside:
            if -here > depth:
                deepest, depth = self._time(knot), -here
            end = self._time(knot)
            if knot == last:
                break
            knot += 1
            here = self._measured(knot)
            inside = here < self.level
        if not inside:
            end = self._crossing(self._time(knot), end)
        around = (max(deepest - self._widest, start), min(deepest + self._widest, end))
        deepest, depth = _lowest(self._asked, around, (deepest, -depth))
        self.found.append(Contact(start, end, deepest, -depth, point))
        return knot, here

    @property
    def _widest(self) -> float:
        return float(np.max(np.diff(self.times[self.first : self.last + 1])[self.bound > 0.0], initial=0.0))


def _lowest(
    asked: Callable[[float], float], around: tuple[float, float], known: tuple[float, float]
) -> tuple[float, float]:
    """The moment with the lowest value about a known one, by golden sections."""
    low, high = around
    first, second = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_first, at_second = asked(first), asked(second)
    while high - low > 4.0 * SHARP_S:
        if at_first <= at_second:
            high, second, at_second = second, first, at_first
            first = high - _GOLDEN * (high - low)
            at_first = asked(first)
        else:
            low, first, at_first = first, second, at_second
            second = low + _GOLDEN * (high - low)
            at_second = asked(second)
    return min(known, (first, at_first), (second, at_second), key=lambda one: one[1])


def sharpened(least: Least, point: Callable[[], FloatArray]) -> Least:
    """The least distance between its neighbours instead of at a moment of the block; `point` tells where it was."""
    if least.t is None or least.asked is None:
        return least
    t, distance = _lowest(least.asked, least.around, (least.t, least.distance_mm))
    least.asked(t)
    return Least(distance, t, point())
