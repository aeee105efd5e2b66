"""What a run of a cell shows, for reports, for the search for collisions and for drawing it: each robot with its trace,
and what happened to the bodies."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl.cell.layout import Layout, RobotPlace
from rpl.cell.record import Grasp, Opening, Placed, State, pose_between

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.ir.modules import Program
    from rpl.runtime.trace import RunResult


@dataclass(frozen=True, slots=True)
class RobotRun:
    """A robot of the cell, its program, and how its run went. `model` None: its moves take no time."""

    place: RobotPlace
    model: RobotModel | None
    program: Program
    result: RunResult


@dataclass(frozen=True, slots=True)
class CellRun:
    """A run of a whole cell. `placed`, by time: the places of each part, the first at 0 s. `status`: the worst of the
    robots'; `fault`: what each of those that did not end waits for, or why it stopped."""

    layout: Layout
    robots: tuple[RobotRun, ...]
    placed: tuple[Placed, ...] = ()
    grasps: tuple[Grasp, ...] = ()
    openings: tuple[Opening, ...] = ()
    status: str = ""
    time_s: float = 0.0
    fault: str = ""
    notes: tuple[str, ...] = field(default=())

    def places_of(self, part: str) -> list[Placed]:
        """The places of a part by time."""
        return [one for one in self.placed if one.part == part]


__all__ = ["CellRun", "Grasp", "Opening", "Placed", "RobotRun", "State", "pose_between"]
