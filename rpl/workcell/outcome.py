"""What came of a run of a cell: cycle times, how busy each robot was, grasps, and where every part is in the end."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell.record import Grasp, Placed
from rpl.cell.stable import stable_states
from rpl.emulator.rotations import matrix_to_quaternion

if TYPE_CHECKING:
    from rpl.cell.layout import Part
    from rpl.runtime.values import Value
    from rpl.workcell.record import CellRun, RobotRun

_SEVERAL = 10  # parts of a kind that are worth counting


@dataclass(frozen=True, slots=True)
class Busy:
    """A robot of a run: how long it moved (s), what share of the whole run that is, and how it ended."""

    robot: str
    status: str
    time_s: float
    moving_s: float
    share: float


@dataclass(frozen=True, slots=True)
class Settled:
    """How often parts of a kind came to lie in one of their stable states. `normal`: what of the part points down;
    `expected`: the probability of the state after a fall from far enough."""

    kind: str
    normal: tuple[float, float, float]
    count: int
    of: int
    expected: float


@dataclass(frozen=True, slots=True)
class Outcome:
    """`cycles`: of each gripper, the times (s) from one part that it took to the next. `settled`: of kinds of which
    several parts have come to rest after a fall."""

    busy: tuple[Busy, ...]
    cycles: tuple[tuple[str, tuple[float, ...]], ...]
    grasps: tuple[Grasp, ...]
    parts: tuple[Placed, ...]
    notes: tuple[str, ...] = ()
    settled: tuple[Settled, ...] = ()

    def as_json(self) -> dict[str, Value]:
        """The keys that `rpl run --cell --json` adds to those of a run."""
        return {
            "robots": [
                {
                    "name": one.robot,
                    "status": one.status,
                    "time_s": round(one.time_s, 6),
                    "moving_s": round(one.moving_s, 6),
                    "utilisation": round(one.share, 6),
                }
                for one in self.busy
            ],
            "cycle_times": [
                {"gripper": name, "times_s": [round(time, 6) for time in times]} for name, times in self.cycles
            ],
            "grasps": [
                {"t": round(one.t, 6), "gripper": one.gripper, "part": one.part, "ok": one.ok, "why": one.why}
                for one in self.grasps
            ],
            "parts": [
                {"name": one.part, "pose": pose_json(one), "state": one.state, "on": one.on} for one in self.parts
            ],
            "settled": [
                {
                    "part": one.kind,
                    "normal": [round(each, 6) for each in one.normal],
                    "count": one.count,
                    "of": one.of,
                    "share": round(one.count / one.of, 6),
                    "expected": round(one.expected, 6),
                }
                for one in self.settled
            ],
            "notes": list(self.notes),
        }


def pose_json(placed: Placed) -> dict[str, Value]:
    """Where a part is, or where in the flange of its gripper's robot."""
    return {
        "xyz_mm": [round(float(each), 6) + 0.0 for each in placed.pose[:3, 3]],
        "quat_wxyz": [round(float(each), 9) + 0.0 for each in matrix_to_quaternion(placed.pose[:3, :3])],
    }


def outcome_of(run: CellRun) -> Outcome:
    """What came of it."""
    cycles = []
    for gripper in run.layout.grippers:
        taken = [one.t for one in run.grasps if one.gripper == gripper.name and one.ok]
        cycles.append((gripper.name, tuple(b - a for a, b in itertools.pairwise(taken))))
    last = {one.part: one for one in run.placed}
    order = [part.name for part in run.layout.parts]
    return Outcome(
        tuple(_busy(one, run.time_s) for one in run.robots),
        tuple(cycles),
        run.grasps,
        tuple(last[name] for name in order if name in last),
        run.notes,
        tuple(_settled(run)),
    )


def _settled(run: CellRun) -> Iterator[Settled]:
    fell = {one.part for one in run.placed if one.state == "falls"}
    last = {one.part: one for one in run.placed}
    kinds: dict[str, list[Part]] = {}
    for part in run.layout.parts:
        if part.name in fell and last[part.name].state == "rests":
            kinds.setdefault(part.kind, []).append(part)
    for kind, parts in kinds.items():
        if len(parts) < _SEVERAL:
            continue
        states = stable_states(parts[0].shape)
        downs = np.array([last[part.name].pose[2, :3] * -1.0 for part in parts])
        nearest = np.argmax(downs @ np.array([one.normal for one in states]).T, axis=1)
        for number, state in enumerate(states):
            yield Settled(kind, state.normal, int((nearest == number).sum()), len(parts), state.probability)


def _busy(one: RobotRun, whole_s: float) -> Busy:
    legs = [leg for event in one.result.trace if event.kind == "move" for leg in event.legs]
    moving = sum(leg.duration_s for leg in legs)
    return Busy(one.place.name, one.result.status, one.result.time_s, moving, moving / whole_s if whole_s else 0.0)
