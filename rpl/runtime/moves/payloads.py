"""What the robot carries in a move, as the program says it: the load of the tool and that of the part.

A program gives a load as mass, centre and inertias in axes of its own. The tool's load is given in the flange; a load
set for all moves is given in the flange too, or in the tool where the language has loads of tools besides.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rpl.passes import rigid
from rpl.runtime.moves.orders import Modal, Order, Payload
from rpl.runtime.values import Array, PoseValue, Record, RotationValue, Value, VectorValue

if TYPE_CHECKING:
    from rpl.ir.rules import LoadVariables
    from rpl.runtime.ports import Machine


def payloads_of(order: Order, modal: Modal, machine: Machine) -> tuple[Payload, ...]:
    """The loads of a move; none where the program has said nothing."""
    if order.rules.load_variables is not None:
        kept = _kept(order.rules.load_variables, machine)
        return () if kept is None else (kept,)
    tool = order.tool if order.tool is not None else modal.get("tool")
    of_tools = order.rules.loads_of_tools
    found = []
    if order.load is not None and of_tools:  # the whole load of this move, tool and part
        return tuple(one for one in (_payload(order.load, rigid.IDENTITY),) if one is not None)
    if isinstance(tool, Record) and tool.parts.get("held"):
        found.append(_payload(tool.parts.get("load"), rigid.IDENTITY))
    frame = _frame(tool) if of_tools else rigid.IDENTITY
    found.append(_payload(modal.get("load"), frame))
    return tuple(one for one in found if one is not None)


def _kept(names: LoadVariables, machine: Machine) -> Payload | None:
    """The load in the language's own variables: that in force, else that of the tool's number."""
    load = _named(machine.global_value(names.variable), names)
    if load is not None:
        return load
    number, table = machine.global_value(names.number), machine.global_value(names.table)
    if not isinstance(table, Array) or not isinstance(number, int):
        return None
    place = number - table.base
    return _named(table.items[place], names) if 0 <= place < len(table.items) else None


def _named(load: Value, names: LoadVariables) -> Payload | None:
    def component(name: str) -> Value:
        found = load
        for part in names.components[name].split("."):
            found = found.parts.get(part) if isinstance(found, Record) else None
        return found

    mass, frame = _number(component("mass")), component("frame")
    if mass <= 0.0:
        return None
    place = frame.rigid() if isinstance(frame, PoseValue) and _is_whole(frame) else rigid.IDENTITY
    return Payload(mass, place, (_number(component("ix")), _number(component("iy")), _number(component("iz"))))


def _is_whole(pose: PoseValue) -> bool:
    return None not in pose.trans and None not in pose.rot.parts


def _frame(tool: Value) -> rigid.Pose:
    """The tool centre point in the flange; a stationary tool has none there: the part's load is then in the flange."""
    if isinstance(tool, Record):
        tool = tool.parts.get("frame") if tool.parts.get("held") else None
    return tool.rigid() if isinstance(tool, PoseValue) else rigid.IDENTITY


def _payload(load: Value, frame: rigid.Pose) -> Payload | None:
    """The body that a load describes; None for no load, or one without a mass."""
    if not isinstance(load, Record):
        return None
    mass = _number(load.parts.get("mass"))
    if mass <= 0.0:
        return None
    centre = load.parts.get("cog")
    place = [_number(part) for part in centre] if isinstance(centre, VectorValue) else [0.0, 0.0, 0.0]
    axes = load.parts.get("axes")
    turn = axes.rigid() if isinstance(axes, RotationValue) and None not in axes.parts else rigid.NO_TURN
    inertias = tuple(_number(load.parts.get(name)) for name in ("ix", "iy", "iz"))
    return Payload(mass, frame.then(rigid.Pose(rigid.Vector(*place), turn)), (inertias[0], inertias[1], inertias[2]))


def _number(value: Value) -> float:
    """A component that is not given counts as nothing."""
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else 0.0
