"""The data behind a page about a run: one plain document of numbers and texts, the same for the same run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import starmap
from pathlib import PurePath
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.margins import conditioning, limit_margins, singular_factors
from rpl.emulator.rotations import FloatArray
from rpl.report.external import Curve, curves_as_layers, external_curves
from rpl.report.labels import NO_LABEL, Labels
from rpl.report.motion import MoveRow, move_rows, tool_rates, waiting_places
from rpl.report.sampling import STANDING, STEP_S, RunSamples, driven_moves, sample_run, thinned
from rpl.report.screws import screws_document, screws_of
from rpl.report.signals import signal_rows

if TYPE_CHECKING:
    from rpl.emulator.mechanismfile import MechanismAxis
    from rpl.emulator.model import RobotModel
    from rpl.runtime.trace import Event, RunResult

# Of a sample about 200 bytes come on the page; 40,000 of them are 8 MB, eight minutes at 12 ms.
MOST_SAMPLES = 40_000
MOST_ROWS = 3_000
MOST_MARKS = 2_000
MOST_NAMES = 4

Row = dict[str, object]


@dataclass(frozen=True, slots=True)
class Heading:
    """What the run was: names for people. Empty what is not known."""

    files: tuple[str, ...]
    language: str = ""
    robot: str = ""
    controller: str = ""
    moves: int = 0
    fault: str = ""

    @property
    def title(self) -> str:
        """The program's name: those of its files, a program and its data once."""
        stems = list(dict.fromkeys(PurePath(file).stem for file in self.files))
        more = f" and {len(stems) - MOST_NAMES} more" if len(stems) > MOST_NAMES else ""
        return (", ".join(stems[:MOST_NAMES]) + more) or "run"


@dataclass(frozen=True, slots=True, eq=False)
class RunDocument:
    """What a page shows: `data` for its drawings, `moves` and `labels` for its table, `notes` for people.
    `limits_known`: the axes' accelerations are facts, so that more than those is a warning."""

    heading: Heading
    data: Row
    moves: tuple[MoveRow, ...]
    labels: Labels
    notes: tuple[str, ...]
    limits_known: bool = True


def run_document(
    result: RunResult,
    model: RobotModel | None,
    heading: Heading,
    step_s: float = STEP_S,
    most_samples: int = MOST_SAMPLES,
    layers: Sequence[tuple[str, str, FloatArray]] = (),
    external: Mapping[int, MechanismAxis] = MappingProxyType({}),
) -> RunDocument:
    """The document of a run. Without a robot it has signals and messages only. `layers` are further curves over time,
    each a name, a unit and rows (k, 2) of s and value. `external`: what is known of external axes, by their number."""
    labels = Labels(event.origin for event in result.trace)
    signals, left_out = signal_rows(result)
    notes = [f"{left_out} later changes of signals are not shown; --trace writes them all."] if left_out else []
    data: Row = {
        "title": heading.title,
        "status": result.status,
        "time_s": round(result.time_s, 6),
        "labels": [list(entry) for entry in labels.table()],
        "signals": [
            {
                "name": row.name,
                "kind": row.kind,
                "level": row.level,
                "changes": [[round(t, 4), v, text, labels.number(origin)] for t, v, text, origin in row.changes],
            }
            for row in signals
        ],
        "marks": _marks(result, labels),
        "layers": _layers(external_curves(result, external, step_s, most_samples), layers),
    }
    rows: tuple[MoveRow, ...] = ()
    moves = driven_moves(result)
    if model is None:
        notes.append("The run had no robot: its moves took no time, and there is no path to show (--robot).")
    elif not moves:
        notes.append("The robot did not move.")
    else:
        whole = sample_run(result, model, step_s)
        speeds, turning = tool_rates(model, whole)
        rows = move_rows(moves, whole, speeds, model)
        kept = thinned(whole, most_samples, *_measures(whole, model, speeds))
        if len(kept) < len(whole):
            notes.append(
                f"{len(kept)} of {len(whole)} samples are shown, the extremes among them; the table is of all."
            )
        shown = whole.only(kept)
        data |= {
            "joints": _axes(model),
            "arm": screws_document(screws_of(model)),
            "samples": _samples(shown, model, speeds[kept], turning[kept]),
            "stretches": _stretches(shown, moves, result, labels),
            "moves": [_move(row, labels) for row in rows[:MOST_ROWS]],
        }
        if len(rows) > MOST_ROWS:
            notes.append(f"The table has the first {MOST_ROWS} of {len(rows)} moves; --trace writes them all.")
        notes += model.notes
    known = model is None or not model.uncertain_axes
    return RunDocument(heading, data, rows, labels, tuple(notes), known)


