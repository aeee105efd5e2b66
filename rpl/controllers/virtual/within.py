"""One program in the place of another that waits: what robot, signals and data have goes along, and back."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl import ir

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rpl.runtime.ports import Task
    from rpl.runtime.values import Value
    from rpl.simulation import Simulation


# What a value is as data of a type: two readings of a program may tell them apart in other ways.
Fit = Callable[[ir.Type, "Value"], "Value"]


def as_it_is(type: ir.Type, value: Value) -> Value:
    return value


def data_of(simulation: Simulation) -> dict[str, Value]:
    """The global data of a program, by `module.name`; also what only routines use that nobody has called yet."""
    for module in simulation.program.program.modules:
        for one in module.declarations:
            if isinstance(one, ir.Variable):
                simulation.program.variable_slot(f"{module.name}.{one.name}")  # makes it a place
    slots = simulation.program.slots
    if len(simulation.globals) < len(slots):
        simulation.linked.initialise(simulation.globals, simulation)
    return {slot.qualified: value for slot, value in zip(slots, simulation.globals, strict=False)}


def give_data(simulation: Simulation, values: Mapping[str, Value], fit: Fit) -> None:
    """Give the program's data these values, where it has data of the name."""
    data_of(simulation)  # has given all data its first value
    types = {
        f"{module.name}.{one.name}": one.type
        for module in simulation.program.program.modules
        for one in module.declarations
        if isinstance(one, ir.Variable)
    }
    for place, slot in enumerate(simulation.program.slots):
        name = slot.qualified
        if name in values:
            simulation.globals[place] = fit(types[name], values[name]) if name in types else values[name]


def moving_task(simulation: Simulation) -> Task | None:
    """The task that drives the robot."""
    return next((task for task in simulation.tasks if task.robot is not None), None)


def is_at_rest(simulation: Simulation) -> bool:
    task = moving_task(simulation)
    return task is None or task.robot is None or (task.robot.is_standing() and not task.busy)


def carry(before: Simulation, after: Simulation, fit: Fit) -> None:
    """What stands around a program: where the robot is, its tool and load, the signals, and data of the same name."""
    old, new = moving_task(before), moving_task(after)
    if old is not None and new is not None and old.robot is not None and new.robot is not None:
        new.robot.joints = new.robot.planned_joints = old.robot.joints_array()
        new.robot.external = new.robot.planned_external = old.robot.external_now()
        new.modal.update(old.modal)
    changed = {key: value for key, value in before.signals.items() if after.signals.get(key) != value}
    after.signals.update(changed)
    give_data(after, data_of(before), fit)
    if changed:
        after.changed()
