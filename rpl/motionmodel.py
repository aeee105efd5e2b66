"""How a controller moves an arm: the parameters of its time laws and corners, and how sure we are of each.

What no file says is the plain model: constant acceleration, corners that are parabolas. `rpl.controllerfiles` reads and
finds the files.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from itertools import pairwise
from typing import Any

from rpl.tomlfile import LARGEST, SMALLEST

# A right angle's corner is missed by this share of the zone where the corner is a parabola: sqrt(2) / 4.
PARABOLA = math.sqrt(0.125)
PLAIN_NAME = "plain"
# A corner's cubic is tangent to the paths over at least this share of the blend distance: it leaves them there.
LEAST_TANGENT = 0.2


@dataclass(frozen=True, slots=True)
class MotionModel:
    """The parameters of one controller; times in s, lengths in mm.

    joint_ramp_s, path_ramp_s: speeding up takes this long whatever the speed (0: the acceleration decides), which short
    moves keep: they last their time at full speed and one ramp. joint_ramp_deg: each axis has a ramp of its own, in
    which it would go this many degrees (mm) at full speed; joint_ramps_s: those ramps themselves, per axis; of the axes
    that move, in the share of their speed that they have, the longest governs. corner_ramp_s: ramps beside a corner
    made by overlapping moves (0: as beside a stop).
    joint_acceleration_share: of the accelerations of the robot file.
    joint_smoothing_s, path_smoothing_s: width of the moving average over the speed (S-curve).
    path_acceleration_mm_s2: at 100 percent, where the program gives none.
    corner_cut: by what share of the blend distance the path misses a right-angled corner (a parabola: 0.354).
    corner_filter_s: width of the moving average behind the path planner, which cuts off more than that (see `cut`).
    corner_acceleration_mm_s2: what holds the speed of a corner down, where that is not the path's acceleration: the
    mean acceleration that turns one even speed into the other on a parabola. Where moves overlap: of a ramp beside it.
    corner_even: the tool keeps its speed through a corner between path moves (1: yes; 0: it dips, as a parabola driven
    in even time does).
    corner_whole: a corner may take up more than half of a move at whose other end the robot stands, if the move is
    longer than the blend distance (1: yes, 0: no).
    overlap: pairs of percent and share of a ramp by which two moves overlap in time, for controllers whose corners are
    made so (CNT, continuous path); empty: corners have a size. restart_s: a move that follows one that stopped exactly
    begins so much later. uncertainty: per parameter name (also `joint_speed`, `joint_acceleration`,
    `path_acceleration`, `corner`) the relative error that it may have.
    """

    name: str = PLAIN_NAME
    title: str = "constant acceleration, parabolic corners"
    source: str = ""
    joint_ramp_s: float = 0.0
    joint_ramp_deg: float = 0.0
    joint_ramps_s: tuple[float, ...] = ()
    joint_acceleration_share: float = 1.0
    joint_smoothing_s: float = 0.0
    path_acceleration_mm_s2: float | None = None
    path_ramp_s: float = 0.0
    path_smoothing_s: float = 0.0
    corner_cut: float = PARABOLA
    corner_filter_s: float = 0.0
    corner_acceleration_mm_s2: float | None = None
    corner_even: float = 0.0
    corner_whole: float = 0.0
    corner_ramp_s: float = 0.0
    overlap: tuple[tuple[float, float], ...] = ()
    restart_s: float = 0.0
    uncertainty: Mapping[str, float] = field(default_factory=dict, hash=False)

    def overlap_at(self, percent: float) -> float:
        """The share of a ramp by which two moves overlap, linear between the given percents."""
        points = self.overlap
        if percent <= points[0][0]:
            return points[0][1]
        for (low, first), (high, second) in pairwise(points):
            if percent <= high:
                return first + (second - first) * (percent - low) / (high - low)
        return points[-1][1]

    def overlap_distance_mm(self, percent: float, speed_mm_s: float, effort: float = 1.0) -> float:
        """How far before the target the corner of two overlapping path moves at that speed begins. `effort`: the
        acceleration in force as a share. The sum of two even ramps is left half the acceleration times the square of
        the overlap before their meeting point."""
        most = (self.path_acceleration_mm_s2 or math.inf) * effort
        ramp_s = max(self.path_ramp_s / effort, speed_mm_s / most)
        if self.corner_ramp_s > 0.0:
            ramp_s *= self.corner_ramp_s / self.path_ramp_s if self.path_ramp_s > 0.0 else 1.0
        ramp_s = max(ramp_s, speed_mm_s / ((self.corner_acceleration_mm_s2 or math.inf) * effort))
        return 0.5 * speed_mm_s * ramp_s * self.overlap_at(percent) ** 2

    def with_ramp(self, percent: float) -> MotionModel:
        """With accelerations that rise at this share of their usual rate (RAPID AccSet, its second number): the moving
        average over the speed gets wider by it."""
        if percent == 100.0 or percent <= 0.0:
            return self
        wider = 100.0 / percent
        return replace(
            self, joint_smoothing_s=self.joint_smoothing_s * wider, path_smoothing_s=self.path_smoothing_s * wider
        )

    def corner_speed(self, distance_mm: float, turn: float, share: float = 1.0) -> float:
        """The highest speed (mm/s) through a corner of that size. `turn`: the difference of the two directions (unit
        vectors; a right angle: 1.414), which the speed's change of `turn` times itself in 2 distance / speed follows;
        `share`: of the acceleration."""
        most = self.corner_acceleration_mm_s2
        return math.inf if most is None or turn <= 1e-9 else math.sqrt(2.0 * distance_mm * most * share / turn)

    def cut(self, distance_mm: float, speed_mm_s: float, turn: float) -> float:
        """By how much a corner is missed, as a share of the blend distance times `turn` (as for `corner_speed`).

        `corner_cut` and what a moving average over the speed adds. A speed that turns evenly in the time T goes by
        speed * turn / 2 times the mean of |x| past the corner, where x is spread evenly over T; behind an average of
        width F, x is the sum of two such numbers: the larger of both widths / 4 + its smaller one squared / (12 times
        the larger one). Long corners are shifted by F squared / 24 times the acceleration, which the speed of the
        corner limits; in short ones the average itself draws the curve.
        """
        cut, width = self.corner_cut / math.sqrt(2.0), self.corner_filter_s
        speed = min(speed_mm_s, self.corner_speed(distance_mm, turn))
        if width <= 0.0 or speed <= 0.0 or distance_mm <= 0.0:
            return cut
        lasts = 2.0 * distance_mm / speed
        low, high = min(lasts, width), max(lasts, width)
        return cut + (high / 4.0 + low * low / (12.0 * high) - lasts / 4.0) / lasts

    def tangent_share(self, distance_mm: float, speed_mm_s: float, turn: float = math.sqrt(2.0)) -> float:
        """How far towards the corner point the inner control points of a corner's cubic lie, as a share (0.2..1) of the
        blend distance, so that the corner is missed by `cut`."""
        return min(max((4.0 - 8.0 * self.cut(distance_mm, speed_mm_s, turn)) / 3.0, LEAST_TANGENT), 1.0)


PLAIN = MotionModel()
NUMBERS = tuple(
    each.name
    for each in fields(MotionModel)
    if each.name not in ("name", "title", "source", "overlap", "joint_ramps_s", "uncertainty")
)
UNCERTAIN = (*NUMBERS, "overlap", "joint_speed", "joint_acceleration", "path_acceleration", "corner")


def on_robot(model: MotionModel, measured: Mapping[str, Any]) -> MotionModel:
    """The controller with what was measured on one arm: numbers, and ramps per axis."""
    return replace(model, **measured) if measured else model


def wrong_number(value: object, key: str) -> str:
    """What is wrong with the value of a parameter; nothing where it is a number of some use."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value < math.inf:
        return f"'{key}' must be a number of at least 0, found {value!r}"
    if value > LARGEST:
        return f"'{key}' must be a number of at most {LARGEST:,.0f}, found {value!r}"
    if key.endswith(("acceleration_mm_s2", "acceleration_share")) and value < SMALLEST:
        return f"'{key}' must be more than 0, at least {SMALLEST:f}"
    return ""
