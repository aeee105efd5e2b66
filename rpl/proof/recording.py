"""From a run's trace to the record that is compared: which events count, and the way the tool went."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rpl import ir
from rpl.passes.scope import rules_of
from rpl.proof.paths import length_mm, turn_deg
from rpl.proof.postures import left_out, noted
from rpl.proof.record import Happening, Named, Place, Record, Stretch, Value, place_of, signal_names

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.trace import Event, Leg, RunResult

# Between samples the way is taken as straight and the turning as linear: 1 mm on a radius of 50 mm is off by 0.0025 mm,
# one degree of turning by 0.002 deg, both well below what counts as a difference.
_STEP_MM, _STEP_DEG = 1.0, 1.0
_FEWEST, _MOST = 9, 600
# Waits shorter than this make nobody wait; those up to a slow controller's cycle are looks of a polling loop.
_SHORTEST_WAIT_S, _CYCLE_S = 1e-4, 0.02
_STANDING_MM = 1e-3
# A speed (of the whole move, 1/s) below which the robot has not begun, or has come to rest.
_SLOW = 1e-6
_COUNTED = frozenset(("output", "message", "wait", "fault", "end"))


def record_of(result: RunResult, program: ir.Program, robot: RobotModel | None = None) -> Record:
    """The record of a run of that program."""
    ways = ways_of(result, program)
    language = next((module.dialect for module in program.modules), "")
    named = _named(language)
    tasks = {}
    stuck = place_of(result.fault.origin) if result.fault else Place()
    places = {id(event): number for number, event in enumerate(result.trace)}
    for task, way in ways.items():
        counted = [(_happening(event, way, stuck), places[id(event)]) for event in way.events]
        kept = [
            replace(one, number=number, named=named if one.kind == "message" else one.named)
            for one, number in counted
            if one is not None
        ]
        tasks[task] = tuple(_without_polling(kept))
    moving = {way.mover: way for way in ways.values() if way.moves}  # several tasks may see one robot
    motion = {mover: noted(way.stretches(), way.moves, result.trace, robot) for mover, way in moving.items()}
    name, left = robot.name if robot else "", left_out(result.trace)
    inputs = tuple(_input(event) for event in result.trace if event.kind == "input")
    return Record(
        result.status, result.time_s, tasks, motion, name, language, left, result.reached, result.waited, inputs
    )


def _input(event: Event) -> Happening:
    """A change that the surroundings made, by all names of its signal."""
    kind, index, last, _ = event.port or (None, None, None, None)
    known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
    value = _plain(event.data.get("level", event.data.get("value")))  # as of outputs
    return Happening("input", event.t, value, signal_names(kind, known, index, last))


def ways_of(result: RunResult, program: ir.Program) -> dict[str, Way]:
    """What happened in each task of a run, and the way of its robot. Of a program with one robot it is the robot's,
    whichever task moves it (a language without searches moves in one task and looks in another)."""
    tasks = _by_task(result.trace)
    if sum(task.kind == "motion" for task in program.tasks) > 1:
        return {task: Way(task, events, _moves(events)) for task, events in tasks.items()}
    every = sorted((move for events in tasks.values() for move in _moves(events)), key=lambda one: one.legs[0].start_s)
    mover = next((task for task, events in tasks.items() if _moves(events)), "")
    return {task: Way(mover, events, every) for task, events in tasks.items()}


def _moves(events: list[Event]) -> list[Event]:
    return [event for event in events if event.kind == "move" and event.legs]


def _named(language: str) -> Named:
    """What names a value in a message of the language."""
    rules = rules_of(language) if language else None
    return Named() if rules is None else Named(rules.message_numbers, rules.message_texts)


def _by_task(trace: Sequence[Event]) -> dict[str, list[Event]]:
    found: dict[str, list[Event]] = {}
    for event in trace:
        if event.kind != "input":  # the surroundings are the same for both; they belong to no task
            found.setdefault(event.task, []).append(event)
    return found


def _happening(event: Event, way: Way, stuck: Place) -> Happening | None:
    """The event as a happening; None when it does not count. `stuck`: where the run could not go on, if so."""
    if event.kind not in _COUNTED:
        return None
    along, moving, at = way.at(event.t)
    place = place_of(event.origin)
    match event.kind:
        case "output":
            kind, index, last, _ = event.port or (None, None, None, None)
            known = [str(name) for name in (event.data.get("signal"), *event.names) if name]
            names = signal_names(kind, known, index, last)
            # Of an analogue output the level counts, in V or mA, where it is known: two languages count it differently.
            value = _plain(event.data.get("level", event.data.get("value")))
            return Happening("output", event.t, value, names, place, along, moving, at=at, timed=event.timed)
        case "message":
            if event.data.get("type") == "clear":
                return None
            text = str(event.data.get("text", ""))
            held = tuple((name, _plain(value)) for name, value in event.named)
            sender = str(event.data.get("sender", ""))
            return Happening(
                "message", event.t, text, place=place, along=along, moving=moving, held=held, sender=sender
            )
        case "wait":
            seconds = event.data.get("seconds")
            if not isinstance(seconds, int | float):
                return Happening("wait", event.t, None, place=place, along=along, moving=moving)
            if seconds < _SHORTEST_WAIT_S:
                return None
            value = float(seconds)
            return Happening("wait", event.t, value, place=place, along=along, moving=moving, longest_s=value)
        case "fault":
            return Happening("fault", event.t, _plain(event.data.get("code")), frozenset(event.names), place, along)
        case "end":
            return Happening("end", event.t, _plain(event.data.get("status")), place=stuck, along=along)
        case _:
            return None


def _without_polling(happenings: Sequence[Happening]) -> Iterator[Happening]:
    """Timed waits in a row, without motion between them, are one wait for their sum: a loop, its statements written
    out, and a polling loop whose number of looks depends on when it began. The looks of a loop that waits for nothing
    but the next cycle are no part of a wait behind them."""
    last: Happening | None = None
    for happening in happenings:
        if last is not None and _in_a_row(last, happening):
            longest = max(last.longest_s, happening.longest_s)
            total = float(last.value or 0.0) + float(happening.value or 0.0)
            last = replace(last, times=last.times + 1, longest_s=longest, value=total)
            continue
        if last is not None:
            yield last
        last = happening
    if last is not None:
        yield last


def _in_a_row(first: Happening, second: Happening) -> bool:
    if not first.kind == second.kind == "wait" or first.value is None or second.value is None:
        return False
    if (first.longest_s <= _CYCLE_S) != (second.longest_s <= _CYCLE_S):
        return False
    return abs(first.along - second.along) < _STANDING_MM


def _plain(value: object) -> Value:
    return value if isinstance(value, bool | int | float | str) or value is None else str(value)


class Way:
    """The events of one task; the moves of its robot, and how far its tool had come at any moment."""

    def __init__(self, mover: str, events: list[Event], moves: list[Event]) -> None:
        self.mover, self.events, self.moves = mover, events, moves
        self.legs = sorted((leg for event in self.moves for leg in event.legs), key=lambda leg: leg.start_s)
        self.starts = [leg.start_s for leg in self.legs]
        self.before = [0.0]
        for leg in self.legs:
            self.before.append(self.before[-1] + _travelled(leg, leg.duration_s))

    def at(self, time_s: float) -> tuple[float, bool, tuple[float, float, float] | None]:
        """Millimetres travelled until then, whether the tool moves (not: stands, or is just starting or ending), and
        where it is."""
        index = bisect_right(self.starts, time_s) - 1
        if index < 0:
            return 0.0, False, _point(self.legs[0], 0.0) if self.legs else None
        leg = self.legs[index]
        gone = time_s - leg.start_s
        speed = float(leg.plan.law.speed_at(leg.offset_s + min(gone, leg.duration_s)))
        moving = 1e-9 < gone < leg.duration_s - 1e-9 or (gone <= leg.duration_s + 1e-9 and speed > _SLOW)
        done = min(gone, leg.duration_s)
        return self.before[index] + _travelled(leg, done), moving, _point(leg, done)

    def stretches(self) -> tuple[Stretch, ...]:
        return tuple(_stretch(event) for event in self.moves)


def _fractions(leg: Leg, gone_s: float) -> tuple[float, float]:
    """The part of the planned geometry that the leg has driven after so many seconds."""
    law, (begin, end) = leg.plan.law, leg.plan.span
    first, last = law.fraction_at(leg.offset_s), law.fraction_at(leg.offset_s + gone_s)
    return begin + (end - begin) * first, begin + (end - begin) * last


def _travelled(leg: Leg, gone_s: float) -> float:
    first, last = _fractions(leg, gone_s)
    distance = leg.plan.geometry.distance(np.array([first, last]))
    return float(distance[1] - distance[0])


def _point(leg: Leg, gone_s: float) -> tuple[float, float, float]:
    """Where the tool is so many seconds after the leg's start, mm."""
    pose = leg.plan.geometry.tcp(np.array([_fractions(leg, gone_s)[1]]))[0]
    return float(pose[0, 3]), float(pose[1, 3]), float(pose[2, 3])


