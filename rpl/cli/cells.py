"""`rpl run --cell` where the cell has bodies: its robots run together, and what came of it is said."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import wraps
from typing import TYPE_CHECKING, Any, cast

import click

from rpl.cli.output import (
    Decorated,
    arm_of,
    collector,
    print_diagnostics,
    print_json,
    read_paths,
    robot_named,
    say,
    waiting,
)
from rpl.cli.reports import assumptions, say_remarks, say_what_is_assumed, show_reports, warnings_of
from rpl.diagnostics import Severity
from rpl.errors import UsageError
from rpl.showing import counted, printable

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.cli.reports import Reports
    from rpl.runtime.limits import Limits
    from rpl.runtime.trace import Event
    from rpl.runtime.values import Value
    from rpl.workcell.collisions import Collisions
    from rpl.workcell.loading import Loaded
    from rpl.workcell.outcome import Outcome
    from rpl.workcell.record import CellRun

_FINISHED = ("finished", "stopped")


@dataclass(frozen=True, slots=True)
class BodiesAsked:
    """What is asked of the bodies of a cell."""

    collisions: bool = False
    stops: bool = False
    repeat: int = 1
    jobs: int = 1

    def needs_bodies(self) -> str:
        """The first option that is about bodies; "" for none."""
        given = (("--collisions", self.collisions), ("--stop-at-collision", self.stops), ("--repeat", self.repeat > 1))
        return next((name for name, asked in given if asked), "")


def bodies_options(command: Decorated) -> Decorated:
    """The options about bodies; the command gets them as `bodies`."""

    @wraps(command)
    def with_bodies(collisions: bool, stop_at_collision: bool, repeat: int, jobs: int, **values: Any) -> Any:
        asked = BodiesAsked(collisions or stop_at_collision, stop_at_collision, repeat, jobs)
        return command(bodies=asked, **values)

    options = (
        click.option("--collisions", is_flag=True, help="Look for collisions and near misses of the cell's bodies."),
        click.option("--stop-at-collision", is_flag=True, help="The first collision ends the run with a fault."),
        click.option(
            "--repeat", type=click.IntRange(1), default=1, metavar="N", help="Run N times, each with the next seed."
        ),
        click.option("--jobs", type=click.IntRange(1), default=1, metavar="K", help="Processes that share --repeat."),
    )
    decorated: Any = with_bodies
    for option in reversed(options):
        decorated = option(decorated)
    return cast(Decorated, decorated)


@dataclass(frozen=True, slots=True)
class CellAsked:
    """A run of a cell with bodies, as it is asked for. `robots`: the arms that --robot names."""

    paths: Sequence[str]
    dialect: str | None
    robots: Sequence[str]
    entry: str | None
    limits: Limits
    reports: Reports | None
    despite_errors: bool
    bodies: BodiesAsked
    as_json: bool


def run_among_bodies(cell: Cell, asked: CellAsked, write: Callable[[CellRun, Sequence[Loaded]], None]) -> int:
    """Run it, say what came of it, and let the files be written that are asked for; the exit status."""
    from rpl.workcell.outcome import outcome_of

    _about_all(cell, asked.reports)
    if asked.bodies.stops and asked.bodies.repeat > 1:
        raise UsageError("--stop-at-collision is about one run: --repeat counts --collisions")
    loaded = loaded_robots(cell, asked)
    if loaded is None:
        return 1
    if asked.bodies.repeat > 1:
        return _repeated(cell, asked, loaded)
    with waiting("running"):
        run, found = _looked_at(cell, asked, loaded) if asked.bodies.collisions else (_once(cell, asked, loaded), None)
        if found is not None and asked.bodies.stops and found.collisions:
            run = _stopped(cell, asked, loaded, found)
    _told(run, outcome_of(run), found, asked)
    write(run, loaded)
    return 0 if run.status in _FINISHED and (found is None or not found.collisions) else 1


def first_arm(cell: Cell | None) -> str | None:
    """The arm that a cell names for its first robot."""
    places = cell.layout.robots if cell is not None else ()
    return places[0].arm or None if places else None


def _about_all(cell: Cell, reports: Reports | None) -> None:
    """Raises UsageError for reports that are about one robot, in a cell of several."""
    if reports is None or len(cell.layout.robots) < 2:
        return
    asked = (("--plot", reports.plot is not None), ("--times", reports.timed), ("--dynamics", reports.dynamics))
    if name := next((name for name, given in asked if given), ""):
        raise UsageError(f"{name} is about one robot, and {cell.path} has several: `rpl view` shows them all")


def _told(run: CellRun, outcome: Outcome, found: Collisions | None, asked: CellAsked) -> None:
    """What came of it, for machines or for people; with the reports about one robot that are asked for."""
    for one in run.robots:
        say_remarks(one.result, one.model)
    first = run.robots[0] if run.robots else None
    layers, times = None, None
    if first is not None and asked.reports is not None:
        layers = asked.reports.layers(first.result, first.model)
        times = asked.reports.times(first.result, first.model)
    if asked.as_json:
        more = {"dynamics": layers, "times": times}
        named = {name: made.as_json() for name, made in more.items() if made is not None}
        print_json(document(run, outcome, found) | named)
        return
    for one in run.robots:
        for line in assumptions(one.result.assumed or ()):
            say(line)
    for line in shown(run, outcome, found):
        say(line)
    for one in run.robots:
        print_diagnostics(warnings_of(one.result))
    show_reports(layers, times)


def loaded_robots(cell: Cell, asked: CellAsked) -> tuple[Loaded, ...] | None:
    """The robots with their programs; None where one has errors, which are shown."""
    from rpl.workcell.loading import Loaded, robots_of, settled
    from rpl.workcell.running import Driven, its_share

    diagnostics = collector()
    controller = asked.reports.controller if asked.reports is not None else None
    robots = cell.layout.robots
    if asked.paths and len(robots) > 1:
        raise UsageError(f"{cell.path} names the programs of its {len(robots)} robots: leave the paths out")
    if asked.paths:
        read = read_paths(asked.paths, asked.dialect, diagnostics)
        place = cell.layout.robot("")
        name = asked.robots[0] if asked.robots else place.arm or arm_of(read)
        model = robot_named(name)
        if model is None:
            raise UsageError(f"{cell.path}: bodies need an arm: name it with --robot, or in a [[robot]] of the cell")
        model = model.among(cell.mechanisms, cell.path)
        others = tuple(one for each in asked.robots[1:] if (one := robot_named(each)) is not None)
        program = settled(read, cell, diagnostics)
        found: tuple[Loaded, ...] = (Loaded(Driven(place, program, model, asked.entry, controller, others), read),)
    elif asked.robots:
        raise UsageError(f"--robot goes with the PATH of a program: without one the arms are those of {cell.path}")
    elif robots or not cell.layout.grippers:
        if asked.entry is not None and len(robots) != 1:
            raise UsageError(f"--entry is about one robot: {cell.path} says of each with which routine it begins")
        found = tuple(
            replace(one, driven=replace(one.driven, controller=controller, entry=asked.entry))
            for one in robots_of(cell, diagnostics)
        )  # without any robots the parts fall, and that is all
    else:
        raise UsageError("no program: name its PATH, or give the robots of the cell file `programs`")
    print_diagnostics(diagnostics, Severity.WARNING)
    for driven in (one.driven for one in found):
        name = driven.place.name
        own = replace(its_share(cell, name), layout=cell.layout.of(name)) if len(found) > 1 else cell
        say_what_is_assumed(driven.program, driven.model, own)
    if diagnostics.has_errors and not asked.despite_errors:
        count = counted(len(diagnostics.of(Severity.ERROR)), "error")
        say(f"not started: {count} in the program (--despite-errors runs what was read)", err=True)
        return None
    return found


def _once(cell: Cell, asked: CellAsked, loaded: Sequence[Loaded]) -> CellRun:
    from rpl.workcell.running import run_cell

    return run_cell(cell, [one.driven for one in loaded], asked.limits)


def _looked_at(cell: Cell, asked: CellAsked, loaded: Sequence[Loaded]) -> tuple[CellRun, Collisions]:
    """A run and its collisions; with what they knock out of grippers, unless the first of them ends it."""
    from rpl.workcell.knocks import run_and_look

    layout = replace(cell.layout, lost_beyond_mm=None) if asked.bodies.stops else cell.layout
    run, found, _ = run_and_look(replace(cell, layout=layout), [one.driven for one in loaded], asked.limits)
    return run, found


def _stopped(cell: Cell, asked: CellAsked, loaded: Sequence[Loaded], found: Collisions) -> CellRun:
    """The run until its first collision, which is its fault."""
    from rpl.workcell.stopping import stopped_at

    first = min(found.collisions, key=lambda one: one.t)
    until = replace(asked, limits=replace(asked.limits, time_s=first.t))
    return stopped_at(_once(cell, until, loaded), first)


def _repeated(cell: Cell, asked: CellAsked, loaded: Sequence[Loaded]) -> int:
    """Statistics of many runs."""
    from rpl.workcell.repeating import repeat, statistics

    with waiting(f"running {asked.bodies.repeat} times"):
        driven, look = [one.driven for one in loaded], asked.bodies.collisions
        runs = repeat(cell, driven, asked.limits, asked.bodies.repeat, asked.bodies.jobs, look)
    made = statistics(runs)
    if asked.as_json:
        print_json(made.as_json())
    else:
        for line in made.lines():
            say(line)
    return 0 if all(one.status in _FINISHED and not one.collisions for one in runs) else 1


# ---- what is shown


def document(run: CellRun, outcome: Outcome, found: Collisions | None) -> dict[str, Value]:
    """What --json prints: the keys of a run of one robot, in a cell of several with their names before signals and
    messages, and those of the bodies."""
    several = len(run.robots) > 1
    results = [(f"{one.place.name}." if several else "", one.result) for one in run.robots]
    outputs = sorted(
        ([round(t, 6), f"{name}{signal}", value] for name, result in results for t, signal, value in result.outputs),
        key=lambda one: one[0],
    )
    assumed = [one.as_json() for _, result in results for one in result.assumed or ()]
    faults = [result.fault for _, result in results if result.fault is not None and result.status == run.status]
    return {
        "status": run.status,
        "time_s": round(run.time_s, 6),
        "moves": sum(result.moves for _, result in results),
        "statements": sum(result.statements for _, result in results),
        "messages": [f"{name}{text}" for name, result in results for text in result.messages],
        "outputs": outputs,
        "fault": faults[0].as_json() if faults else None,
        **({"assumed": assumed} if any(result.assumed is not None for _, result in results) else {}),
        **outcome.as_json(),
        **(found.as_json() if found is not None else {"collisions": None, "near": None}),
        "notes": [*outcome.notes, *(found.notes if found is not None else ())],
    }


def shown(run: CellRun, outcome: Outcome, found: Collisions | None) -> Iterator[str]:
    """The same for people."""
    several = len(run.robots) > 1
    said = [
        (event.t, line)
        for one in run.robots
        for event in one.result.trace
        if (line := _line_of(event, f"{one.place.name}." if several else ""))
    ]
    for grasp in outcome.grasps:
        held = f"{'takes' if grasp.ok else 'loses' if grasp.lost else 'misses'} {grasp.part}".rstrip()
        said.append((grasp.t, f"{grasp.t:9.3f} s  {grasp.gripper} {held}" + (f": {grasp.why}" if grasp.why else "")))
    yield from (line for _, line in sorted(said, key=lambda one: one[0]))
    if found is not None:
        yield from found.lines()
    elif run.robots:
        yield "collisions were not looked for (--collisions does)"
    for name, times in outcome.cycles:
        if times:
            mean = sum(times) / len(times)
            yield f"{name}: {counted(len(times), 'cycle')}, {mean:.3f} s each ({min(times):.3f} to {max(times):.3f} s)"
    for one in outcome.busy:
        moves = f"moves for {100.0 * one.share:.0f} % of the time"
        yield f"{one.robot or 'robot'}: {one.status} after {one.time_s:.3f} s, {moves}"
    for each in outcome.settled:
        down = ", ".join(f"{one:g}" for one in each.normal)
        share = f"{100.0 * each.count / each.of:.1f} %, expected {100.0 * each.expected:.1f} %"
        yield f"{each.kind}: {each.count} of {each.of} lie with ({down}) down: {share}"
    yield from (f"note: {note}" for note in outcome.notes)
    lost = [one.part for one in outcome.parts if one.state == "lost"]
    if lost:
        yield f"lost: {', '.join(lost)}"
    if run.fault:
        yield printable(f"{run.status}: {run.fault}")


def _line_of(event: Event, name: str) -> str:
    """An output or a message."""
    if event.kind == "output":
        value = event.data["value"]
        said = str(value).upper() if isinstance(value, bool) else value
        return printable(f"{event.t:9.3f} s  {name}{event.data['signal']} = {said}")
    if event.kind == "message" and event.data.get("type") != "clear":
        return printable(f"{event.t:9.3f} s  message {name}{event.data['text']}")
    return ""
