"""Where a robot of a cell is at any moment of its run, by the legs of its trace, and which line drives it there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rpl.cell.armbodies import link_poses
from rpl.emulator.mechanisms import mechanism_pose
from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray, invert_pose
from rpl.report.sampling import SHORTEST_LEG_S, driven_moves
from rpl.runtime.trace import Event, Leg
from rpl.source import NOWHERE, Origin
from rpl.workcell.record import RobotRun

# Moments closer than this are one.
SAME_S = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """The way of one robot. `legs` by time, `starts` (m,) and `ends` (m,) their moments in s, `moves` the event of
    each; `rest` (n,): the joints of a robot that never moves; `base` (4, 4) in the cell."""

    name: str
    model: RobotModel
    base: FloatArray
    legs: tuple[Leg, ...]
    starts: FloatArray
    ends: FloatArray
    moves: tuple[Event, ...]
    rest: FloatArray

    def joints(self, times: FloatArray) -> FloatArray:
        """Joints (k, n) in pendant units at moments (k,), which do not fall."""
        if not self.legs:
            return np.repeat(self.rest[None], len(times), axis=0)
        numbers = np.maximum(np.searchsorted(self.starts, times, side="right") - 1, 0)
        found = np.empty((len(times), self.model.axes))
        borders = [0, *(np.flatnonzero(np.diff(numbers)) + 1).tolist(), len(times)]
        for first, last in pairwise(borders):
            leg = self.legs[numbers[first]]
            local = np.clip(times[first:last] - leg.start_s, 0.0, leg.duration_s) + leg.offset_s
            if local[-1] - local[0] == 0.0:
                found[first:last] = leg.plan.joints_at(local[:1])
            else:
                found[first:last] = leg.plan.joints_at(local)
        return found

    def bases(self, times: FloatArray) -> FloatArray:
        """The robot's base in the cell: (4, 4) where it stands still, (k, 4, 4) where a track carries it.

        `base` is where it is with its external axes at zero.
        """
        rides = [one for one in self.model.mechanisms if one.carries_robot]
        if not rides or not self.legs:
            return self.base
        numbers = np.maximum(np.searchsorted(self.starts, times, side="right") - 1, 0)
        poses = np.empty((len(times), 4, 4))
        start = invert_pose(mechanism_pose(rides[0], np.zeros(6)))
        for number in np.unique(numbers):
            rows, leg = numbers == number, self.legs[number]
            local = np.clip(times[rows] - leg.start_s, 0.0, leg.duration_s) + leg.offset_s
            poses[rows] = mechanism_pose(rides[0], leg.plan.external_at(local))
        return np.asarray(self.base @ (start @ poses))

    def links(self, times: FloatArray) -> FloatArray:
        """Poses of the links in the cell (k, links + 1, 4, 4), mm."""
        bases = self.bases(times)
        poses = link_poses(self.model, self.joints(times))
        return np.asarray((bases if bases.ndim == 2 else bases[:, None]) @ poses)

    def moving(self, t: float) -> bool:
        """Is it being driven at that moment?"""
        number = int(np.searchsorted(self.starts, t, side="right")) - 1
        return number >= 0 and t <= self.ends[number] + SAME_S

    def place(self, t: float) -> Origin:
        """The line of the move that is driven at that moment, else of the one before, else of the first."""
        if not self.moves:
            return NOWHERE
        number = int(np.searchsorted(self.starts, t, side="right")) - 1
        return self.moves[max(number, 0)].origin


def way_of(robot: RobotRun, name: str, model: RobotModel) -> Way:
    """The way of a robot whose run went to its end, or wherever it went."""
    pairs = sorted(
        ((leg, event) for event in driven_moves(robot.result) for leg in event.legs if leg.duration_s > SHORTEST_LEG_S),
        key=lambda pair: pair[0].start_s,
    )
    joints = robot.place.joints if robot.place.joints is not None else robot.result.joints
    return Way(
        name,
        model,
        robot.place.base,
        tuple(leg for leg, _ in pairs),
        np.array([leg.start_s for leg, _ in pairs]),
        np.array([leg.start_s + leg.duration_s for leg, _ in pairs]),
        tuple(event for _, event in pairs),
        np.array(joints if joints is not None else model.home, dtype=np.float64),
    )


def knots(ways: Iterable[Way], more: Iterable[float], end_s: float, step_s: float) -> FloatArray:
    """Moments (k,) from 0 to the end: the multiples of the step at which any robot is driven, the ends of all legs, and
    `more`."""
    even = np.arange(int(np.floor(end_s / step_s)) + 1) * step_s
    wanted = np.zeros(len(even), dtype=bool)
    borders = [np.array([0.0, end_s, *more])]
    for way in ways:
        if way.legs:
            numbers = np.searchsorted(way.starts, even, side="right") - 1
            wanted |= (numbers >= 0) & (even <= way.ends[np.maximum(numbers, 0)])
            borders += [way.starts, way.ends]
    found = np.unique(np.concatenate([even[wanted], *borders]))
    found = found[(found >= 0.0) & (found <= end_s)]
    return np.asarray(found[np.concatenate([[True], np.diff(found) > SAME_S])])
