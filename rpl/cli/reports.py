"""Reports that `rpl run` makes beside its result: a page to look at, and the layers of torques and following errors."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, TypeVar

import click

from rpl.cli.output import collector, numbers, print_diagnostics, robot_named, say, write_file
from rpl.controllerfiles import controller_named
from rpl.diagnostics import Code, Diagnostic, Severity
from rpl.errors import UsageError
from rpl.showing import counted

if TYPE_CHECKING:
    from rpl import ir
    from rpl.cell import Cell
    from rpl.emulator.inertias import Body
    from rpl.emulator.mechanismfile import Mechanism
    from rpl.emulator.model import RobotModel
    from rpl.motionmodel import MotionModel
    from rpl.project import ReadProgram
    from rpl.report.dynamics import Moment, RunDynamics
    from rpl.report.times import RunTimes
    from rpl.runtime.assumed import Assumed
    from rpl.simulation import RunResult

Decorated = TypeVar("Decorated", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Reports:
    """What is asked for. `library`: the script that the page needs; `load` stands in place of the program's loads;
    `controller` drives the robot in place of each language's own."""

    plot: Path | None
    dynamics: bool
    library: str
    load: Body | None
    timed: bool = False
    controller: MotionModel | None = None

    def times(self, result: RunResult, model: RobotModel | None) -> RunTimes | None:
        """Where the time of the run goes."""
        if not self.timed or model is None:
            return None
        from rpl.report.times import run_times

        return run_times(result, model)

    def layers(self, result: RunResult, model: RobotModel | None) -> RunDynamics | None:
        """Torques and following errors; warnings go to stderr."""
        if not self.dynamics or model is None:
            return None
        from rpl.report.dynamics import run_dynamics

        found = run_dynamics(result, model, self.load)
        for warning in found.warnings:
            say(f"warning: {warning}", err=True)
        return found

    def write(
        self,
        result: RunResult,
        read: ReadProgram,
        model: RobotModel | None,
        dynamics: RunDynamics | None = None,
        mechanisms: Sequence[Mechanism] = (),
    ) -> None:
        """Write the page, if one is asked for. `mechanisms`: those of the cell; the robot's own are known."""
        if self.plot is None:
            return
        from rpl import registry
        from rpl.report.document import Heading, run_document
        from rpl.report.page import page

        drivers = [self.controller] if self.controller else [controller_named(name) for name in read.dialects]
        fault = result.fault
        place = f"{fault.origin.file}:{fault.origin.line}: " if fault is not None and fault.origin.source else ""
        heading = Heading(
            files=tuple(source.path for source in read.sources),
            language=", ".join(registry.dialect(name).title for name in read.dialects),
            robot=" ".join(word for word in (model.maker, model.title) if word) if model is not None else "",
            controller=", ".join(dict.fromkeys(driver.title for driver in drivers)) if model is not None else "",
            moves=result.moves,
            fault=f"{place}{fault.code}: {fault.message}" if fault is not None else "",
        )
        layers = dynamics.layers() if dynamics is not None else ()
        known = (*(model.mechanisms if model is not None else ()), *mechanisms)
        external = {axis.number: axis for mechanism in known for axis in mechanism.axes}
        document = run_document(result, model, heading, layers=layers, external=external)
        write_file(self.plot, page(document, self.library).encode("utf-8"))


