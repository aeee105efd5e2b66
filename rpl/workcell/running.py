"""Runs the robots of a cell together: each program on its own controller's machine, all on one clock and among the same
bodies.

The machine whose next event is the earliest goes on, so that what one robot switches reaches another one at its moment.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rpl.cell.cellfile import Cell
from rpl.cell.layout import Layout, RobotPlace
from rpl.cell.record import Knock
from rpl.cell.world import World
from rpl.depth import at_any_depth
from rpl.errors import UsageError
from rpl.runtime.awaited import words
from rpl.runtime.limits import DEFAULTS, Limits
from rpl.runtime.signals import Key, usual_key
from rpl.runtime.trace import Event
from rpl.simulation import Simulation
from rpl.workcell.record import CellRun, RobotRun

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.ir.modules import Program
    from rpl.motionmodel import MotionModel

# How a run of several robots ended, from the worst on.
_WORST = ("fault", "deadlock", "limit", "interrupted", "stopped", "finished")


@dataclass(frozen=True, slots=True)
class Driven:
    """A robot of a cell with the program that it runs. `further`: arms of the second and further motion tasks."""

    place: RobotPlace
    program: Program
    model: RobotModel
    entry: str | None = None
    controller: str | MotionModel | None = None
    further: tuple[RobotModel, ...] = ()


def run_cell(
    cell: Cell,
    driven: Sequence[Driven],
    limits: Limits = DEFAULTS,
    on_event: Callable[[str, Event], None] | None = None,
    knocks: Sequence[Knock] = (),
) -> CellRun:
    """Run the programs of all robots of a cell. `on_event` is told the robot's name and what happened. `knocks`: what
    grippers lose on the way (see rpl.workcell.knocks).

    Raises UsageError where the cell does not fit the programs, RunInterrupted for Ctrl-C. Faults are in the results.
    """
    return at_any_depth(lambda: _run(cell, driven, limits, on_event, knocks))


def _run(
    cell: Cell,
    driven: Sequence[Driven],
    limits: Limits,
    on_event: Callable[[str, Event], None] | None,
    knocks: Sequence[Knock],
) -> CellRun:
    world = World(cell.layout, cell.seed, knocks)
    if not driven:
        time = world.settle_alone()
        placed = tuple(sorted(world.placed, key=lambda one: one.t))
        return CellRun(cell.layout, (), placed, status="finished", time_s=time)
    machines = {one.place.name: _machine(cell, one, world, limits, on_event) for one in driven}
    try:
        _until_the_end(machines)
    except KeyboardInterrupt:
        for machine in machines.values():
            if not machine.status:
                machine.status = "interrupted"
        raise next(iter(machines.values())).interrupted() from None
    return _recorded(cell.layout, driven, machines, world)


def _machine(
    cell: Cell, one: Driven, world: World, limits: Limits, on_event: Callable[[str, Event], None] | None
) -> Simulation:
    name = one.place.name
    tell = (lambda event: on_event(name, event)) if on_event is not None else None
    own = its_share(cell, name) if len(cell.layout.robots) > 1 else cell
    own = replace(own, joints=one.place.joints) if one.place.joints is not None else own
    entry = one.entry or one.place.entry or None
    return Simulation(
        one.program, one.model, own, entry, None, None, tell, limits, one.controller, one.further, None, (world, name)
    )


def its_share(cell: Cell, robot: str) -> Cell:
    """What a cell of several robots says of one: signals and variables that its name stands before, `left.di3`.

    Raises UsageError for one that belongs to none of them.
    """
    names = [one.name for one in cell.layout.robots]
    for named in (*(one.signal for one in cell.inputs), *(one.when for one in cell.reactions), *cell.variables):
        if named.partition(".")[0] not in names:
            kind = "variable" if named in cell.variables else "signal"
            raise UsageError(f"{cell.path}: the {kind} {named}: say whose it is: {names[0]}.{named}")
    reactions = []
    for one in cell.reactions:
        if (when := _own(robot, one.when)) is None:
            continue
        if (answer := _own(robot, one.signal)) is None:
            raise UsageError(f"{cell.path}: {one.when} and {one.signal} are signals of two robots: use a [[wire]]")
        reactions.append(replace(one, when=when, signal=answer))
    inputs = [replace(one, signal=mine) for one in cell.inputs if (mine := _own(robot, one.signal)) is not None]
    values = {rest: value for name, value in cell.variables.items() if (rest := _own(robot, name)) is not None}
    return replace(cell, inputs=tuple(inputs), reactions=tuple(reactions), variables=values)


def _own(robot: str, name: str) -> str | None:
    """The name behind that of the robot; None where another one stands there."""
    first, dot, rest = name.partition(".")
    return rest if dot and first == robot else None


def _until_the_end(machines: Mapping[str, Simulation]) -> None:
    alive = list(machines.values())
    while alive:
        for machine in alive:
            machine.outside = len(alive) > 1
        able = [machine for machine in alive if not machine.waits_outside]
        if not able:
            ended = [machine for machine in machines.values() if machine.status == "limit"]
            for machine in alive:
                machine.outside = False
                if ended:  # they would go on if that one had
                    machine.end_at_limit("max-time", f"waits for a robot that was ended after {ended[0].now:g} s")
                else:
                    machine.advance()  # it finds that nothing is to come
            return
        min(able, key=lambda machine: machine.next_s).advance()
        alive = [machine for machine in alive if not machine.status]


def _recorded(layout: Layout, driven: Sequence[Driven], machines: Mapping[str, Simulation], world: World) -> CellRun:
    robots = tuple(RobotRun(one.place, one.model, one.program, machines[one.place.name].result()) for one in driven)
    status = min((one.result.status for one in robots), key=_WORST.index)
    return CellRun(
        layout,
        robots,
        tuple(sorted(world.placed, key=lambda one: one.t)),
        tuple(world.grasps),
        tuple(world.openings),
        status,
        max(one.result.time_s for one in robots),
        "; ".join(_stopped(layout, robots, machines)),
        tuple(world.notes),
    )


def _stopped(layout: Layout, robots: Sequence[RobotRun], machines: Mapping[str, Simulation]) -> Iterator[str]:
    """Why each robot that did not come to its end stands, and who could let it go on."""
    for one in robots:
        fault, name = one.result.fault, one.place.name
        if fault is None:
            continue
        text = fault.message
        if one.result.status == "deadlock":
            machine = machines[name]
            waiting = [words(machine, task) for task in machine.tasks if not task.has_ended]
            text = "; ".join(waiting) or text
            asked = {_known(signal) for each in one.result.awaited for signal, _ in each.inputs}
            for wire in layout.wires:
                if wire.to_robot == name and _known(wire.input) in asked:
                    text += f" (driven by {wire.robot}.{wire.output})"
        yield f"{name}: {text}" if name else text


def _known(signal: str) -> Key:
    """Kind and number of a signal where its name says them."""
    plain = signal.partition(" (")[0]
    return usual_key(plain) or plain.lower()
