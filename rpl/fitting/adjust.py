"""The two ways of fitting: with the program that was run, which is driven again and again, and with a log alone.

Motions of the log are compared one by one, each shifted in time so that it fits best, since nobody knows when exactly
a recording began and what a controller did between two moves; the shifts themselves show how long moves and rests are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from rpl.errors import UsageError
from rpl.fitting.log import Log
from rpl.fitting.parameters import BY_NAME, Parameter, prepared, values_of, with_values
from rpl.fitting.shapes import Motion, is_straight, motions
from rpl.fitting.squares import Found, least_squares
from rpl.motionmodel import MotionModel

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray
    from rpl.emulator.timelaw import TimeLaw
    from rpl.simulation import RunResult

Drive = Callable[[MotionModel], "RunResult"]
MOST_MOMENTS = 3000
# How much a difference of times counts beside the differences of places: as a place at this share of the top speed.
TIME_SHARE = 0.3
SHIFTS = 4
WELL, POORLY = 0.05, 0.3
AT_BOUND = 1e-6
# By how much the ends of motions may miss those of the program, as a share of the way that it spans.
ELSEWHERE = 0.1
# Factors by which the numbers of a log are too small in another unit: rad, m, inches.
UNITS = {"deg": {57.29577951308232: "rad"}, "mm": {1000.0: "m", 25.4: "inches"}}
NUDGE_S = 1e-4


@dataclass(frozen=True, slots=True)
class Told:
    """What the log says of one parameter: its value and standard deviation, and its value before."""

    name: str
    value: float
    before: float
    deviation: float

    @property
    def determined(self) -> str:
        """In one word or two."""
        if not np.isfinite(self.deviation):
            return "not at all"
        share = self.deviation / max(abs(self.value), 1e-12)
        bounds = BY_NAME[self.name]
        if self.value <= bounds.low * (1.0 + AT_BOUND) + 1e-12 < self.before or self.value >= bounds.high * (
            1.0 - AT_BOUND
        ):
            return "at its bound"
        return "well" if share < WELL else "poorly" if share < POORLY else "hardly"


@dataclass(frozen=True, slots=True)
class MoveTime:
    """One motion from rest to rest: when it begins in the log, how long it lasts there and in the emulation, s."""

    start_s: float
    measured_s: float
    emulated_s: float


@dataclass(frozen=True, slots=True)
class Fitted:
    """A controller fitted to a log, and what is left over: rms and largest difference in the log's unit."""

    controller: MotionModel
    parameters: tuple[Told, ...]
    rms: float
    largest: float
    unit: str
    moments: int
    moves: tuple[MoveTime, ...]


def fit_with_program(
    log: Log, robot: RobotModel, base: MotionModel, parameters: tuple[Parameter, ...], drive: Drive
) -> Fitted:
    """Adjust the parameters so that the program, driven by `drive`, moves as the log does."""
    log = log.thinned(MOST_MOMENTS)
    start = prepared(base, robot)
    recorded = motions(log.times, log.values)
    _need(recorded, log)
    compared = _Compared(log, recorded, drive)
    if len(compared.emulated(start)) != len(recorded):
        raise UsageError(
            f"{log.path}: the log shows {len(recorded)} motions from rest to rest, the program makes "
            f"{len(compared.emulated(start))}: does the log belong to it, whole and with its rests?"
        )
    compared.need_same_places(start)
    found = _adjusted(lambda model: compared.residuals(model), start, parameters)
    model, told = _told(start, parameters, found)
    return _fitted(model, told, *compared.left(model), log)


