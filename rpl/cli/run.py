"""`rpl run`: a program on an emulated robot."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.cells import BodiesAsked, CellAsked, bodies_options, first_arm, run_among_bodies
from rpl.cli.exploring import explore_backup, exploring_options, limit_of_a_run
from rpl.cli.files import force_option, refuse_others, write_files
from rpl.cli.limits import limit_options, limits_of
from rpl.cli.output import (
    arm_of,
    collector,
    from_option,
    json_option,
    plain,
    print_diagnostics,
    print_json,
    read_paths,
    robot_named,
    robots_exist,
    say,
    verbose_option,
    waiting,
    write_file,
)
from rpl.cli.reports import (
    Reports,
    assumptions,
    report_options,
    reports_of,
    say_remarks,
    say_what_is_assumed,
    show_reports,
    warnings_of,
)
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import UsageError
from rpl.runtime.trace import RunInterrupted
from rpl.showing import printable

INTERRUPTED = 130

if TYPE_CHECKING:
    from rpl import ir
    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.project import ReadProgram
    from rpl.report.dynamics import RunDynamics
    from rpl.report.times import RunTimes
    from rpl.simulation import RunResult
    from rpl.workcell.loading import Loaded
    from rpl.workcell.record import CellRun


@click.command("run")
@click.argument("paths", nargs=-1, metavar="PATH...")
@from_option
@click.option(
    "--robot", "robots", multiple=True, metavar="R", help="Arm: a name or a .toml file; again for a second motion task."
)
@click.option("--cell", metavar="F.toml", help="Surroundings: inputs over time, answers of the operator, parts.")
@click.option(
    "--init-cell",
    "new_cell",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.toml",
    help="Write a cell file to be edited, with what the programs ask of the world, and do not run.",
)
@click.option(
    "--assume-data", is_flag=True, help="Go on where data of the controller has no value: assume one, and report each."
)
@click.option("--entry", metavar="NAME", help="Routine to start with; else main, or the only one nobody calls.")
@exploring_options
@bodies_options
@click.option("--trace", type=click.Path(dir_okay=False, path_type=Path), metavar="F.jsonl", help="Write every event.")
@report_options
@click.option("--despite-errors", is_flag=True, help="Run what was read in spite of errors in it.")
@limit_options
@force_option
@verbose_option
@json_option
def command(
    paths: Sequence[str],
    dialect: str | None,
    robots: Sequence[str],
    cell: str | None,
    new_cell: Path | None,
    assume_data: bool,
    entry: str | None,
    explore: int | None,
    bodies: BodiesAsked,
    trace: Path | None,
    plot: Path | None,
    timed: bool,
    controller: str | None,
    dynamics: bool,
    payload: str | None,
    despite_errors: bool,
    max_time: float | None,
    max_steps: int | None,
    max_events: int | None,
    as_json: bool,
) -> int:
    """Run a program on an emulated robot, in simulated time.

    Exit status 0 when the program came to its end or its own stop, 1 for a fault, a deadlock or a limit. A program
    with errors is not started. With --explore 1 for a fault, and 3 for what was not reached, waits without a time-out
    and what is missing.
    """
    from rpl.proof.prove import load_cell
    from rpl.simulation import run_program

    robots_exist(*robots)
    robot, further = robots[0] if robots else None, robots[1:]
    _can_be_written(trace, plot)
    limits = limits_of(max_time if explore is None else limit_of_a_run(max_time), max_steps, max_events)
    surroundings, diagnostics = _assuming(load_cell(cell), assume_data), collector()
    reports = reports_of(plot, dynamics, payload, robot or first_arm(surroundings), timed, controller)
    if surroundings is not None and surroundings.layout and explore is None and new_cell is None:
        asked = CellAsked(paths, dialect, robots, entry, limits, reports, despite_errors, bodies, as_json)
        return _among_bodies(surroundings, asked, trace, reports)
    _about_one_robot(paths, bodies)
    read = read_paths(paths, dialect, diagnostics)
    print_diagnostics(diagnostics, Severity.WARNING)
    if new_cell is not None:
        return _init_cell(new_cell, read, diagnostics)
    if diagnostics.has_errors and not despite_errors:
        return _not_started(diagnostics, as_json)
    model = _robot_in(robot or arm_of(read), surroundings, read.program)
    program, driver = _settled(read, surroundings), reports.controller
    if explore is not None:
        return explore_backup(read, program, diagnostics, model, surroundings, entry, limits, explore, as_json)
    try:
        with waiting("running"):
            result = run_program(program, model, surroundings, entry, None, None, None, limits, driver, further)
    except RunInterrupted as stopped:
        return _interrupted(stopped, trace)
    return _ended(result, read, model, surroundings, reports, trace, as_json)


def _ended(
    result: RunResult,
    read: ReadProgram,
    model: RobotModel | None,
    surroundings: Cell | None,
    reports: Reports,
    trace: Path | None,
    as_json: bool,
) -> int:
    """Say and write what a run has shown; the exit status."""
    say_remarks(result, model)
    layers, times = reports.layers(result, model), reports.times(result, model)
    _told(result, layers, times, _outside(result, read), as_json)
    # Last, so that a file that cannot be written does not cost the result.
    write_trace(trace, result)
    beside = surroundings.mechanisms if surroundings is not None and model is None else ()  # the model has them
    reports.write(result, read, model, layers, beside)
    return 0 if result.status in ("finished", "stopped") else 1


def _among_bodies(cell: Cell, asked: CellAsked, trace: Path | None, reports: Reports) -> int:
    """A run in a cell with bodies. Raises UsageError for reports about one run, of many."""
    about_one = (trace is not None, reports.plot is not None, reports.timed, reports.dynamics)
    if asked.bodies.repeat > 1 and any(about_one):
        raise UsageError("--trace, --plot, --times and --dynamics are about one run: leave out --repeat")
    try:
        return run_among_bodies(cell, asked, lambda run, loaded: _written(run, loaded, trace, reports))
    except RunInterrupted as stopped:
        return _interrupted(stopped, trace)


def _about_one_robot(paths: Sequence[str], bodies: BodiesAsked) -> None:
    """Raises UsageError for what only a cell with bodies can do."""
    if option := bodies.needs_bodies():
        raise UsageError(f"{option} is about bodies, and there are none: name a cell file that has some with --cell")
    if not paths:
        raise UsageError("no program: name its PATH")


def _written(run: CellRun, loaded: Sequence[Loaded], trace: Path | None, reports: Reports) -> None:
    """The files about a run among bodies: every event of each robot, and the page of a robot that is alone."""
    if trace is not None:
        several = len(run.robots) > 1
        named = [(one.place.name, event) for one in run.robots for event in one.result.trace]
        rows = [event.as_json() | ({"robot": name} if several else {}) for name, event in named]
        rows.sort(key=lambda row: row["t"])
        lines = [json.dumps(plain(row), ensure_ascii=False) for row in rows]
        write_file(trace, "".join(line + "\n" for line in lines).encode("utf-8"))
    if reports.plot is not None:
        reports.write(run.robots[0].result, loaded[0].read, run.robots[0].model)


def _outside(result: RunResult, read: ReadProgram) -> tuple[str, ...]:
    """What a run that stands for good waits for and nothing in the project changes."""
    from rpl.depth import at_any_depth
    from rpl.inventory.outside import from_outside

    return at_any_depth(lambda: from_outside(result, read.program))


def _told(
    result: RunResult, layers: RunDynamics | None, times: RunTimes | None, outside: tuple[str, ...], as_json: bool
) -> None:
    """The run and its reports, for machines or for people."""
    if as_json:
        more = {"dynamics": layers, "times": times}
        named = {"from_outside": list(outside)} if outside else {}
        print_json(result.as_json() | named | {name: made.as_json() for name, made in more.items() if made is not None})
    else:
        show(result)
        if outside:
            say(printable(f"nothing in the project changes {', '.join(outside)}: that comes from outside"), err=True)
        show_reports(layers, times)


def _can_be_written(trace: Path | None, plot: Path | None) -> None:
    """Raises UsageError for files that would be refused at the end of a long run."""
    if trace is not None and plot is not None and trace.resolve() == plot.resolve():
        raise UsageError(f"--trace and --plot both name {trace}: give each a file")
    refuse_others([path for path in (trace, plot) if path is not None])


def _assuming(cell: Cell | None, asked: bool) -> Cell | None:
    """The surroundings, in which data without a value gets one if that is asked for here or in the cell file."""
    from rpl.cell import Cell as NoCell

    if not asked:
        return cell
    return replace(cell if cell is not None else NoCell(), assume_data=True)


def _init_cell(path: Path, read: ReadProgram, diagnostics: Diagnostics) -> int:
    """Write a cell file for the project; one that is there stays, unless --force says otherwise."""
    from rpl.inventory.contents import contents
    from rpl.inventory.newcell import new_cell

    write_files({path: new_cell(read, contents(read, diagnostics)).encode("utf-8")})
    say(f"wrote {path}")
    return 0


def _robot_in(robot: str | None, surroundings: Cell | None, program: ir.Program) -> RobotModel | None:
    """The arm with the mechanisms around it; what the run takes for granted about the program is said."""
    model = robot_named(robot)
    if model is not None and surroundings is not None:
        model = model.among(surroundings.mechanisms, surroundings.path)
    say_what_is_assumed(program, model, surroundings)
    return model


def _settled(read: ReadProgram, surroundings: Cell | None) -> ir.Program:
    """The program to run: without settings that it takes from what only the controller knows, each of which is said."""
    from rpl.cell import Cell as NoCell
    from rpl.workcell.loading import settled

    left = collector()
    program = settled(read, surroundings if surroundings is not None else NoCell(), left)
    print_diagnostics(left, Severity.WARNING)
    return program


def _interrupted(stopped: RunInterrupted, trace: Path | None) -> int:
    """Says where the run was, and keeps its events."""
    say(f"rpl: interrupted after {stopped.result.time_s:.3f} s of simulated time", err=True)
    for task, origin in stopped.places:
        say(f"{origin.place}task {task} was here", err=True)
    write_trace(trace, stopped.result)
    if trace is not None:
        say(f"rpl: {trace} has the {len(stopped.result.trace)} events until then", err=True)
    return INTERRUPTED


def write_trace(trace: Path | None, result: RunResult) -> None:
    """Every event as a line of JSON, if asked for."""
    if trace is not None:
        lines = [json.dumps(plain(event), ensure_ascii=False) for event in result.trace_lines()]
        write_file(trace, "".join(line + "\n" for line in lines).encode("utf-8"))


def _not_started(diagnostics: Diagnostics, as_json: bool) -> int:
    """What a controller does with such a program: nothing."""
    from rpl.runtime.trace import Fault, RunResult

    errors = diagnostics.of(Severity.ERROR)
    count = f"{len(errors)} error{'s' * (len(errors) != 1)}"
    if as_json:
        fault = Fault("program-errors", f"not started: {count}; {errors[0].message}", origin=errors[0].origin)
        print_json(RunResult("fault", 0.0, 0, 0, (), (), fault, ()).as_json())
    else:
        say(f"not started: {count} in the program (--despite-errors runs what was read)", err=True)
    return 1


def show(result: RunResult) -> None:
    """The run for people."""
    document = result.as_json()
    messages, outputs, fault = document["messages"], document["outputs"], document["fault"]
    assert isinstance(messages, list) and isinstance(outputs, list)
    for said in assumptions(result.assumed or ()):
        say(printable(said))
    for t, name, value in outputs:
        said = str(value).upper() if isinstance(value, bool) else value
        say(printable(f"{t:9.3f} s  {name} = {said}"))
    for message in messages:
        say(f"message    {printable(str(message))}")
    print_diagnostics(warnings_of(result))
    say(f"{result.status} after {result.time_s:.3f} s, {result.moves} moves, {result.statements} statements")
    if isinstance(fault, dict):
        place = f"{fault['file']}:{fault['line']}: " if fault["file"] else ""
        say(printable(f"{place}fault {fault['code']} {fault['message']} (task {fault['task']})"), err=True)
