"""Moves with values that the controller does not take: times, accelerations, corners, percentages (`InputRules`).

What a program sets for all moves is looked at where it is set; here is what one move says for itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rpl.ir.rules import refusal
from rpl.runtime.moves.orders import BlendOrder, Order
from rpl.runtime.values import Value

if TYPE_CHECKING:
    from rpl.emulator.planner import MotionFault

_ZONE_SIZES = ("path", "rotation_path", "external_path")


def outside(order: Order) -> MotionFault | None:
    """Why the controller does not take the move's own values; None if it does."""
    for name, value in _values(order):
        allowed = order.rules.inputs.range_of(name)
        why = refusal(name, value, allowed) if allowed is not None and isinstance(value, int | float) else ""
        if why:
            from rpl.emulator.planner import MotionFault

            return MotionFault("bad_value", why)
    return None


def _values(order: Order) -> Iterator[tuple[str, Value]]:
    """Name of the quantity and value, of what is said."""
    speed = order.speed
    yield "joint_speed", speed.joint
    yield "move_duration", speed.duration
    yield "path_acceleration", speed.path_acceleration
    yield "axis_acceleration", speed.axis_acceleration
    for key, value in order.modal.items():
        yield key.partition("[")[0], value
    yield from _corner(order.blend)


def _corner(blend: BlendOrder) -> Iterator[tuple[str, Value]]:
    match blend.kind:
        case "distance":
            yield "blend_distance", blend.distance
            yield "blend_rotation", blend.rotation
        case "percent":
            yield "blend_joint", blend.percent
        case "speed":
            yield "blend_speed", blend.percent
    if blend.zone is not None and not blend.stops:
        yield "blend_distance", blend.distance
        for name in _ZONE_SIZES:
            yield "blend_distance", blend.zone.get(name)