def _measures(samples: RunSamples, model: RobotModel, tool_speeds: FloatArray) -> tuple[FloatArray, ...]:
    """What must not be lost by leaving out samples: the extremes of these."""
    factors = singular_factors(model, samples.joints)
    closeness = np.prod(list(factors.values()), axis=0) if factors else limit_margins(model, samples.joints).min(axis=1)
    return (
        np.abs(samples.speeds / model.speeds).max(axis=1),
        np.abs(samples.accelerations / model.accelerations).max(axis=1),
        tool_speeds,
        closeness,
    )


def _axes(model: RobotModel) -> list[Row]:
    return [
        {
            "name": f"J{number + 1}",
            "unit": "deg" if kind == "revolute" else "mm",
            "low": _finite(model.limits[number, 0]),
            "high": _finite(model.limits[number, 1]),
            "speed": _finite(model.speeds[number]),
            "acceleration": _finite(model.accelerations[number]),
        }
        for number, kind in enumerate(model.joint_kinds)
    ]


def _finite(value: float) -> float | None:
    return round(float(value), 6) if np.isfinite(value) else None


def numbers(values: FloatArray, places: int) -> list[float]:
    """Rounded for the page, without negative zeros."""
    rounded: list[float] = (np.round(values, places) + 0.0).tolist()
    return rounded


def _samples(samples: RunSamples, model: RobotModel, speeds: FloatArray, turning: FloatArray) -> Row:
    factors = singular_factors(model, samples.joints)
    return {
        "t": numbers(samples.times, 5),
        "tool": [numbers(axis, 3) for axis in samples.tool.T],
        "tool_speed": numbers(speeds, 2),
        "turning": numbers(turning, 2),
        "joints": [numbers(axis, 4) for axis in samples.joints.T],
        "speeds": [numbers(axis, 3) for axis in samples.speeds.T],
        "accelerations": [numbers(axis, 2) for axis in samples.accelerations.T],
        "conditioning": numbers(conditioning(model, samples.joints), 5),
        "factors": {name: numbers(values, 5) for name, values in factors.items()},
    }


def _stretches(
    samples: RunSamples, moves: Sequence[Event], result: RunResult, labels: Labels
) -> list[tuple[int, int, int]]:
    """Where another move (or a rest) begins: first sample, number of the move, number of its line."""
    borders = np.flatnonzero(np.diff(samples.moves, prepend=-2))
    waits = waiting_places(result)
    found, ahead = [], 0
    for place, row in enumerate(borders):
        number = int(samples.moves[row])
        if number != STANDING:
            found.append((int(row), number, labels.number(moves[number].origin)))
            continue
        begin = samples.times[row] - 1e-6
        end = samples.times[borders[place + 1]] if place + 1 < len(borders) else result.time_s
        while ahead < len(waits) and waits[ahead][0] < begin:
            ahead += 1
        here = ahead < len(waits) and waits[ahead][0] < end
        found.append((int(row), STANDING, labels.number(waits[ahead][1]) if here else NO_LABEL))
    return found


def _move(row: MoveRow, labels: Labels) -> Row:
    return {
        "label": labels.number(row.origin),
        "kind": row.kind,
        "start": round(row.start_s, 5),
        "end": round(row.end_s, 5),
        "length": round(row.length_mm, 3),
    }


def _marks(result: RunResult, labels: Labels) -> list[Row]:
    """Messages, warnings and the fault, at their moments."""
    found: list[Row] = []
    for event in result.trace:
        if event.kind in ("message", "warning", "fault") and len(found) < MOST_MARKS:
            text = str(event.data.get("text", event.data.get("message", "")))
            found.append(
                {"t": round(event.t, 4), "kind": event.kind, "text": text, "label": labels.number(event.origin)}
            )
    return found


def _layers(curves: Sequence[Curve], layers: Sequence[tuple[str, str, FloatArray]]) -> list[Row]:
    return [*curves_as_layers(curves), *starmap(_layer, layers)]


def _layer(name: str, unit: str, rows: FloatArray) -> Row:
    times, values = numbers(rows[:, 0], 5), numbers(rows[:, 1], 4)
    return {"name": name, "title": "", "unit": unit, "t": times, "values": values, "limits": []}
