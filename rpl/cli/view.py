"""`rpl view`: see a run of a cell, in a browser, as a page that plays from disk, or as a picture."""

from __future__ import annotations

import sys
import webbrowser
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.cells import BodiesAsked, CellAsked, loaded_robots
from rpl.cli.files import force_option, refuse_others, write_files
from rpl.cli.limits import limit_options, limits_of
from rpl.cli.output import (
    arm_of,
    collector,
    from_option,
    json_option,
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
from rpl.diagnostics import Severity
from rpl.errors import UsageError
from rpl.showing import counted
from rpl.view.camera import VIEWS

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.project import ReadProgram
    from rpl.view.scene import Scene
    from rpl.workcell.collisions import Collision
    from rpl.workcell.record import CellRun


@click.command("view")
@click.argument("paths", nargs=-1, metavar="[PATH...]")
@from_option
@click.option("--robot", metavar="R", help="Arm: a name or a .toml file.")
@click.option("--cell", metavar="F.toml", help="Surroundings: inputs over time, answers of the operator, bodies.")
@click.option("--entry", metavar="NAME", help="Routine to start with; else main, or the only one nobody calls.")
@click.option(
    "--save",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.html",
    help="Write a page that plays the run and opens from disk.",
)
@click.option(
    "--picture",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.png",
    help="Write a picture of the cell at a time.",
)
@click.option("--at", "at_s", type=float, metavar="S", help="The time of the picture; else the end of the run.")
@click.option(
    "--side", type=click.Choice(tuple(VIEWS)), default="isometric", help="Where the picture is taken from (isometric)."
)
@click.option("--port", type=click.IntRange(0, 65535), default=8087, metavar="P", help="Port of the live view (8087).")
@click.option(
    "--host", default="127.0.0.1", metavar="ADDRESS", help="Where the live view listens (127.0.0.1: this machine only)."
)
@click.option("--no-browser", is_flag=True, help="Do not open a browser; say the address only.")
@limit_options
@force_option
@verbose_option
@json_option
def command(
    paths: Sequence[str],
    dialect: str | None,
    robot: str | None,
    cell: str | None,
    entry: str | None,
    save: Path | None,
    picture: Path | None,
    at_s: float | None,
    side: str,
    port: int,
    host: str,
    no_browser: bool,
    max_time: float | None,
    max_steps: int | None,
    max_events: int | None,
    as_json: bool,
) -> int:
    """See a program run in its cell: arms, tools, parts, path, signals and lines over time.

    In a browser, where the arm can be taken by the hand and points can be taught, until Ctrl-C; with --save or
    --picture as a file. Exit status 0 when the file is written, whatever the run came to; 1 for a program with errors.
    """
    if at_s is not None and picture is None:
        raise UsageError("--at is the time of --picture F.png")
    robots_exist(robot)
    refuse_others([path for path in (save, picture) if path is not None])
    limits = limits_of(max_time, max_steps, max_events)
    robots = (robot,) if robot is not None else ()
    asked = CellAsked(paths, dialect, robots, entry, limits, None, False, BodiesAsked(), as_json)
    if save is None and picture is None:
        return _live(asked, cell, host, port, not no_browser)
    found = _run(asked, cell)
    if found is None:
        return 1
    run = found.run
    with waiting("drawing"):
        files = _drawn(found, save, picture, run.time_s if at_s is None else at_s, side)
    for path, data in files.items():
        write_file(path, data)
    if as_json:
        print_json(
            {"status": run.status, "time_s": round(run.time_s, 6), "files": [{"path": str(path)} for path in files]}
        )
    else:
        wrote = ", ".join(f"{path} ({len(data) / 1e6:.1f} MB)" for path, data in files.items())
        touched = f", {counted(len(found.collisions), 'collision')}" if found.collisions else ""
        say(f"{run.status} after {run.time_s:.3f} s{touched}; wrote {wrote}")
    return 0


def _drawn(found: _Found, save: Path | None, picture: Path | None, at_s: float, side: str) -> dict[Path, bytes]:
    """The files that are asked for."""
    scene, files = found.scene(), {}
    if save is not None:
        from rpl.view.document import view_document
        from rpl.view.page import view_page

        files[save] = view_page(view_document(scene, _title(found.run))).encode("utf-8")
    if picture is not None:
        from rpl.view.picture import picture as taken

        files[picture] = taken(scene, at_s, side)
    return files


@dataclass(frozen=True, slots=True)
class _Found:
    """A run, and what was read for each of its robots."""

    run: CellRun
    reads: tuple[ReadProgram, ...]
    collisions: tuple[Collision, ...] = ()

    def scene(self) -> Scene:
        from rpl.view.scene import scene_of

        return scene_of(self.run, self.collisions)


def _live(asked: CellAsked, cell: str | None, host: str, port: int, browser: bool) -> int:
    """Show it in a browser until Ctrl-C."""
    from importlib.util import find_spec

    from rpl.view.live import MISSING, Live
    from rpl.view.screen import Loaded, Screen

    if find_spec("viser") is None:
        raise UsageError(MISSING)

    def again() -> Loaded:
        found = _run(asked, cell)
        if found is None:
            raise UsageError("the program has errors now, and is shown as it was")
        return Loaded(found.scene(), found.reads)

    found = _run(asked, cell)
    if found is None:
        return 1
    screen = Screen(Loaded(found.scene(), found.reads), again, _overwrite)
    live = Live(screen, host, port, _title(found.run))
    if asked.as_json:
        print_json({"status": found.run.status, "time_s": round(found.run.time_s, 6), "address": live.address})
    else:
        say(f"{live.address} shows it; Ctrl-C ends")
    sys.stdout.flush()
    if browser:
        webbrowser.open(live.address)
    try:
        live.serve()
    except KeyboardInterrupt:
        say()
    finally:
        live.stop()
    return 0


def _overwrite(path: Path, data: bytes) -> None:
    """A program in which a point was taught: who presses the button means it."""
    write_files({path: data}, [path])


def _run(asked: CellAsked, cell: str | None) -> _Found | None:
    """The run; None for a program with errors, which are said."""
    from rpl.proof.prove import load_cell

    surroundings = load_cell(cell)
    if surroundings is None or not surroundings.layout:
        if not asked.paths:
            raise UsageError("no program: name its PATH, or a cell file whose robots have programs with --cell")
        return _alone(asked, surroundings)
    from rpl.workcell.knocks import run_and_look
    from rpl.workcell.running import run_cell

    loaded = loaded_robots(surroundings, asked)
    if loaded is None:
        return None
    driven, reads = [one.driven for one in loaded], tuple(one.read for one in loaded)
    if surroundings.layout.lost_beyond_mm is not None:
        with waiting("running"):
            run, found, _ = run_and_look(surroundings, driven, asked.limits)
        return _Found(run, reads, found.collisions)
    with waiting("running"):
        run = run_cell(surroundings, driven, asked.limits)
    return _Found(run, reads, _collisions(run))


def _collisions(run: CellRun) -> tuple[Collision, ...]:
    """What touches; where the packages for that are missing, this is said and nothing is marked."""
    from rpl.workcell.collisions import find_collisions

    try:
        with waiting("looking for collisions"):
            return find_collisions(run).collisions
    except UsageError as error:
        say(f"rpl: collisions are not marked: {error}", err=True)
        return ()


def _alone(asked: CellAsked, surroundings: Cell | None) -> _Found | None:
    """A run of one robot without bodies around it."""
    from rpl.cell.layout import Layout, RobotPlace
    from rpl.simulation import run_program
    from rpl.workcell.record import CellRun, RobotRun

    diagnostics = collector()
    read = read_paths(asked.paths, asked.dialect, diagnostics)
    print_diagnostics(diagnostics, Severity.WARNING)
    if diagnostics.has_errors:
        say("not started: errors in the program", err=True)
        return None
    model = robot_named(asked.robots[0] if asked.robots else arm_of(read))
    if model is not None and surroundings is not None:
        model = model.among(surroundings.mechanisms, surroundings.path)
    with waiting("running"):
        result = run_program(read.program, model, surroundings, asked.entry, limits=asked.limits)
    place = RobotPlace(arm=model.name if model is not None else "", programs=tuple(asked.paths))
    fault = f"{result.fault.origin.place}{result.fault.message}" if result.fault is not None else ""
    robots = (RobotRun(place, model, read.program, result),)
    run = CellRun(Layout(robots=(place,)), robots, status=result.status, time_s=result.time_s, fault=fault)
    return _Found(run, (read,))


def _title(run: CellRun) -> str:
    """The cell's name, else that of the program."""
    if run.layout.path:
        path = Path(run.layout.path)
        return path.stem if path.stem != "cell" else path.absolute().parent.name
    names = [Path(path).stem for one in run.robots for path in one.place.programs]
    return ", ".join(dict.fromkeys(names)) or "run"
