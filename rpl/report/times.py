"""How long a run takes, where the time goes, and how sure that is.

The times of moves follow from the controller's parameters; each of them may be wrong by the share that the controller
file declares. One parameter is wrong in all moves alike, so its effects add up over the run; different parameters are
independent, so their sums combine as the root of the squares.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.planner import PlannedMove
    from rpl.motionmodel import MotionModel
    from rpl.runtime.trace import Event, Leg, RunResult

# What an axis speed that nobody has verified may be wrong by, where the controller file does not say.
UNVERIFIED = 0.1
SAME_S = 1e-6
Effects = dict[str, tuple[float, float]]


@dataclass(frozen=True, slots=True)
class MoveTime:
    """One move, seconds: `driven_s` on its way without corners, `blended_s` in the corner at its end; `low_s`..`high_s`
    is the interval of their sum."""

    origin: Origin
    kind: str
    start_s: float
    driven_s: float
    blended_s: float
    low_s: float
    high_s: float

    @property
    def seconds(self) -> float:
        return self.driven_s + self.blended_s


@dataclass(frozen=True, slots=True)
class RunTimes:
    """The whole run, seconds. `timed_s` and `signal_s`: the robot stood while the program waited for a time, or for a
    condition or answer; `standing_s`: it stood for another reason. `effects`: parameter -> how much earlier and later
    the run may end because of it, the greatest first."""

    controller: str
    moves: tuple[MoveTime, ...]
    total_s: float
    moving_s: float
    blending_s: float
    timed_s: float
    signal_s: float
    standing_s: float
    effects: tuple[tuple[str, float, float], ...]

    @property
    def low_s(self) -> float:
        return max(self.total_s - _root(early for _, early, _ in self.effects), 0.0)

    @property
    def high_s(self) -> float:
        return self.total_s + _root(late for _, _, late in self.effects)

    def as_json(self) -> dict[str, object]:
        return {
            "controller": self.controller,
            "total_s": round(self.total_s, 6),
            "interval_s": [round(self.low_s, 6), round(self.high_s, 6)],
            "moving_s": round(self.moving_s, 6),
            "blending_s": round(self.blending_s, 6),
            "waiting_for_time_s": round(self.timed_s, 6),
            "waiting_for_signals_s": round(self.signal_s, 6),
            "standing_s": round(self.standing_s, 6),
            "effects": [
                {"parameter": name, "early_s": round(a, 6), "late_s": round(b, 6)} for name, a, b in self.effects
            ],
            "moves": [
                {
                    "file": move.origin.file,
                    "line": move.origin.line,
                    "kind": move.kind,
                    "start_s": round(move.start_s, 6),
                    "seconds": round(move.seconds, 6),
                    "blending_s": round(move.blended_s, 6),
                    "interval_s": [round(move.low_s, 6), round(move.high_s, 6)],
                }
                for move in self.moves
            ],
        }


def run_times(result: RunResult, model: RobotModel) -> RunTimes:
    """The times of the moves that the run's first moving task made, and of all that task's waiting."""
    driven = [event for event in result.trace if event.kind == "move" and event.legs]
    task = driven[0].task if driven else ""
    driven = [event for event in driven if event.task == task]
    sums: dict[str, list[float]] = defaultdict(lambda: [0.0, 0.0])
    moves = []
    for event in driven:
        moves.append(_move_time(event, model, sums))
    legs = [leg for event in driven for leg in event.legs]
    _restarts(legs, sums)
    blending = sum(leg.duration_s for leg in legs if leg.plan.kind == "corner")
    moving = sum(leg.duration_s for leg in legs) - blending
    timed, signal, standing = _stood(result, task, legs)
    effects = sorted(
        ((name, early, late) for name, (early, late) in sums.items()), key=lambda each: (-each[2], each[0])
    )
    return RunTimes(
        legs[0].plan.controller.title if legs else "",
        tuple(moves),
        result.time_s,
        moving,
        blending,
        timed,
        signal,
        standing,
        tuple(each for each in effects if each[1] > 0.0 or each[2] > 0.0),
    )


def _root(values: Iterator[float]) -> float:
    return float(np.sqrt(sum(value * value for value in values)))


def _move_time(event: Event, model: RobotModel, sums: dict[str, list[float]]) -> MoveTime:
    own: dict[str, list[float]] = defaultdict(lambda: [0.0, 0.0])
    for leg in event.legs:
        for name, (early, late) in _effects(leg, model).items():
            for table in (own, sums):
                table[name][0] += early
                table[name][1] += late
    blended = sum(leg.duration_s for leg in event.legs if leg.plan.kind == "corner")
    driven = sum(leg.duration_s for leg in event.legs) - blended
    low = driven + blended - _root(early for early, _ in own.values())
    high = driven + blended + _root(late for _, late in own.values())
    return MoveTime(
        event.origin, str(event.data.get("motion", "")), event.legs[0].start_s, driven, blended, max(low, 0.0), high
    )


def _effects(leg: Leg, model: RobotModel) -> Effects:
    """How much shorter and longer a leg may be, by the parameters of its controller and arm."""
    plan, declared = leg.plan, leg.plan.controller.uncertainty
    if plan.kind == "corner":
        return _effects_of_corner(plan)
    joint = plan.kind == "joint"
    speed_share = declared.get("joint_speed", UNVERIFIED if model.uncertain_axes else 0.0) if joint else 0.0
    smoothing = "joint_smoothing_s" if joint else "path_smoothing_s"
    found: Effects = {}
    for name, share, quick, slow in (
        ("joint_speed", speed_share, {"speed": 1.0 + speed_share}, {"speed": 1.0 / (1.0 + speed_share)}),
        *(_by("acceleration", name, declared.get(name, 0.0)) for name in _ramps(plan.controller, joint)),
        _by("smoothing_s", smoothing, declared.get(smoothing, 0.0) if plan.profile.smoothing_s > 0.0 else 0.0),
    ):
        if share > 0.0:
            found[name] = (leg.duration_s * (1.0 - _ratio(plan, quick)), leg.duration_s * (_ratio(plan, slow) - 1.0))
    return {name: (max(early, 0.0), max(late, 0.0)) for name, (early, late) in found.items()}


def _ramps(controller: MotionModel, joint: bool) -> list[str]:
    """The parameters that may decide how long a move speeds up: its ramp, and the acceleration where that is lower."""
    kind = "joint" if joint else "path"
    ramps = [f"{kind}_ramp_s", "joint_ramp_deg"] if joint else [f"{kind}_ramp_s"]
    return [*(name for name in ramps if getattr(controller, name) > 0.0), f"{kind}_acceleration"]


def _effects_of_corner(plan: PlannedMove) -> Effects:
    """`corner` is the error of the time in a corner as such. Its speed goes with the root of the acceleration that
    holds it; where two moves overlap, it lasts in proportion to the overlap and to the ramp beside it."""
    from rpl.emulator.blending import JointCorner

    controller, declared = plan.controller, plan.controller.uncertainty
    powers = {"corner": 1.0}
    if isinstance(plan.geometry, JointCorner):
        powers["joint_acceleration"] = 0.5
    else:
        held = controller.corner_acceleration_mm_s2 is not None
        powers["corner_acceleration_mm_s2" if held else "path_acceleration"] = 0.5
    if controller.overlap:
        powers |= {"overlap": 1.0, "corner_ramp_s": 1.0}
    found: Effects = {}
    for name, power in powers.items():
        wrong = (1.0 + declared.get(name, 0.0)) ** power
        if wrong > 1.0:
            found[name] = (plan.duration_s * (1.0 - 1.0 / wrong), plan.duration_s * (wrong - 1.0))
    return found


def _by(field: str, name: str, share: float) -> tuple[str, float, dict[str, float], dict[str, float]]:
    """A smaller smoothing is quicker, a smaller acceleration slower."""
    more, less = {field: 1.0 + share}, {field: 1.0 / (1.0 + share)}
    return (name, share, less, more) if field == "smoothing_s" else (name, share, more, less)


def _ratio(plan: PlannedMove, factors: dict[str, float]) -> float:
    """How much longer the move's part takes with changed parameters; its speeds at both ends stay, if they can."""
    if plan.duration_s <= 0.0 or not np.isfinite(plan.profile.speed):
        return 1.0
    changed = replace(plan.profile, **{name: getattr(plan.profile, name) * factor for name, factor in factors.items()})
    if changed.deceleration is not None:
        changed = replace(changed, deceleration=changed.deceleration * factors.get("acceleration", 1.0))
    begin, end = plan.span
    first, last = (float(speed) * (end - begin) for speed in (plan.law.speeds[0], plan.law.speeds[-1]))
    top = changed.speed
    return changed.law(begin, end, min(first, top), min(last, top)).duration / plan.duration_s


