"""Moves that a controller leaves out: their blend reaches into that of the move before (Universal Robots).

The manual says that a move is skipped, with a warning, whose blend region overlaps with the blend radius of previous or
following waypoints. M: as the next move is commanded when the robot enters the blend before it, it is the later one of
two overlapping moves that is left out, and the one behind it is the next. M: where a joint move takes part, whose blend
is in joint space, the warning is given and both corners take half of the way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.runtime.moves.orders import Drive
    from rpl.runtime.ports import Robot
    from rpl.runtime.values import Value

CODE = "overlapping-blends"
_SLACK_MM = 1e-3


def is_left_out(queue: Robot, now: Drive) -> bool:
    """Is this move, planned already, left out? If so, it is told."""
    order = now.order
    text = order.rules.inputs.overlapping_blends
    if not text or not queue.queue:
        return False
    before = queue.queue[-1]
    if before.plan is None or now.plan is None or not before.blending or not now.blending:
        return False
    radii = before.order.blend.distance or 0.0, order.blend.distance or 0.0
    way = float(((now.plan.end_pose[:3, 3] - before.plan.end_pose[:3, 3]) ** 2).sum() ** 0.5)
    if min(radii) <= 0.0 or way <= _SLACK_MM or sum(radii) <= way + _SLACK_MM:
        return False
    said = text.format(radius=radii[1], before=radii[0], way=round(way, 3))
    left_out = "joint" not in (before.plan.kind, now.plan.kind)
    data: dict[str, Value] = {"code": CODE, "text": said, "left_out": left_out}
    queue.machine.event("warning", data, queue.task, order.code.origin(order.at))
    return left_out