def fit_alone(log: Log, robot: RobotModel, base: MotionModel, parameters: tuple[Parameter, ...]) -> Fitted:
    """Adjust ramps, accelerations and smoothing to the speed over the straight moves of a log."""
    log = log.thinned(MOST_MOMENTS)
    start = prepared(base, robot)
    recorded = motions(log.times, log.values)
    _need(recorded, log)
    moves = [move for motion in recorded if (move := _straight(log, motion, robot)) is not None]
    if not moves:
        raise UsageError(
            f"{log.path}: no motion from rest to rest is straight, in joints or in space: give the program"
        )
    model, told = start, list[Told]()
    for kind in ("joint", "path"):
        able = tuple(p for p in parameters if p.name.partition("_")[0] == kind)
        mine = [move for move in moves if move.joint == (kind == "joint")]
        if able and mine:
            found = _adjusted(partial(_left_over, mine), model, able)
            model, here = _told(model, able, found)
            told += here
    silent = [
        Told(p.name, value, value, np.inf)
        for p, value in zip(parameters, values_of(start, parameters), strict=True)
        if p.name not in {one.name for one in told}
    ]
    left = _left_over(moves, model)
    times = tuple(MoveTime(move.start_s, *move.durations(model)) for move in moves)
    return _fitted(model, (*told, *silent), left, times, log)


def _need(recorded: list[Motion], log: Log) -> None:
    if not recorded:
        raise UsageError(f"{log.path}: the robot does not move in this log")


def _adjusted(
    residuals: Callable[[MotionModel], FloatArray], start: MotionModel, parameters: tuple[Parameter, ...]
) -> Found:
    low, high, typical = (np.array([getattr(p, name) for p in parameters]) for name in ("low", "high", "typical"))
    first = np.array(values_of(start, parameters))
    return least_squares(
        lambda values: residuals(with_values(start, parameters, values.tolist())), first, low, high, typical
    )


def _told(start: MotionModel, parameters: tuple[Parameter, ...], found: Found) -> tuple[MotionModel, tuple[Told, ...]]:
    before = values_of(start, parameters)
    told = tuple(
        Told(p.name, float(value) if np.isfinite(deviation) else old, old, float(deviation))
        for p, value, old, deviation in zip(parameters, found.values, before, found.deviations, strict=True)
    )
    return with_values(start, parameters, [one.value for one in told]), told


def _fitted(
    model: MotionModel, told: tuple[Told, ...], left: FloatArray, times: tuple[MoveTime, ...], log: Log
) -> Fitted:
    known = dict(model.uncertainty)
    for one in told:
        if np.isfinite(one.deviation):
            known[one.name] = round(max(2.0 * one.deviation / max(abs(one.value), 1e-9), 0.005), 4)
    source = f"Fitted to {log.path.rpartition('/')[2]}: {len(log.times)} moments, {len(times)} motions."
    model = replace(model, source=source, uncertainty=known)
    rms = float(np.sqrt(np.mean(left**2)))
    return Fitted(model, told, rms, float(np.abs(left).max()), log.unit, len(log.times), times)


# ---- with the program


