"""Rules of a spline block about its speeds: parts driven at one speed, parts driven in a given time.

KSS 8 operating and programming instructions, CONST_VEL and TIME_BLOCK. A constant part begins and ends at a distance
from a point; where the robot cannot have reached the speed there, the speed is lowered, at a stop the part begins where
it is reached. The time of a block is kept exactly, its shares as well as they can be; where it is too short the block
is driven as fast as it may. M: the programmed speeds stay the ceiling of both, and a part of a time is slowed evenly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray
from rpl.emulator.timelaw import Profile, TimeLaw

if TYPE_CHECKING:
    from rpl.emulator.splines import Run

# Halvings of a factor's logarithm, rounds over the parts of a time, and the slowest factor.
_HALVINGS, _ROUNDS, _SLOWEST = 44, 8, 1e-6
# Times (s) and speeds (as shares) that agree that well are equal.
_SAME_S, _SAME_SHARE = 1e-7, 1e-6
_LOWERINGS = 60


@dataclass(frozen=True, slots=True)
class BlockRule:
    """A line between the segments of a block, behind `at` of them: see `ir.PathRule`. `value`: a share, s or mm."""

    at: int
    rule: str
    value: float
    reference: str


def ruled(runs: Sequence[Run], rules: Sequence[BlockRule]) -> list[Run]:
    """The runs of a block with other speeds along them; their paths stay."""
    profiles = [run.move.profile for run in runs]
    for begin, end in _constant_parts(runs, rules):
        profiles = [_constant(run, profile, *_inside(runs, number, begin, end))
                    for number, (run, profile) in enumerate(zip(runs, profiles, strict=True))]  # fmt: skip
    for timed in _timed_parts(rules):
        profiles = _in_time(runs, profiles, *timed)
    return [_driven(run, profile) for run, profile in zip(runs, profiles, strict=True)]


def _driven(run: Run, profile: Profile) -> Run:
    if profile is run.move.profile:
        return run
    law = profile.law()
    return replace(run, move=replace(run.move, profile=profile, law=law, duration_s=law.duration))


def _divided(profile: Profile, places: Sequence[float]) -> tuple[FloatArray, FloatArray]:
    """Knots (m,) and ceilings (m-1,) of a profile, with knots at these fractions too."""
    old = profile.knots if profile.knots is not None else np.array([0.0, 1.0])
    values = profile.ceilings if profile.ceilings is not None else np.array([profile.speed])
    knots = np.union1d(old, np.clip(places, 0.0, 1.0))
    holder = np.clip(np.searchsorted(old, knots[:-1], side="right") - 1, 0, len(values) - 1)
    return knots, np.minimum(values[holder], profile.speed)


# ---- one speed


def _places(runs: Sequence[Run]) -> list[FloatArray]:
    """Where the segments of each run begin and end, mm along the whole block: (m+1,) of each run."""
    done: list[FloatArray] = []
    before = 0.0
    for run in runs:
        ways = before + run.move.geometry.distance(np.array([0.0, *run.marks]))
        done.append(ways)
        before = float(ways[-1])
    return done


def _constant_parts(runs: Sequence[Run], rules: Sequence[BlockRule]) -> list[tuple[float, float]]:
    """Begin and end of each constant part, mm along the block; without an end it goes on to that of the block."""
    ways = _places(runs)
    starts = [float(way) for part in ways for way in part[:-1]]
    ends = [float(way) for part in ways for way in part[1:]]
    last = ends[-1]
    done: list[tuple[float, float]] = []
    begin: float | None = None
    for rule in rules:
        if rule.rule not in ("constant_start", "constant_end"):
            continue
        here = (starts if rule.reference == "start" else ends)[rule.at] if rule.at < len(ends) else last
        place = min(max(here + rule.value, 0.0), last)
        if rule.rule == "constant_start":
            begin = place
        elif begin is not None:
            done.append((begin, place))
            begin = None
    return done if begin is None else [*done, (begin, last)]


def _inside(runs: Sequence[Run], number: int, begin: float, end: float) -> tuple[float, float]:
    """That part of the block as fractions of one of its runs."""
    ways = _places(runs)[number]
    first, last = float(ways[0]), float(ways[-1])
    geometry = runs[number].move.geometry
    shares = [
        0.0 if way <= first else 1.0 if way >= last else geometry.fraction_at(way - first) for way in (begin, end)
    ]
    return shares[0], shares[1]


def _constant(run: Run, profile: Profile, begin: float, end: float) -> Profile:
    """One speed from `begin` to `end`, fractions of the run."""
    if end - begin < 1e-9 or not np.isfinite(profile.speed):
        return profile
    knots, ceilings = _divided(profile, (begin, end))
    within = (knots[:-1] >= begin - 1e-12) & (knots[1:] <= end + 1e-12)
    low = float(ceilings[within].min())
    made = profile
    for _ in range(_LOWERINGS):
        ceilings = np.where(within, low, ceilings)
        made = replace(profile, speed=float(ceilings.max()), knots=knots, ceilings=ceilings)
        law = made.law()
        bounds = [share for share in (begin, end) if 1e-9 < share < 1.0 - 1e-9]
        reached = [float(law.speed_at(law.time_of(share))) for share in bounds]
        lowest = min([low, *reached])
        if lowest >= low * (1.0 - _SAME_SHARE):
            break
        low = lowest
    return made


# ---- a time


@dataclass(frozen=True, slots=True)
class _Area:
    """From one point of the block to another (numbers of points from its start) in a share of the time."""

    first: int
    last: int
    share: float


def _timed_parts(rules: Sequence[BlockRule]) -> list[tuple[list[_Area], float]]:
    """The areas of each time block and its time."""
    done: list[tuple[list[_Area], float]] = []
    begin: int | None = None
    parts: list[_Area] = []
    for rule in rules:
        match rule.rule:
            case "time_start":
                begin, parts = rule.at, []
            case "time_part" if begin is not None:
                parts.append(_Area(parts[-1].last if parts else begin, rule.at, rule.value))
            case "time_end" if begin is not None:
                whole = parts or [_Area(begin, rule.at, 1.0)]
                if rule.value > 0.0 and sum(one.share for one in whole) > 0.0:
                    done.append((whole, rule.value))
                begin = None
    return done


def _in_time(runs: Sequence[Run], profiles: Sequence[Profile], areas: Sequence[_Area], time_s: float) -> list[Profile]:
    """The profiles slowed down so that the areas take `time_s` together."""
    block = _Timed.of(runs, profiles, areas)
    wanted = [time_s * one.share / sum(area.share for area in areas) for one in areas]
    factors = [1.0] * len(areas)
    if sum(block.times(factors)) >= time_s:
        return list(profiles)
    for _ in range(_ROUNDS):
        for number, goal in enumerate(wanted):

            def alone(factor: float, number: int = number) -> float:
                return block.times([*factors[:number], factor, *factors[number + 1 :]])[number]

            factors[number] = _factor(alone, goal)
        if all(abs(a - b) < _SAME_S for a, b in zip(block.times(factors), wanted, strict=True)):
            break

    def together(factor: float) -> float:
        return sum(block.times([min(1.0, factor * one) for one in factors]))

    highest = 1.0 / min(factors)
    common = highest * _factor(lambda factor: together(highest * factor), time_s)
    return block.slowed([min(1.0, common * one) for one in factors])


def _factor(time_of: Callable[[float], float], goal: float) -> float:
    """The factor up to 1 with which it takes that time; 1 where it takes longer anyway."""
    if time_of(1.0) >= goal:
        return 1.0
    low, high = np.log(_SLOWEST), 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if time_of(float(np.exp(middle))) > goal:
            low = middle
        else:
            high = middle
    return float(np.exp(0.5 * (low + high)))


@dataclass(frozen=True, slots=True, eq=False)
class _Timed:
    """The runs of a block cut at the points of a time. `owner` (m-1,) of each run: the area of each interval or -1;
    `bounds`: of each run its parts of areas, as area and fractions."""

    profiles: tuple[Profile, ...]
    divided: tuple[tuple[FloatArray, FloatArray], ...]
    owner: tuple[FloatArray, ...]
    bounds: tuple[tuple[tuple[int, float, float], ...], ...]

    @classmethod
    def of(cls, runs: Sequence[Run], profiles: Sequence[Profile], areas: Sequence[_Area]) -> _Timed:
        divided, owner, bounds = [], [], []
        before = 0
        for run, profile in zip(runs, profiles, strict=True):
            points = (0.0, *run.marks)
            parts = []
            for number, area in enumerate(areas):
                first, last = (min(max(point - before, 0), len(run.marks)) for point in (area.first, area.last))
                if first < last:
                    parts.append((number, points[first], points[last]))
            knots, ceilings = _divided(profile, points)
            belongs = np.full(len(ceilings), -1.0)
            for number, first_share, last_share in parts:
                belongs[(knots[:-1] >= first_share - 1e-12) & (knots[1:] <= last_share + 1e-12)] = number
            divided.append((knots, ceilings))
            owner.append(belongs)
            bounds.append(tuple(parts))
            before += len(run.marks)
        return cls(tuple(profiles), tuple(divided), tuple(owner), tuple(bounds))

    def slowed(self, factors: Sequence[float]) -> list[Profile]:
        """The profiles with the ceilings of each area times its factor."""
        scale = np.array([*factors, 1.0])
        done = []
        for profile, (knots, ceilings), owner in zip(self.profiles, self.divided, self.owner, strict=True):
            if (owner < 0.0).all() or not np.isfinite(profile.speed):
                done.append(profile)
                continue
            lower = ceilings * scale[owner.astype(np.intp)]
            done.append(replace(profile, speed=float(lower.max()), knots=knots, ceilings=lower))
        return done

    def times(self, factors: Sequence[float]) -> list[float]:
        """How long each area takes, s."""
        done = [0.0] * len(factors)
        for profile, bounds in zip(self.slowed(factors), self.bounds, strict=True):
            law: TimeLaw | None = None
            for number, first, last in bounds:
                law = law or profile.law()
                done[number] += float(law.time_of(last)) - float(law.time_of(first))
        return done


__all__ = ["BlockRule", "ruled"]