def _stretch(event: Event) -> Stretch:
    """A move with its way sampled evenly by its geometry, so that two time laws give the same points."""
    poses = [_sampled(leg) for leg in event.legs]
    times = [
        np.linspace(leg.start_s, leg.start_s + leg.duration_s, len(way))
        for leg, way in zip(event.legs, poses, strict=True)
    ]
    last = event.legs[-1]
    joints = np.asarray(last.plan.joints_at(last.offset_s + last.duration_s))
    motion = str(event.data.get("motion", event.legs[0].plan.kind))
    goal = None
    if "xyz_mm" in event.data and "quat_wxyz" in event.data:
        goal = np.array([*event.data["xyz_mm"], *event.data["quat_wxyz"]], dtype=float)
    way, when = np.concatenate(poses), np.concatenate(times)
    return Stretch(
        motion,
        when,
        way,
        joints,
        event.stops,
        place_of(event.origin),
        goal,
        aim=_aim(event.legs),
        cut=bool(event.data.get("interrupted")),
        own_measure=event.blend in ("percent", "speed"),
        corner_at=_corner_at(event.legs, poses),
        asked=event.programmed,
        loads=event.payloads,
        external=_external(last),
    )


def _aim(legs: Sequence[Leg]) -> FloatArray | None:
    """The end of the planned geometry, which a move that a sensor ends does not reach; None of a corner alone."""
    planned = next((leg.plan for leg in legs if leg.plan.kind != "corner"), None)
    return None if planned is None else np.asarray(planned.geometry.tcp(np.ones(1))[0])