@dataclass(frozen=True, slots=True, eq=False)
class _Compared:
    """A log against runs of the program."""

    log: Log
    recorded: list[Motion]
    drive: Drive

    def emulated(self, model: MotionModel) -> list[Motion]:
        return self._run(model)[2]

    def _run(self, model: MotionModel) -> tuple[FloatArray, FloatArray, list[Motion]]:
        """Times, values and motions of a run, at the step of the log."""
        result = self.drive(model)
        step = float(np.median(np.diff(self.log.times)))
        times: FloatArray = np.arange(-5.0, result.time_s / step + 6.0) * step
        values = run_at(result, times, self.log.joints)
        return times, values, motions(times, values)

    def need_same_places(self, model: MotionModel) -> None:
        """Raises UsageError where the motions of the log end at other places than those of the program."""
        _, values, made = self._run(model)
        seen = np.stack([self.log.values[motion.last] for motion in self.recorded])
        meant = np.stack([values[motion.last] for motion in made])
        span = float(np.ptp(values, axis=0).max())
        off = np.abs(seen - meant).max(axis=1)
        if off.max() <= ELSEWHERE * span:
            return
        unit, number = self.log.unit, int(np.argmax(off > ELSEWHERE * span))
        for factor, name in UNITS[unit].items():
            if np.abs(seen * factor - meant).max() <= ELSEWHERE * span:
                raise UsageError(f"{self.log.path}: the log's places are in {name}; {unit} are needed")
        raise UsageError(
            f"{self.log.path}: motion {number + 1} of the log, begun at {self.recorded[number].start_s:g} s, ends "
            f"{off[number]:.4g} {unit} from where the program's ends: other signs or another order of joints, another "
            "frame or tool, or another program?"
        )

    def residuals(self, model: MotionModel) -> FloatArray:
        """Differences of places, and those of times as places."""
        times, values, made = self._run(model)
        if len(made) != len(self.recorded):  # another number of rests: no better than anything
            return np.full(self._count(values.shape[1]), 1e3)
        found, shifts = [], []
        for mine, other in zip(self.recorded, made, strict=True):
            left, shift = self._against(mine, other, times, values)
            found.append(left.ravel())
            shifts.append(shift)
        top = float(np.abs(np.diff(values, axis=0)).max() / (times[1] - times[0]))
        return np.concatenate([*found, TIME_SHARE * top * np.diff(shifts)])

    def _count(self, width: int) -> int:
        return sum(m.last - m.first + 1 for m in self.recorded) * width + len(self.recorded) - 1

    def left(self, model: MotionModel) -> tuple[FloatArray, tuple[MoveTime, ...]]:
        """Differences of places alone, and how long each motion lasts in both."""
        times, values, made = self._run(model)
        lefts = [
            self._against(mine, other, times, values)[0].ravel()
            for mine, other in zip(self.recorded, made, strict=True)
        ]
        pairs = zip(self.recorded, made, strict=True)
        return np.concatenate(lefts), tuple(
            MoveTime(mine.start_s, mine.end_s - mine.start_s, other.end_s - other.start_s) for mine, other in pairs
        )

    def _against(self, mine: Motion, other: Motion, times: FloatArray, values: FloatArray) -> tuple[FloatArray, float]:
        rows = slice(mine.first, mine.last + 1)
        clock, seen = self.log.times[rows], self.log.values[rows]
        step, shift = float(times[1] - times[0]), mine.start_s - other.start_s
        left = np.zeros_like(seen)
        for _ in range(SHIFTS):
            here = np.stack([np.interp(clock - shift, times, column) for column in values.T], axis=1)
            later = np.stack([np.interp(clock - shift + step, times, column) for column in values.T], axis=1)
            speed = (later - here) / step
            left = here - seen
            shift += float((left * speed).sum() / max((speed * speed).sum(), 1e-12))
        return left, shift


def run_at(result: RunResult, times: FloatArray, joints: bool) -> FloatArray:
    """Joints (k, n) or places of the tool (k, 3) of a run at these moments; before, between and behind its moves where
    the robot stands."""
    legs = sorted(
        (leg for event in result.trace if event.kind == "move" for leg in event.legs if leg.duration_s > 0.0),
        key=lambda leg: leg.start_s,
    )
    if not legs:
        raise UsageError("the program makes no move")
    pieces = []
    for place, (leg, after) in enumerate(pairwise([*legs, None])):
        assert leg is not None  # only the last is none
        begin = -np.inf if place == 0 else leg.start_s
        end = np.inf if after is None else after.start_s
        local = np.clip(times[(times >= begin) & (times < end)] - leg.start_s, 0.0, leg.duration_s) + leg.offset_s
        if len(local):
            pieces.append(leg.plan.joints_at(local) if joints else leg.plan.tcp_at(local)[:, :3, 3])
    return np.concatenate(pieces)


# ---- without a program


