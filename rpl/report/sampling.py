"""A finished run at even moments: joints, their speeds and accelerations, and the tool, with the move behind each.

Speeds and accelerations are central differences of the planned motion itself over `STENCIL_S`, not of the samples, so
that a ramp between two samples is neither lost nor smeared, whatever time law a controller has. A stencil never reaches
across a leg: at its borders it moves inwards.
"""

from __future__ import annotations

from collections.abc import Sequence, Sized
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rpl.emulator.model import RobotModel
    from rpl.runtime.trace import Event, Leg, RunResult

STEP_S = 0.012
# Half the width of the central differences. Rounding of an inverse (1e-10 deg) then is 4e-4 deg/s2.
STENCIL_S = 0.0005
# Gaps between two legs that are shorter than this are rounding of the clock.
SAME_MOMENT_S = 1e-9
# What rounding leaves over of a move beside a corner lasts a nanosecond: nothing to be seen, no differences to take.
SHORTEST_LEG_S = 1e-5
STANDING = -1


@dataclass(frozen=True, slots=True, eq=False)
class RunSamples:
    """A run at k moments: times (k,) s; joints, speeds, accelerations (k, n) in pendant units, per s and s2; tool
    (k, 3) mm in the robot's base frame; the number of the driven move (k,), STANDING where none is."""

    times: FloatArray
    joints: FloatArray
    speeds: FloatArray
    accelerations: FloatArray
    tool: FloatArray
    moves: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.times)

    def only(self, rows: NDArray[np.int64] | NDArray[np.bool_]) -> RunSamples:
        """These rows, in their order."""
        return RunSamples(
            self.times[rows],
            self.joints[rows],
            self.speeds[rows],
            self.accelerations[rows],
            self.tool[rows],
            self.moves[rows],
        )


def driven_moves(result: RunResult) -> list[Event]:
    """The moves that were driven by a robot, in the order of their start."""
    found = [event for event in result.trace if event.kind == "move" and event.legs]
    return sorted(found, key=lambda event: event.legs[0].start_s)


def sample_run(result: RunResult, model: RobotModel, step_s: float = STEP_S) -> RunSamples:
    """The whole run at multiples of `step_s`, at the borders of its legs, and at both ends of each rest."""
    moves = driven_moves(result)
    legs = sorted(
        ((leg, number) for number, event in enumerate(moves) for leg in event.legs if leg.duration_s > SHORTEST_LEG_S),
        key=lambda one: one[0].start_s,
    )
    if not legs:
        return _standing_only(result, model)
    parts: list[RunSamples] = []
    last_s = 0.0
    for leg, number in legs:
        part = _sampled(model, leg, number, step_s)
        before = parts[-1] if parts else part
        if leg.start_s - last_s > SHORTEST_LEG_S:
            place = -1 if parts else 0
            parts.append(_rest(before, place, last_s, leg.start_s))
        parts.append(part)
        last_s = leg.start_s + leg.duration_s
    if result.time_s - last_s > SHORTEST_LEG_S:
        parts.append(_rest(parts[-1], -1, last_s, result.time_s))
    return _joined(parts)


def moments(start_s: float, duration_s: float, step_s: float) -> FloatArray:
    """Both ends and the multiples of the step between them, s on the clock."""
    end_s = start_s + duration_s
    inside = np.arange(np.floor(start_s / step_s) + 1.0, np.ceil(end_s / step_s)) * step_s
    inside = inside[(inside > start_s + SAME_MOMENT_S) & (inside < end_s - SAME_MOMENT_S)]
    return np.concatenate([[start_s], inside, [end_s]])


def _sampled(model: RobotModel, leg: Leg, number: int, step_s: float) -> RunSamples:
    times = moments(leg.start_s, leg.duration_s, step_s)
    local = np.clip(times - leg.start_s, 0.0, leg.duration_s) + leg.offset_s
    half = min(STENCIL_S, 0.5 * leg.duration_s)
    centre = np.clip(local, leg.offset_s + half, leg.offset_s + leg.duration_s - half)
    count = len(times)
    moved = np.flatnonzero(local != centre)  # at the ends of the leg, where the joints are asked for besides
    asked = np.concatenate([centre - half, centre, centre + half, local[moved]])
    found = leg.plan.joints_at(asked)
    before, middle, after = found[: 3 * count].reshape(3, count, -1)
    joints = middle.copy()
    joints[moved] = found[3 * count :]
    speeds = (after - before) / (2.0 * half)
    accelerations = (after - 2.0 * middle + before) / (half * half)
    speeds = speeds + accelerations * (local - centre)[:, None]
    # By the joints, for the path of a move on a turning table is given on the table.
    tool = (model.forward(joints) @ leg.plan.geometry.tool)[:, :3, 3]
    return RunSamples(times, joints, speeds, accelerations, tool, np.full(count, number, dtype=np.int64))


def _rest(near: RunSamples, place: int, start_s: float, end_s: float) -> RunSamples:
    """The robot standing where `near` is at that place."""
    joints, tool = (np.repeat(values[place][None], 2, axis=0) for values in (near.joints, near.tool))
    still = np.zeros_like(joints)
    return RunSamples(np.array([start_s, end_s]), joints, still, still, tool, np.full(2, STANDING, dtype=np.int64))


def _standing_only(result: RunResult, model: RobotModel) -> RunSamples:
    joints = np.array(result.joints if result.joints is not None else model.home, dtype=np.float64)[None]
    tool = model.forward(joints)[:, :3, 3]
    still = np.zeros_like(joints)
    here = RunSamples(np.zeros(1), joints, still, still, tool, np.full(1, STANDING, dtype=np.int64))
    return _rest(here, 0, 0.0, result.time_s)


def _joined(parts: Sequence[RunSamples]) -> RunSamples:
    return RunSamples(
        np.concatenate([part.times for part in parts]),
        np.concatenate([part.joints for part in parts]),
        np.concatenate([part.speeds for part in parts]),
        np.concatenate([part.accelerations for part in parts]),
        np.concatenate([part.tool for part in parts]),
        np.concatenate([part.moves for part in parts]),
    )


def thinned(samples: Sized, most: int, *measures: FloatArray) -> NDArray[np.int64]:
    """Rows to keep, in order, at most about `most`: both ends and, from each window of rows, the one with the largest
    and the smallest of each measure (k,). All rows when they are few enough."""
    count = len(samples)
    if count <= most:
        return np.arange(count)
    windows = max((most - 2) // (2 * len(measures) + 1), 1)
    size = -(-count // windows)
    padded = windows * size
    rows = np.minimum(np.arange(padded), count - 1).reshape(windows, size)
    kept = [np.array([0, count - 1]), rows[:, 0]]
    for measure in measures:
        values = measure[rows]
        kept += [rows[np.arange(windows), pick(values, axis=1)] for pick in (np.argmax, np.argmin)]
    return np.unique(np.concatenate(kept))
