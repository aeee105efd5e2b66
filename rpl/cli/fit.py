"""`rpl fit`: a controller's motion parameters from a recorded log."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.files import force_option, refuse_others
from rpl.cli.kinematics import required_robot
from rpl.cli.output import (
    collector,
    from_option,
    json_option,
    print_diagnostics,
    print_json,
    print_text,
    read_paths,
    robot_named,
    say,
    verbose_option,
    waiting,
    write_file,
)
from rpl.diagnostics import Severity
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.fitting.adjust import Drive, Fitted
    from rpl.motionmodel import MotionModel
    from rpl.project import ReadProgram


@click.command("fit")
@click.argument("log", metavar="LOG.csv")
@click.argument("paths", nargs=-1, metavar="[PROGRAM...]")
@from_option
@required_robot
@click.option(
    "--controller", metavar="NAME|F.toml", help="Where to begin; else the controller of the program's language."
)
@click.option("--parameter", "names", multiple=True, metavar="NAME", help="Adjust this one only; may be repeated.")
@click.option("--cell", metavar="F.toml", help="Surroundings of the program, as for run.")
@click.option("--entry", metavar="NAME", help="Routine to start with, as for run.")
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False, path_type=Path), metavar="F.toml", help="Write it there."
)
@force_option
@verbose_option
@json_option
def command(
    log: str,
    paths: Sequence[str],
    dialect: str | None,
    robot: str,
    controller: str | None,
    names: tuple[str, ...],
    cell: str | None,
    entry: str | None,
    output: Path | None,
    as_json: bool,
) -> int:
    """Adjust the motion parameters of a controller to a recorded log.

    LOG.csv has a header and a line per moment: time (s) and j1..jn (pendant units) or x, y, z (mm, the tool in the
    robot's base frame). With the PROGRAM that was run it is driven with ever better parameters; without it the straight
    moves of the log tell ramps, accelerations and smoothing. The result is a controller file for --controller of run.
    """
    from rpl.controllerfiles import as_toml, controller_named
    from rpl.fitting.adjust import fit_alone, fit_with_program
    from rpl.fitting.log import read_log
    from rpl.fitting.parameters import chosen, prepared
    from rpl.motionmodel import on_robot

    refuse_others([output] if output is not None else [])
    model = robot_named(robot)
    assert model is not None  # the option is required
    recorded = read_log(log, model.axes)
    read = _read(paths, dialect) if paths else None
    name = controller or (read.dialects[0] if read is not None and read.dialects else model.motion_of or "plain")
    base = controller_named(name)
    base = on_robot(base, model.motion) if model.motion_of == base.name else base
    parameters = chosen(prepared(base, model), names)
    with waiting("fitting"):
        if read is None:
            fitted = fit_alone(recorded, model, base, parameters)
        else:
            fitted = fit_with_program(recorded, model, base, parameters, _drive(read, model, cell, entry))
    text = as_toml(fitted.controller)
    if output is not None:
        write_file(output, text.encode("utf-8"))
    if as_json:
        print_json(_document(fitted, text))
    else:
        _show(fitted, text if output is None else "")
    return 0


def _read(paths: Sequence[str], dialect: str | None) -> ReadProgram:
    diagnostics = collector()
    read = read_paths(paths, dialect, diagnostics)
    print_diagnostics(diagnostics, Severity.WARNING)
    if diagnostics.has_errors:
        raise UsageError("the program has errors: it is not driven")
    return read


def _drive(read: ReadProgram, model: RobotModel, cell: str | None, entry: str | None) -> Drive:
    from rpl.proof.prove import load_cell
    from rpl.simulation import RunResult, run_program

    def drive(controller: MotionModel) -> RunResult:
        result = run_program(read.program, model, load_cell(cell), entry, controller=controller)
        if result.fault is not None:
            raise UsageError(f"the program stops with the fault {result.fault.code}: {result.fault.message}")
        return result

    return drive


def _document(fitted: Fitted, text: str) -> dict[str, object]:
    return {
        "controller": text,
        "parameters": [
            {
                "name": one.name,
                "value": one.value,
                "before": one.before,
                "deviation": one.deviation if math.isfinite(one.deviation) else None,
                "determined": one.determined,
            }
            for one in fitted.parameters
        ],
        "remaining": {"rms": fitted.rms, "max": fitted.largest, "unit": fitted.unit, "moments": fitted.moments},
        "moves": [
            {"start_s": move.start_s, "measured_s": move.measured_s, "emulated_s": move.emulated_s}
            for move in fitted.moves
        ],
    }


def _show(fitted: Fitted, text: str) -> None:
    for one in fitted.parameters:
        known = f"± {one.deviation:.2g}" if math.isfinite(one.deviation) else "kept"
        say(f"{one.name:28} {one.before:10.5g} -> {one.value:10.5g} {known:12} {one.determined} determined")
    errors = [1000.0 * (move.emulated_s - move.measured_s) for move in fitted.moves]
    worst = max(errors, key=abs)
    say(f"remaining: rms {fitted.rms:.4g} {fitted.unit}, max {fitted.largest:.4g} {fitted.unit}")
    say(f"motions: {len(errors)}, the time of one is off by {worst:+.1f} ms at most")
    if text:
        say("")
        print_text(text)
