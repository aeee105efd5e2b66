"""Points that a person teaches on the screen, and how they come into the text of a program: one line changes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from rpl.comparing.patching import with_new_point, with_points
from rpl.emulator.rotations import FloatArray, invert_pose, matrix_to_zyx
from rpl.errors import SourceError, UsageError
from rpl.report.motion import line_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rpl.project import ReadProgram
    from rpl.runtime.trace import Event, RunResult
    from rpl.source import Source


@dataclass(frozen=True, slots=True, eq=False)
class Taught:
    """A place of the arm: joints (n,) in pendant units, and the tool (4, 4) on the flange with which `pose` (4, 4) of
    the tool centre point in the robot's base was taught."""

    name: str
    joints: FloatArray
    pose: FloatArray
    tool: FloatArray

    def components(self, frame: FloatArray) -> dict[str, float]:
        """x, y, z in mm and a, b, c in degrees in a frame (4, 4) of the robot's base; to 0.001 mm and 0.0001 deg."""
        seen = invert_pose(frame) @ self.pose
        turned = matrix_to_zyx(seen[:3, :3])
        values = [*np.round(seen[:3, 3], 3), *np.round(turned, 4)]
        return {name: float(value) + 0.0 for name, value in zip("xyzabc", values, strict=True)}

    @property
    def axes(self) -> dict[str, float]:
        """j1, j2 ... in degrees, mm of a sliding joint; to 0.0001."""
        return {f"j{number + 1}": round(float(value), 4) + 0.0 for number, value in enumerate(self.joints)}

    def as_rpl(self, frame: FloatArray) -> str:
        """Its declaration in RPL."""
        said = ", ".join(f"{name}: {value:.10g}" for name, value in self.components(frame).items())
        return f"VAR {self.name}: POSE = {{{said}}}"


@dataclass(frozen=True, slots=True)
class Written:
    """A source with the point in it, and the line that is new or changed."""

    source: Source
    line: int
    text: str

    def __str__(self) -> str:
        return f"{PurePath(self.source.path).name}:{self.line}: {self.text}"


def written(read: ReadProgram, taught: Taught, frame: FloatArray) -> Written:
    """The point in the program's own language: its numbers in the line that declares it, or a new line.

    Raises UsageError or SourceError where neither can be done.
    """
    poses, axes = taught.components(frame), taught.axes
    refused: SourceError | UsageError | None = None
    for components in (poses, axes, {name: poses[name] for name in "xyz"}):
        try:
            return _changed(read, with_points(read, {taught.name: components}))
        except SourceError as error:
            refused = refused or error
        except UsageError as error:
            if "there is no point" not in str(error):
                raise
            refused = error
            break
    else:
        assert refused is not None
        raise refused
    return _new(read, taught, poses, axes)


def _new(read: ReadProgram, taught: Taught, poses: Mapping[str, float], axes: Mapping[str, float]) -> Written:
    try:
        return _changed(read, with_new_point(read, taught.name, poses))
    except SourceError:
        return _changed(read, with_new_point(read, taught.name, axes))


def _changed(read: ReadProgram, sources: Sequence[Source]) -> Written:
    """The first line that differs."""
    for old, new in zip(read.sources, sources, strict=True):
        before, after = old.text.splitlines(), new.text.splitlines()
        if before != after:
            pairs = zip(before, after, strict=False)
            number = next((n for n, (a, b) in enumerate(pairs, start=1) if a != b), min(len(before), len(after)) + 1)
            return Written(new, number, after[number - 1].strip())
    raise UsageError("the point has these values already")


def frame_of(result: RunResult, name: str, t: float) -> tuple[FloatArray, str]:
    """The frame (4, 4) in the robot's base that a point is meant in, and why: that of the move whose line names it,
    else that of the move that is driven at a time, else the base."""
    moves = [event for event in result.trace if event.programmed is not None]
    word = re.compile(rf"(?i)(?<!\w){re.escape(name)}(?!\w)")
    for event in moves:
        if word.search(line_text(event.origin)):
            return _frame(event), f"in the frame of line {event.origin.line}"
    driven = [event for event in moves if event.legs and event.legs[0].start_s <= t + 1e-9]
    if driven:
        return _frame(driven[-1]), f"in the frame of line {driven[-1].origin.line}"
    return np.eye(4), "in the robot's base"


def _frame(event: Event) -> FloatArray:
    frame = event.programmed.frame if event.programmed is not None else None
    return np.eye(4) if frame is None else np.array(frame.matrix, dtype=np.float64)
