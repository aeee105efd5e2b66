"""Programs in the languages themselves, run from text."""

from typing import Any

import numpy as np

from rpl import ir
from rpl.cell import Cell, parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.trace import Event, RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

KUKA, ABB = "kuka_kr6r900sixx", "abb_irb120_3_58"


def read(dialect: str, *texts: str) -> ir.Program:
    """A normalised program without errors."""
    suffix = {"krl": ".src", "rapid": ".mod"}.get(dialect, f".{dialect}")
    sources = []
    for number, text in enumerate(texts):
        name = f"p{number}.dat" if text.lstrip().upper().startswith("DEFDAT") else f"p{number}{suffix}"
        sources.append(source_from_text(name, text))
    diagnostics = Diagnostics()
    program = read_sources(sources, dialect, diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return program


def run(dialect: str, text: str, robot: str | None = None, cell: str | Cell | None = None, **more: Any) -> RunResult:
    given = parse_cell(cell) if isinstance(cell, str) else cell
    return run_program(read(dialect, text), robot, given, **more)


def krl(body: str, data: str = "", more: str = "", **options: Any) -> RunResult:
    """Run KRL statements as the routine `prog`."""
    return run("krl", f"DEF PROG( )\n{data}\n{body}\nEND\n{more}\n", entry="prog", **options)


def rapid(body: str, data: str = "", more: str = "", **options: Any) -> RunResult:
    """Run RAPID statements as `main`."""
    return run("rapid", f"MODULE prog\n{data}\nPROC main()\n{body}\nENDPROC\n{more}\nENDMODULE\n", **options)


def moves(result: RunResult) -> list[Event]:
    """The moves in the order in which they ended."""
    return [event for event in result.trace if event.kind == "move"]


def tool_at(result: RunResult, when: float) -> np.ndarray:
    """Where the tool centre point is at a time (3,), mm."""
    legs = [leg for event in moves(result) for leg in event.legs]
    leg = min(legs, key=lambda leg: max(leg.start_s - when, when - leg.start_s - leg.duration_s, 0.0))
    inside = min(max(when - leg.start_s, 0.0), leg.duration_s)
    return np.asarray(leg.plan.tcp_at(inside)[:3, 3])


def time_of(result: RunResult, name: str) -> float:
    """When an output is switched on."""
    return next(t for t, signal, value in result.outputs if signal == name and value)


def on(result: RunResult) -> dict[str, Any]:
    """Outputs at the end."""
    return {name: value for _, name, value in result.outputs}
