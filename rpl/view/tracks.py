"""How each robot of a run moves: joints and tool over time, the tools it drives with, and the line it is at.

Joints between two samples are taken as straight: at 50 Hz an axis that accelerates with 2,000 deg/s2 is off by 0.1 deg
at most (a·h²/8), which is less than a pixel.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray
from rpl.report.motion import tool_rates
from rpl.report.sampling import driven_moves, sample_run
from rpl.source import Source
from rpl.workcell.sweeping.ways import way_of

if TYPE_CHECKING:
    from rpl.runtime.trace import RunResult
    from rpl.workcell.record import CellRun, RobotRun

STEP_S = 0.02
# More samples than this are taken farther apart: ten minutes at 50 Hz.
MOST_SAMPLES = 30_000


@dataclass(frozen=True, slots=True)
class LineAt:
    """From a time on a task is at a line: of the move that is driven, or of what it does beside."""

    t: float
    file: str
    line: int
    task: str


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """The motion of one robot at k moments: times (k,) s, joints (k, n) in pendant units, tool centre point (k, 3) mm
    in the cell and its speed (k,) mm/s as its own axes move it. `tools`: from which time on which tool (4, 4) on the
    flange; `lines` by time; `bases` (k, 4, 4) of a robot that a track carries."""

    times: FloatArray
    joints: FloatArray
    tool: FloatArray
    speeds: FloatArray
    tools: tuple[tuple[float, FloatArray], ...]
    lines: tuple[LineAt, ...]
    bases: FloatArray | None = None

    def base_at(self, t: float) -> FloatArray | None:
        """The robot's base (4, 4) in the cell where a track carries it; it turns at samples only."""
        if self.bases is None:
            return None
        pose = self.bases[max(int(np.searchsorted(self.times, t, side="right")) - 1, 0)].copy()
        pose[:3, 3] = [np.interp(t, self.times, axis) for axis in self.bases[:, :3, 3].T]
        return np.asarray(pose)

    def joints_at(self, t: float) -> FloatArray:
        """Joints (n,) at a time, held before the first and behind the last sample."""
        return np.array([np.interp(t, self.times, axis) for axis in self.joints.T])

    def tool_at(self, t: float) -> FloatArray:
        """The tool (4, 4) on the flange that is driven with at a time."""
        found = np.eye(4)
        for since, tool in self.tools:
            if since <= t + 1e-9 or found is self.tools[0][1]:
                found = tool
        return found

    def line_at(self, t: float, task: str | None = None) -> LineAt | None:
        """Where the program is at a time."""
        known = [one for one in self.lines if one.t <= t + 1e-9 and task in (None, one.task)]
        return known[-1] if known else None


def track_of(run: RobotRun, step_s: float = STEP_S) -> Track:
    """The motion of a robot. Without a model it has lines only."""
    lines = lines_of(run.result)
    if run.model is None:
        nothing = np.zeros((0, 3))
        return Track(np.zeros(0), np.zeros((0, 0)), nothing, np.zeros(0), (), lines)
    samples = sample_run(run.result, run.model, max(step_s, run.result.time_s / MOST_SAMPLES))
    speeds, _ = tool_rates(run.model, samples)
    bases = way_of(run, "", run.model).bases(samples.times)
    tools: list[tuple[float, FloatArray]] = []
    for event in driven_moves(run.result):
        tool = event.legs[0].plan.geometry.tool
        if not tools or not np.array_equal(tools[-1][1], tool):
            tools.append((event.legs[0].start_s, tool))
    path = np.einsum("...ij,...j->...i", bases[..., :3, :3], samples.tool) + bases[..., :3, 3]
    carried = bases if bases.ndim == 3 else None
    return Track(samples.times, samples.joints, path, speeds, tuple(tools), lines, carried)


def lines_of(result: RunResult) -> tuple[LineAt, ...]:
    """The lines of a run by time: of each event, of a move when it begins to be driven."""
    found: list[LineAt] = []
    for event in result.trace:
        if event.origin.source is not None and event.kind not in ("input", "warning"):
            t = event.legs[0].start_s if event.legs else event.t
            found.append(LineAt(t, event.origin.file, event.origin.line, event.task))
    found.sort(key=lambda one: one.t)
    last: dict[str, LineAt] = {}
    kept: list[LineAt] = []
    for one in found:
        before = last.get(one.task)
        if before is None or (before.file, before.line) != (one.file, one.line):
            kept.append(one)
        last[one.task] = one
    return tuple(kept)


def sources_of(run: CellRun) -> dict[str, Source]:
    """The files of all programs by their path, in the order in which they are named."""
    found: dict[str, Source] = {}
    for robot in run.robots:
        origins = [module.origin for module in robot.program.modules]
        origins += [event.origin for event in robot.result.trace]
        for origin in origins:
            if origin.source is not None:
                found.setdefault(origin.file, origin.source)
    return found


def short_names(files: list[str]) -> dict[str, str]:
    """A file goes by its name alone where no other one has it."""
    names = [PurePath(file).name for file in files]
    return {file: name if names.count(name) == 1 else file for file, name in zip(files, names, strict=True)}
