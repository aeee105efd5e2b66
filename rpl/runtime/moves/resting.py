"""Waits that are moves without a way (V+ DELAY): the robot keeps still for a time, and the program goes on.

They begin when everything commanded before has been driven; what drives the robot or waits for it begins behind them.
A stop of the motion ends them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.runtime.ports import Robot


def rest(queue: Robot, seconds: float) -> None:
    """Keep the robot, which stands, where it is for so long."""
    if seconds <= 0.0:
        return
    queue.resting = queue.task.busy = True
    queue.generation += 1
    queue.schedule(queue.machine.now + seconds, "rested")


def ended(queue: Robot) -> None:
    """The time is over, or the motion was stopped."""
    if queue.resting:
        queue.resting = False
        queue.generation += 1
        queue.task.busy = bool(queue.queue) or queue.piece is not None
        queue.machine.look_at(queue.task)