def report_options(command: Decorated) -> Decorated:
    """The options of a command that can make these reports; `reports_of` takes their values."""
    options = (
        click.option(
            "--plot",
            type=click.Path(dir_okay=False, path_type=Path),
            metavar="F.html",
            help="Write a page about the run that opens without a network: path, joints, signals, margins, moves.",
        ),
        click.option(
            "--times", "timed", is_flag=True, help="Time of each move, where the time goes, and how sure that is."
        ),
        click.option(
            "--controller",
            metavar="NAME|F.toml",
            help="Who moves the robot: a language's controller, plain, or a file; else each language's own.",
        ),
        click.option(
            "--dynamics", is_flag=True, help="Joint torques, speeds and following errors, each with its line."
        ),
        click.option(
            "--payload", metavar="KG[,X,Y,Z]", help="Load at the flange for the whole run: mass, centre in mm."
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command


def reports_of(
    plot: Path | None, dynamics: bool, payload: str | None, robot: str | None, timed: bool, controller: str | None
) -> Reports:
    """Checked before the run: what is wrong or missing is said at once, not after an hour."""
    library = ""
    if payload is not None and not dynamics:
        raise UsageError("--payload is a load for --dynamics; ask for both")
    if dynamics and robot is None:
        raise UsageError("--dynamics needs an arm: name one with --robot")
    if dynamics:
        _torques_can_be_had(robot)
    if timed and robot is None:
        raise UsageError("--times needs an arm: name one with --robot")
    chosen = controller_named(controller) if controller is not None else None
    if plot is not None:
        from rpl.report.page import drawing_library

        library = drawing_library()
    return Reports(plot, dynamics, library, None if payload is None else _load(payload), timed, chosen)


def _torques_can_be_had(robot: str | None) -> None:
    """Torques of an arm with masses need a package of the extra. Raises UsageError when it is not installed."""
    from importlib.util import find_spec

    model = robot_named(robot)
    if model is not None and model.inertias is not None and find_spec("pinocchio") is None:
        raise UsageError("--dynamics needs the package pinocchio: pip install 'robot-rpl[kinematics]'")


def _load(text: str) -> Body:
    """A point mass; its inertias are those about its own centre, so none."""
    import numpy as np

    from rpl.emulator.inertias import Body

    given = numbers(text, "--payload")
    if len(given) not in (1, 4) or given[0] < 0.0:
        raise UsageError(f"--payload: {text!r} is not a mass in kg, or mass,x,y,z with the centre in mm")
    return Body(given[0], np.array(given[1:] or [0.0, 0.0, 0.0]), np.zeros((3, 3)))


def show_reports(layers: RunDynamics | None, times: RunTimes | None) -> None:
    """What was asked for, for people."""
    if times is not None:
        show_times(times)
    if layers is not None:
        show_dynamics(layers)


def show_dynamics(found: RunDynamics) -> None:
    """The layers for people: a line for each joint, then the tool."""
    if found.joints:
        say(f"{'joint':<6}{'torque':>13}{'of limit':>10}{'rms':>9}{'speed':>15}{'of limit':>10}  where")
    for joint in found.joints:
        share = "" if joint.share is None else f"{100.0 * joint.share:.0f} %"
        rate = "deg/s" if joint.unit == "N m" else "mm/s"
        speed = f"{joint.speed.value:.1f} {rate}"
        of_speed = f"{100.0 * abs(joint.speed.value) / joint.speed_limit:.0f} %"
        torque = f"{joint.torque.value:.1f} {joint.unit}"
        where = f"{_where(joint.torque)}; speed {_where(joint.speed)}"
        say(f"{joint.name:<6}{torque:>13}{share:>10}{joint.rms:>9.1f}{speed:>15}{of_speed:>10}  {where}")
    following = found.following
    model = " (a model: the robot file has no time constants)" if following.assumed else ""
    lags = sorted({f"{1000.0 * lag:g}" for lag in following.lag_s}, key=float)
    say(f"tool at most {following.behind.value:.3f} mm behind its command, {_where(following.behind)}")
    say(f"tool at most {following.off.value:.3f} mm off its path, {_where(following.off)}")
    say(f"with joints that follow by {', '.join(lags)} ms{model}; load {found.payload_kg:g} kg at most")


def show_times(found: RunTimes) -> None:
    """The times for people: a line for each move, then the sums."""
    if found.moves:
        say(f"{'start':>9}{'seconds':>9}{'between':>17}{'corner':>8}  move")
    for move in found.moves:
        place = f"{PurePath(move.origin.file).name}:{move.origin.line}"
        between = f"{move.low_s:.3f}..{move.high_s:.3f}"
        corner = f"{move.blended_s:.3f}" if move.blended_s > 0.0 else ""
        say(f"{move.start_s:9.3f}{move.seconds:9.3f}{between:>17}{corner:>8}  {move.kind} {place}")
    for name, seconds in (
        ("moving", found.moving_s),
        ("in corners", found.blending_s),
        ("waiting for a time", found.timed_s),
        ("waiting for signals", found.signal_s),
        ("standing", found.standing_s),
    ):
        share = 100.0 * seconds / found.total_s if found.total_s > 0.0 else 0.0
        say(f"{seconds:9.3f} s {share:5.1f} %  {name}")
    by = f" ({found.controller})" if found.controller else ""
    say(f"{found.total_s:9.3f} s in all, between {found.low_s:.3f} and {found.high_s:.3f} s{by}")
    for name, early, late in found.effects:
        say(f"          {name}: -{early:.3f} +{late:.3f} s")


def _where(moment: Moment) -> str:
    origin = moment.origin
    place = f"{PurePath(origin.file).name}:{origin.line}" if origin.source is not None else "at rest"
    return f"{place} at {moment.time_s:.3f} s"


def warnings_of(result: RunResult) -> Iterator[Diagnostic]:
    """What the controller would have logged on the way, each with its place."""
    for event in result.trace:
        if event.kind == "warning":
            kind = Code(str(event.data["code"]), Severity.WARNING, "{text}")
            said = ("text", f"{event.data['text']} (task {event.task})")
            yield Diagnostic(kind, event.origin, (said,), Severity.WARNING)


def assumptions(assumed: Sequence[Assumed]) -> Iterator[str]:
    """What a result rests on, before the result itself."""
    from rpl.inventory.contents import place_of

    if assumed:
        yield f"rests on {counted(len(assumed), 'assumed value')} of data to which nothing in the project gives one:"
        yield from (f"  {place_of(one.origin)}: {one.name} = {one.shown}" for one in assumed)


def say_what_is_assumed(program: ir.Program, model: RobotModel | None, surroundings: Cell | None) -> None:
    """What a run takes for granted about its program, and names of the cell file that it does not have."""
    from rpl.passes.given import with_given
    from rpl.passes.kept import report_taken_as_zero
    from rpl.passes.legalise.facts.motion.pulsecounts import report_assumed, report_stations
    from rpl.proof.cellnames import report_unknown_names

    found = collector()
    if model is not None:
        report_assumed(program, model, found)
        report_stations(program, model, found)
    report_unknown_names([program], surroundings, found)
    report_taken_as_zero(with_given(program, surroundings.variables if surroundings is not None else {}), found)
    print_diagnostics(found, Severity.WARNING)


def say_remarks(result: RunResult, model: RobotModel | None) -> None:
    """What a run has taken for granted on its way."""
    if model is not None:
        from rpl.runtime.remarks import report_remarks

        found = collector()
        report_remarks(result, model.mechanisms, found)
        print_diagnostics(found, Severity.WARNING)