def _external(leg: Leg) -> FloatArray | None:
    """Where the external axes stand behind a leg; None in a corner between moves that do not lead the same axes."""
    plan = leg.plan
    middle = () if plan.external_middle is None else tuple(plan.external_middle)
    if len({np.shape(each) for each in (plan.external_start, *middle, plan.external_end)}) > 1:
        return None
    return np.asarray(plan.external_at(leg.offset_s + leg.duration_s), dtype=float).ravel()


def _corner_at(legs: Sequence[Leg], poses: Sequence[FloatArray]) -> int | None:
    """The pose with which the corner at the end begins: the first of the corner's legs, which are the last ones."""
    straight = len(legs)
    while straight > 0 and legs[straight - 1].plan.kind == "corner":
        straight -= 1
    return sum(len(way) for way in poses[:straight]) if straight < len(legs) else None


def _sampled(leg: Leg) -> FloatArray:
    first, last = _fractions(leg, leg.duration_s)
    rough = leg.plan.geometry.tcp(np.linspace(first, last, _FEWEST))
    turned = float(turn_deg(rough[:-1, :3, :3], rough[1:, :3, :3]).sum())
    steps = max(turned / _STEP_DEG, 0.0 if leg.plan.kind == "linear" else length_mm(rough) / _STEP_MM)
    count = int(np.ceil(steps - 1e-6))  # a way of whole steps has as many, whatever its last bit says
    if count <= _FEWEST:
        return rough
    return leg.plan.geometry.tcp(np.linspace(first, last, min(count, _MOST)))
