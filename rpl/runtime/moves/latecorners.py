"""Corners that become stops because the program was too late: the next move is not there when the robot's controller
has to plan the corner, and it comes to rest at the point. What a controller logs then is data of its language.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.runtime.moves.orders import Drive
    from rpl.runtime.ports import Robot

CODE = "corner-path-failure"


def tell(queue: Robot, drive: Drive) -> None:
    """Put the controller's warning into the trace, at the line of the move whose corner it is."""
    text = drive.order.rules.advance.late_corner
    if text:
        order = drive.order
        queue.machine.event("warning", {"code": CODE, "text": text}, queue.task, order.code.origin(order.at))
