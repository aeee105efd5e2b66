"""The moves of a run as rows of a table: where each stands in the program, how long it took, how near it came to the
limits of the arm. The extremes are those of all samples, so they stay when fewer are shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.margins import limit_margins
from rpl.emulator.rotations import FloatArray
from rpl.report.sampling import RunSamples
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.runtime.trace import Event, Leg, RunResult

# The Jacobian of many postures at once takes memory; so many at a time.
BLOCK = 20_000
LONGEST_LINE = 160


@dataclass(frozen=True, slots=True)
class Peak:
    """A largest share of a limit, and the axis (from 0) that has it."""

    share: float
    axis: int


@dataclass(frozen=True, slots=True)
class MoveRow:
    """One driven move: seconds, mm and mm/s; shares are of the axes' limits, the margin is that of `limit_margins`."""

    origin: Origin
    kind: str
    start_s: float
    end_s: float
    driven_s: float
    length_mm: float
    top_speed_mm_s: float
    speed: Peak
    acceleration: Peak
    margin: Peak
    interrupted: bool


def move_rows(
    moves: Sequence[Event], samples: RunSamples, tool_speeds: FloatArray, model: RobotModel
) -> tuple[MoveRow, ...]:
    """One row a move, in their order."""
    owner = samples.moves
    driven = owner >= 0
    top = np.zeros(len(moves))
    np.maximum.at(top, owner[driven], tool_speeds[driven])
    shares = [
        (np.abs(samples.speeds) / model.speeds, np.maximum, 0.0),
        (np.abs(samples.accelerations) / model.accelerations, np.maximum, 0.0),
        (limit_margins(model, samples.joints), np.minimum, np.inf),
    ]
    peaks = []
    for values, extreme, first in shares:
        found = np.full((len(moves), model.axes), first)
        extreme.at(found, owner[driven], values[driven])
        peaks.append(found)
    speeds, accelerations, margins = peaks
    return tuple(
        MoveRow(
            event.origin,
            str(event.data.get("motion", "")),
            event.legs[0].start_s,
            event.legs[-1].start_s + event.legs[-1].duration_s,
            sum(leg.duration_s for leg in event.legs),
            sum(leg_length(leg) for leg in event.legs),
            float(top[i]),
            _peak(speeds[i], np.argmax(speeds[i])),
            _peak(accelerations[i], np.argmax(accelerations[i])),
            _peak(margins[i], np.argmin(margins[i])),
            bool(event.data.get("interrupted")),
        )
        for i, event in enumerate(moves)
    )


def _peak(values: FloatArray, axis: np.intp) -> Peak:
    value = float(values[axis])
    return Peak(value if np.isfinite(value) else 1.0, int(axis))


def leg_length(leg: Leg) -> float:
    """Millimetres that the tool travels in a leg."""
    begin, end = leg.plan.span
    fractions = begin + (end - begin) * leg.plan.law.at([leg.offset_s, leg.offset_s + leg.duration_s])
    first, last = leg.plan.geometry.distance(fractions)
    return float(last - first)


def tool_rates(model: RobotModel, samples: RunSamples) -> tuple[FloatArray, FloatArray]:
    """Speed of the tool centre point (k,) mm/s and of its turning (k,) deg/s: v = J q', moved to the tool."""
    linear, angular = np.empty(len(samples)), np.empty(len(samples))
    for begin in range(0, len(samples), BLOCK):
        rows = slice(begin, begin + BLOCK)
        joints = samples.joints[rows]
        twists = np.einsum("kij,kj->ki", model.jacobian(joints), samples.speeds[rows] * model.unit)
        arm = samples.tool[rows] - model.forward(joints)[:, :3, 3]
        linear[rows] = np.linalg.norm(twists[:, :3] + np.cross(twists[:, 3:], arm), axis=1)
        angular[rows] = np.rad2deg(np.linalg.norm(twists[:, 3:], axis=1))
    return linear, angular


def line_text(origin: Origin) -> str:
    """The first source line of a statement, without its margins; empty where there is no source."""
    if origin.source is None:
        return ""
    starts, text = origin.source.line_starts(), origin.source.text
    begin = starts[origin.line - 1]
    end = starts[origin.line] if origin.line < len(starts) else len(text)
    line = text[begin:end].strip()
    return line if len(line) <= LONGEST_LINE else line[: LONGEST_LINE - 1] + "…"


def waiting_places(result: RunResult) -> list[tuple[float, Origin]]:
    """When and where the program waited, in order."""
    return [(event.t, event.origin) for event in result.trace if event.kind == "wait" and event.origin != NOWHERE]
