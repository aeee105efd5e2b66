"""What a program asks its controller and the project itself tells: switches, speeds, the hand, its own task.

Everything else of the kind is a value that only the controller has.
"""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.source import Origin

from . import signals, tables
from .expressions import Facts

# M: SPEED(1) is the monitor speed, SPEED(2) the program's speed for good, ACCEL(1) and ACCEL(2) the two percentages,
# DURATION(1) the least time for good.
_SETTINGS: dict[tuple[str, int], str] = {
    ("speed", 1): "override",
    ("speed", 2): "joint_speed",
    ("accel", 1): "acceleration_percent",
    ("accel", 2): "deceleration_percent",
    ("duration", 1): "move_duration",
}


def switch(name: str, facts: Facts, origin: Origin) -> ir.Expression | None:
    """SWITCH(name): continuous path is a setting here; the emulated robot has its power on. None: nobody can say."""
    if name in tables.SETTING_SWITCHES:
        return ir.System(tables.SETTING_SWITCHES[name], origin=origin)
    if name in tables.SWITCHED_ON and name not in facts.switched:
        return ir.BoolLiteral(True, origin=origin)
    if name == "dry.run" and name not in facts.switched:
        return ir.BoolLiteral(False, origin=origin)
    return None


def parameter(name: str, facts: Facts, origin: Origin) -> ir.Expression | None:
    """PARAMETER(name), as far as the project sets it."""
    if name == "hand.time" and facts.hand_time_s is not None:
        return ir.RealLiteral(facts.hand_time_s, origin=origin)
    return None


def value(name: str, given: Sequence[ir.Expression], facts: Facts, origin: Origin) -> ir.Expression | None:
    """The value of a function with plain arguments."""
    match name, given:
        case _, [ir.IntLiteral(value=number)] if (name, number) in _SETTINGS:
            return ir.System(_SETTINGS[name, number], origin=origin)
        case "task", [] if not facts.executed:
            return ir.IntLiteral(0, origin=origin)
        case "priority", [] if not facts.locks:
            return ir.IntLiteral(0, origin=origin)
        case "hand", []:  # M: 1 for an open hand, 0 for a closed one
            opened = ir.Signal("digital_out", ir.IntLiteral(tables.HAND_OPEN), origin=origin)
            return ir.Convert("bit", opened, origin=origin)
        case "select", [ir.Name(id=device), *_] if device.lower() == "robot":  # M: one robot
            return ir.IntLiteral(1, origin=origin)
        case "sig.ins", [ir.IntLiteral(value=number)] if signals.kind_of(number) is not None:
            return ir.BoolLiteral(True, origin=origin)
    return None


__all__ = ["parameter", "switch", "value"]
