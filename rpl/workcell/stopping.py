"""A run that a collision ends."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rpl.runtime.trace import Fault

if TYPE_CHECKING:
    from rpl.workcell.collisions import Collision
    from rpl.workcell.record import CellRun

COLLISION = "collision"


def stopped_at(run: CellRun, first: Collision) -> CellRun:
    """The run that was ended at the moment of its first collision, with that as the fault of every robot that had not
    ended before it."""
    text = f"{first.a} collides with {first.b}"
    robots = []
    for one in run.robots:
        result = one.result
        if result.status == "limit" and result.fault is not None:
            fault = Fault(COLLISION, text, result.fault.task, result.fault.origin)
            result = replace(result, status="fault", fault=fault)
        robots.append(replace(one, result=result))
    return replace(run, robots=tuple(robots), status="fault", fault=f"{text} after {first.t:.3f} s")
