"""Inputs and outputs of a run over time: one row a signal, its changes with the place that made them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.runtime.trace import RunResult

# What a page can show; the trace has them all.
MOST_CHANGES = 20_000


@dataclass(slots=True)
class SignalRow:
    """A signal: `kind` output or input; `level`: it has two states only. Changes: time s, value, what the program
    wrote, and where."""

    name: str
    kind: str
    level: bool = True
    changes: list[tuple[float, float, str, Origin]] = field(default_factory=list)


def signal_rows(result: RunResult, most: int = MOST_CHANGES) -> tuple[tuple[SignalRow, ...], int]:
    """The rows, outputs first, each kind in the order of the first change; and how many changes were left out."""
    rows: dict[tuple[str, str], SignalRow] = {}
    events = [event for event in result.trace if event.kind in ("output", "input")]
    for event in events[:most]:
        name, value = str(event.data.get("signal", "")), event.data.get("value")
        row = rows.setdefault((event.kind, name), SignalRow(name, event.kind))
        if isinstance(value, bool):
            height, text = float(value), str(value).upper()
        elif isinstance(value, int | float):
            height, text = float(value), f"{value:g}"
            row.level = row.level and value in (0, 1)
        else:
            height, text = 1.0, str(value)
        row.changes.append((event.t, height, text, event.origin))
    ordered = sorted(rows.values(), key=lambda row: row.kind != "output")
    return tuple(ordered), max(len(events) - most, 0)
