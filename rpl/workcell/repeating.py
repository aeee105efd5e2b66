"""Many runs of one cell, each with the next seed, and what they have in common."""

from __future__ import annotations

import math
import statistics as numbers
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from typing import TYPE_CHECKING

from rpl.workcell.knocks import run_and_look
from rpl.workcell.outcome import outcome_of
from rpl.workcell.running import Driven, run_cell

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.runtime.limits import Limits
    from rpl.runtime.values import Value


@dataclass(frozen=True, slots=True)
class OneOfMany:
    """A run of a cell in short."""

    seed: int
    status: str
    time_s: float
    cycles: tuple[float, ...]
    grasps: int
    missed: int
    lost: int
    collisions: int | None = None  # None: nobody looked


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean and the 95 % confidence interval around it; of one value alone there is none."""

    mean: float
    low: float
    high: float
    count: int

    def as_json(self) -> dict[str, Value]:
        return {"mean": round(self.mean, 6), "low": round(self.low, 6), "high": round(self.high, 6), "n": self.count}


@dataclass(frozen=True, slots=True)
class Statistics:
    """Of many runs: how they ended, and means with their confidence intervals."""

    runs: tuple[OneOfMany, ...]
    statuses: tuple[tuple[str, int], ...]
    time_s: Interval
    cycle_s: Interval | None
    held: Interval | None  # share of the closings that held a part

    @property
    def collisions(self) -> int | None:
        """Of all runs; None where nobody looked."""
        counts = [one.collisions for one in self.runs if one.collisions is not None]
        return sum(counts) if counts else None

    def as_json(self) -> dict[str, Value]:
        return {
            "runs": len(self.runs),
            "statuses": dict(self.statuses),
            "time_s": self.time_s.as_json(),
            "cycle_s": self.cycle_s.as_json() if self.cycle_s is not None else None,
            "grasped": self.held.as_json() if self.held is not None else None,
            "lost_parts": sum(one.lost for one in self.runs),
            "collisions": self.collisions,
            "seeds": [
                {"seed": one.seed, "status": one.status, "time_s": round(one.time_s, 6), "missed": one.missed}
                for one in self.runs
            ],
        }

    def lines(self) -> Iterator[str]:
        """For people."""
        ends = ", ".join(f"{count} {status}" for status, count in self.statuses)
        yield f"{len(self.runs)} runs: {ends}"
        if self.collisions is None:
            yield "collisions were not looked for (--collisions does)"
        else:
            hit = sum(bool(one.collisions) for one in self.runs)
            yield f"{hit} runs with collisions, {self.collisions} in all"
        rows = (("time", self.time_s, " s"), ("cycle", self.cycle_s, " s"), ("grasps that hold", self.held, ""))
        for name, one, unit in rows:
            if one is not None:
                yield f"{name}: {one.mean:.3f}{unit} ({one.low:.3f} to {one.high:.3f} with 95 % confidence)"


def repeat(
    cell: Cell, driven: Sequence[Driven], limits: Limits, times: int, jobs: int, look: bool = False
) -> tuple[OneOfMany, ...]:
    """Run the cell so often, from its own seed on; `jobs` processes share the work, whose result is the same. `look`:
    for collisions too."""
    seeds = range(cell.seed, cell.seed + times)
    if jobs == 1:
        return tuple(_one(replace(cell, seed=seed), driven, limits, look) for seed in seeds)
    with ProcessPoolExecutor(min(jobs, times), mp_context=get_context("spawn")) as pool:
        count = len(seeds)
        cells = [replace(cell, seed=seed) for seed in seeds]
        return tuple(pool.map(_one, cells, [driven] * count, [limits] * count, [look] * count))


def _one(cell: Cell, driven: Sequence[Driven], limits: Limits, look: bool) -> OneOfMany:
    collisions = None
    if look:
        run, found, _ = run_and_look(cell, driven, limits)
        collisions = len(found.collisions)
    else:
        run = run_cell(cell, driven, limits)
    outcome = outcome_of(run)
    closings = [one for one in outcome.grasps if not one.lost]
    missed = sum(not one.ok for one in closings)
    lost = sum(one.state == "lost" for one in outcome.parts)
    cycles = tuple(time for _, times in outcome.cycles for time in times)
    return OneOfMany(cell.seed, run.status, run.time_s, cycles, len(closings), missed, lost, collisions)


def statistics(runs: Sequence[OneOfMany]) -> Statistics:
    """What many runs have in common."""
    cycles = [time for one in runs for time in one.cycles]
    closings, held = sum(one.grasps for one in runs), sum(one.grasps - one.missed for one in runs)
    return Statistics(
        tuple(runs),
        tuple(Counter(one.status for one in runs).most_common()),
        of_mean([one.time_s for one in runs]),
        of_mean(cycles) if cycles else None,
        of_share(held, closings) if closings else None,
    )


def of_mean(values: Sequence[float]) -> Interval:
    """The interval of Student's t around a mean."""
    mean, count = numbers.fmean(values), len(values)
    if count < 2:
        return Interval(mean, mean, mean, count)
    half = student_t(count - 1) * numbers.stdev(values) / math.sqrt(count)
    return Interval(mean, mean - half, mean + half, count)


def of_share(hits: int, of: int) -> Interval:
    """Wilson's score interval (1927) of a share."""
    z = numbers.NormalDist().inv_cdf(0.975)
    share, weight = hits / of, z * z / of
    middle = (share + weight / 2.0) / (1.0 + weight)
    half = z * math.sqrt(share * (1.0 - share) / of + weight / (4.0 * of)) / (1.0 + weight)
    return Interval(share, max(middle - half, 0.0), min(middle + half, 1.0), of)


def student_t(freedom: int) -> float:
    """The 97.5 % quantile of Student's distribution with so many degrees of freedom.

    Of one and two in closed form, else the expansion of Cornish and Fisher in 1 / freedom (Abramowitz and Stegun,
    26.7.5), which is within 0.7 % at three.
    """
    if freedom == 1:
        return math.tan(math.pi * 0.475)
    if freedom == 2:
        return 0.95 * math.sqrt(2.0 / (1.0 - 0.95**2))
    z, n = numbers.NormalDist().inv_cdf(0.975), float(freedom)
    terms = (
        (z**3 + z) / 4.0,
        (5 * z**5 + 16 * z**3 + 3 * z) / 96.0,
        (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384.0,
        (79 * z**9 + 776 * z**7 + 1482 * z**5 - 1920 * z**3 - 945 * z) / 92160.0,
    )
    return z + sum(term / n**power for power, term in enumerate(terms, 1))