def _restarts(legs: Sequence[Leg], sums: dict[str, list[float]]) -> None:
    """Moves that began the controller's time after one that stopped exactly."""
    for before, after in pairwise(legs):
        rest = after.plan.controller.restart_s
        share = after.plan.controller.uncertainty.get("restart_s", 0.0)
        if rest > 0.0 and share > 0.0 and abs(after.start_s - before.start_s - before.duration_s - rest) < SAME_S:
            sums["restart_s"][0] += rest * share / (1.0 + share)
            sums["restart_s"][1] += rest * share


def _stood(result: RunResult, task: str, legs: Sequence[Leg]) -> tuple[float, float, float]:
    """Seconds in which the robot stood: for a time, for a condition, for another reason."""
    gaps, at = [], 0.0
    for leg in sorted(legs, key=lambda each: each.start_s):
        gaps.append((at, leg.start_s))
        at = max(at, leg.start_s + leg.duration_s)
    gaps.append((at, result.time_s))
    timed, waited = [], []
    # A move that was ahead of the program may end while it waits: the robot's own events end no wait.
    own = [event for event in result.trace if (not task or event.task == task) and event.kind != "move"]
    ends = {(one.task, one.begin): one.end for one in result.waited}
    for event, after in zip(own, [*own[1:], None], strict=True):
        if event.kind != "wait":
            continue
        seconds = event.data.get("seconds")
        if seconds is not None:
            timed.append((event.t, event.t + float(seconds)))
        else:
            until = ends.get((event.task, event.t), after.t if after is not None else result.time_s)
            waited.append((event.t, until))
    total = sum(max(end - begin, 0.0) for begin, end in gaps)
    for_time, for_signals = _shared(gaps, timed), _shared(gaps, waited)
    return for_time, for_signals, max(total - for_time - for_signals, 0.0)


def _shared(gaps: Sequence[tuple[float, float]], spans: Sequence[tuple[float, float]]) -> float:
    """Seconds that lie in a gap and in a span; both are in order and do not overlap among themselves."""
    total, place = 0.0, 0
    for begin, end in gaps:
        while place < len(spans) and spans[place][1] <= begin:
            place += 1
        look = place
        while look < len(spans) and spans[look][0] < end:
            total += max(min(end, spans[look][1]) - max(begin, spans[look][0]), 0.0)
            look += 1
    return total
