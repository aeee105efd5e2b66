"""How far two programs are: the moment at which one of them is where the other one is at a given moment.

Two controllers never drive equally fast, so an input that comes at one moment on the clock comes at two places of the
way. What is to be the same for both is where they are: at the same stop, as long after they have come there; or on the
way between two stops, as far from the first one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, takewhile, zip_longest
from typing import TYPE_CHECKING

import numpy as np

from rpl.proof.recording import Way, ways_of

if TYPE_CHECKING:
    from rpl import ir
    from rpl.runtime.trace import RunResult

# Two stops are one where they lie so near, and about as far along the way (mm, and share of the way).
_NEAR_MM, _ALONG_MM, _ALONG_SHARE = 1.0, 50.0, 0.05
_AHEAD = 4  # so many stops that only one program makes may come before the next common one
_HALVINGS = 40
_SOON_S = 1e-6
_DECIMALS = 6


@dataclass(frozen=True, slots=True)
class _Stop:
    """The robot stands from `begin` to `end` (s), `along` mm behind the start, at a point (mm)."""

    begin: float
    end: float
    along: float
    at: tuple[float, float, float]


class Progress:
    """The way of a run's only robot, and where it stands."""

    def __init__(self, way: Way) -> None:
        self.way = way
        self.stops = tuple(_stops(way))

    def when(self, along: float, begin: float, end: float) -> float:
        """When the tool has come so far, between two moments; the end when it does not."""
        if self.way.at(end)[0] < along:
            return end
        for _ in range(_HALVINGS):
            middle = (begin + end) / 2
            begin, end = (middle, end) if self.way.at(middle)[0] < along else (begin, middle)
        return end


def progress_of(result: RunResult, program: ir.Program) -> Progress | None:
    """The progress of a run; None where no robot moves, or several do."""
    moving = [way for way in ways_of(result, program).values() if way.moves]
    return Progress(moving[0]) if len({way.mover for way in moving}) == 1 else None


def moment(time_s: float, ours: Progress, theirs: Progress) -> float:
    """When the second run is where the first one is at a moment (s)."""
    pairs = _paired(ours.stops, theirs.stops)
    number = max((number for number, (a, _) in enumerate(pairs) if a.begin <= time_s + _SOON_S), default=None)
    if number is None:
        return time_s
    a, b = pairs[number]
    if time_s <= a.end + _SOON_S:
        return round(b.begin + max(0.0, time_s - a.begin), _DECIMALS)
    following = pairs[number + 1] if number + 1 < len(pairs) else None
    stood = next((one for one in ours.stops if one.begin <= time_s <= one.end), None)  # where the other does not stop
    since = stood.begin if stood is not None else time_s
    gone = ours.way.at(since)[0] - a.along
    if following is not None:
        whole, other = following[0].along - a.along, following[1].along - b.along
        if whole > 0.0 and abs(whole - other) <= _ALONG_SHARE * whole:
            gone *= other / whole  # corners are cut in two ways
    end = following[1].begin if following is not None else theirs.stops[-1].begin
    return round(theirs.when(b.along + gone, min(b.end, end), end) + time_s - since, _DECIMALS)


def _stops(way: Way) -> Iterator[_Stop]:
    """Where the robot stands: before its first move, behind each that ends in rest, behind the last one."""
    point = way.at(0.0)[2]
    assert point is not None  # the way has moves
    yield _Stop(0.0, way.legs[0].start_s, 0.0, point)
    resting = {id(event.legs[-1]) for event in way.moves if event.stops}
    for leg, following in pairwise(way.legs):
        end = leg.start_s + leg.duration_s
        if following.start_s > end + _SOON_S or id(leg) in resting:
            yield _stop(way, end, max(end, following.start_s))
    last = way.legs[-1]
    yield _stop(way, last.start_s + last.duration_s, float("inf"))


def _stop(way: Way, begin: float, end: float) -> _Stop:
    along, _, point = way.at(begin)
    assert point is not None  # the way has moves
    return _Stop(begin, end, along, point)


def _paired(ours: Sequence[_Stop], theirs: Sequence[_Stop]) -> list[tuple[_Stop, _Stop]]:
    """Common stops in order: those at one point, and between them the others where both have as many (a sensor ends two
    moves at slightly different points)."""
    exact, ahead = [(0, 0)], 1
    for number, one in enumerate(ours[1:], 1):
        for place in range(ahead, min(ahead + _AHEAD, len(theirs))):
            if _is_near(one, theirs[place], _NEAR_MM):
                exact.append((number, place))
                ahead = place + 1
                break
    pairs: list[tuple[_Stop, _Stop]] = []
    for (a, b), following in zip_longest(exact, exact[1:], fillvalue=(len(ours), len(theirs))):
        pairs.append((ours[a], theirs[b]))
        between, other = ours[a + 1 : following[0]], theirs[b + 1 : following[1]]
        if len(between) == len(other) or following[0] == len(ours):
            pairs += takewhile(lambda both: _is_near(*both), zip(between, other, strict=False))
    return pairs


def _is_near(a: _Stop, b: _Stop, mm: float = _ALONG_MM) -> bool:
    far = abs(a.along - b.along) > _ALONG_MM + _ALONG_SHARE * max(a.along, b.along)
    return not far and float(np.linalg.norm(np.subtract(a.at, b.at))) <= mm


__all__ = ["Progress", "moment", "progress_of"]
