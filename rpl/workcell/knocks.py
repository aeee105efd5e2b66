"""Parts that a collision knocks out of their gripper.

What collides is known when a run is over, and a part that is lost changes what comes after it: so the run is made again
with the first such loss in it, and again, until there is no further one. The same seed gives the same run each time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rpl.cell.record import Knock
from rpl.runtime.limits import DEFAULTS, Limits
from rpl.workcell.collisions import Collision, Collisions, find_collisions
from rpl.workcell.running import Driven, run_cell

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.workcell.record import CellRun


def run_and_look(
    cell: Cell, driven: Sequence[Driven], limits: Limits = DEFAULTS
) -> tuple[CellRun, Collisions, tuple[Knock, ...]]:
    """A run, its collisions, and the parts that were knocked out in it: those that a collision meets deeper than the
    cell's `lost_beyond_mm`; none where the cell does not say."""
    knocks: list[Knock] = []
    while True:
        run = run_cell(cell, driven, limits, knocks=knocks)
        found = find_collisions(run)
        further = next(_further(run, found, knocks), None)
        if further is None:
            return run, found, tuple(knocks)
        knocks.append(further)


def _further(run: CellRun, found: Collisions, knocks: Sequence[Knock]) -> Iterator[Knock]:
    """Losses behind those that are known, the first one first."""
    beyond = run.layout.lost_beyond_mm
    if beyond is None:
        return
    known = {(one.gripper, one.t) for one in knocks}
    for one in sorted(found.collisions, key=lambda one: one.t):
        for part, other in ((one.a, one.b), (one.b, one.a)):
            gripper = _holder(run, part, one)
            if gripper and one.depth_mm > beyond and (gripper, one.t) not in known:
                yield Knock(one.t, gripper, other)


def _holder(run: CellRun, part: str, collision: Collision) -> str:
    """The gripper that holds a part at the moment of a collision; "" for none."""
    places = [one for one in run.places_of(part) if one.t <= collision.t]
    return places[-1].on if places and places[-1].state == "held" else ""