@dataclass(frozen=True, slots=True, eq=False)
class _Move:
    """A straight motion: moments (k,) and how far it is (k,) in deg or mm, of `length`; `strongest`: its acceleration
    in 1/s² of the whole way when the axes have theirs, for a joint move."""

    times: FloatArray
    ways: FloatArray
    length: float
    joint: bool
    strongest: float
    start_s: float
    end_s: float

    def law(self, model: MotionModel, duration_s: float) -> TimeLaw:
        """The law of that controller that lasts so long."""
        from rpl.emulator.timelaw import Profile, of_constant_time, slowed_to

        ramp_s = model.joint_ramp_s if self.joint else model.path_ramp_s
        smoothing_s = model.joint_smoothing_s if self.joint else model.path_smoothing_s
        moving_s = max(duration_s - smoothing_s, 0.2 * duration_s)
        if ramp_s > 0.0:
            speed = 1.0 / max(moving_s - ramp_s, 0.05 * moving_s)
            acceleration = of_constant_time(speed, ramp_s)
        else:
            most = model.path_acceleration_mm_s2 or 0.0
            share = self.strongest * model.joint_acceleration_share if self.joint else most / self.length
            acceleration, speed = share, slowed_to(1e3, share, moving_s)
        return Profile(speed, acceleration, smoothing_s=smoothing_s).law()

    def residuals(self, model: MotionModel) -> FloatArray:
        return self._best(model)[0]

    def durations(self, model: MotionModel) -> tuple[float, float]:
        """Of the motion, and of the law that fits it best: both as their ends are seen in a log."""
        seen = motions(self.times, (self._best(model)[0] + self.ways)[:, None])
        return self.end_s - self.start_s, seen[-1].end_s - seen[0].start_s if seen else 0.0

    def _best(self, model: MotionModel) -> tuple[FloatArray, float]:
        """With the begin and the duration that fit best (Gauss, Newton, with shorter steps where those go too far)."""
        duration = max(self.end_s - self.start_s, 1.02 * self._shortest(model))
        begin = 0.5 * (self.start_s + self.end_s - duration)
        left = self._left(model, begin, duration)
        for _ in range(15):
            ends = (self._left(model, begin + NUDGE_S, duration), self._left(model, begin, duration + NUDGE_S))
            slopes = np.stack([(end - left) / NUDGE_S for end in ends], axis=1)
            change = np.clip(np.linalg.lstsq(slopes, -left, rcond=None)[0], -0.05, 0.05)
            for _ in range(6):
                after = self._left(model, begin + change[0], duration + change[1])
                if after @ after < left @ left:
                    break
                change = 0.4 * change
            else:
                break
            begin, duration, left = begin + float(change[0]), duration + float(change[1]), after
        return left, duration

    def _shortest(self, model: MotionModel) -> float:
        """The shortest duration that the accelerations allow."""
        if self.joint:
            ramp_s, strength = model.joint_ramp_s, self.strongest * model.joint_acceleration_share
            smoothing_s = model.joint_smoothing_s
        else:
            ramp_s, strength = model.path_ramp_s, (model.path_acceleration_mm_s2 or 0.0) / self.length
            smoothing_s = model.path_smoothing_s
        return smoothing_s + (ramp_s if ramp_s > 0.0 else 2.0 / float(np.sqrt(strength)))

    def _left(self, model: MotionModel, begin: float, duration: float) -> FloatArray:
        return np.asarray(self.length * self.law(model, duration).at(self.times - begin) - self.ways)


def _left_over(moves: list[_Move], model: MotionModel) -> FloatArray:
    return np.concatenate([move.residuals(model) for move in moves])


def _straight(log: Log, motion: Motion, robot: RobotModel) -> _Move | None:
    """The motion as a straight move in joints, else in space; None when it is neither."""
    rows = slice(motion.first, motion.last + 1)
    times, values = log.times[rows], log.values[rows]
    joint = log.joints and is_straight(values)
    if log.joints and not joint:
        values = robot.forward(values)[:, :3, 3]
    if not joint and not is_straight(values):
        return None
    ends = values[:3].mean(axis=0), values[-3:].mean(axis=0)
    way = ends[1] - ends[0]
    length = float(np.linalg.norm(way))
    with np.errstate(divide="ignore"):
        strongest = float(np.min(robot.accelerations / np.abs(way))) if joint else 0.0
    ways = (values - ends[0]) @ way / length
    return _Move(times, ways, length, joint, strongest, motion.start_s, motion.end_s)
