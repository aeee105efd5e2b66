"""The external axes of a finished run over time: positions and speeds of those that move or that a file describes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray
from rpl.report.sampling import SHORTEST_LEG_S, STENCIL_S, driven_moves, moments, thinned

if TYPE_CHECKING:
    from rpl.emulator.mechanismfile import MechanismAxis
    from rpl.runtime.trace import Leg, RunResult

# An axis that goes less far than this (deg or mm) stands.
STANDS = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """One axis over time: `name` E1.., `unit` of its positions, rows (k,) of s, positions and speeds; what is known of
    its limits."""

    name: str
    unit: str
    times: FloatArray
    positions: FloatArray
    speeds: FloatArray
    limits: tuple[float, float] | None
    top_speed: float | None


def external_curves(
    result: RunResult, axes: Mapping[int, MechanismAxis], step_s: float, most: int
) -> tuple[Curve, ...]:
    """The curves, each of about `most` samples; `axes` tells what is known of axes by their number (from 1)."""
    legs = sorted(
        (leg for event in driven_moves(result) for leg in event.legs if _counts(leg)), key=lambda leg: leg.start_s
    )
    count = max((len(leg.plan.external_start) for leg in legs), default=0)
    if count == 0:
        return ()
    parts = [_sampled(leg, step_s) for leg in legs if len(leg.plan.external_start) == count]
    times, positions, speeds = (np.concatenate(values) for values in zip(*parts, strict=True))
    moving = np.ptp(positions, axis=0) > STANDS
    kept = thinned(times, most, *np.abs(speeds[:, moving]).T)
    return tuple(
        _curve(place + 1, axes.get(place + 1), times[kept], positions[kept, place], speeds[kept, place])
        for place in range(count)
        if moving[place] or place + 1 in axes
    )


def _counts(leg: Leg) -> bool:
    return leg.duration_s > SHORTEST_LEG_S and len(leg.plan.external_start) > 0


def _sampled(leg: Leg, step_s: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times (k,), positions and speeds (k, e) of one leg; speeds are differences of the plan itself, within the leg."""
    times = moments(leg.start_s, leg.duration_s, step_s)
    local = np.clip(times - leg.start_s, 0.0, leg.duration_s) + leg.offset_s
    half = min(STENCIL_S, 0.5 * leg.duration_s)
    centre = np.clip(local, leg.offset_s + half, leg.offset_s + leg.duration_s - half)
    rises = leg.plan.external_at(centre + half) - leg.plan.external_at(centre - half)
    return times, leg.plan.external_at(local), rises / (2.0 * half)


def _curve(number: int, axis: MechanismAxis | None, times: FloatArray, places: FloatArray, speeds: FloatArray) -> Curve:
    unit = "deg or mm" if axis is None else "mm" if axis.sliding else "deg"
    limits, top = (None, None) if axis is None else (axis.limits, axis.speed)
    return Curve(f"E{number}", unit, times, places, speeds, limits, top)


def curves_as_layers(curves: Sequence[Curve]) -> list[dict[str, object]]:
    """The curves as the page draws them: positions, then speeds, with the limits that are known."""
    found: list[dict[str, object]] = []
    for title, per, values in (("External axes", "", "positions"), ("Speeds of external axes", "/s", "speeds")):
        for curve in curves:
            top = curve.top_speed
            bounds = curve.limits if not per else None if top is None else (-top, top)
            found.append(
                {
                    "name": curve.name,
                    "title": title,
                    "unit": curve.unit + per,
                    "t": np.round(curve.times, 5).tolist(),
                    "values": (np.round(getattr(curve, values), 4) + 0.0).tolist(),
                    "limits": list(bounds or ()),
                }
            )
    return found
