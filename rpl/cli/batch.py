"""`rpl batch`: every project of a plant's archive is checked, run or translated, over several processes or machines."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import click

from rpl import registry
from rpl.cli.files import force_option, refuse_others, write_files
from rpl.cli.limits import limit_options, limits_of
from rpl.cli.output import (
    counting,
    dialect_exists,
    from_option,
    json_option,
    json_text,
    robot_option,
    robots_exist,
    say,
    waiting,
)
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.batch.asked import Asked
    from rpl.batch.finding import Project
    from rpl.batch.journal import Done
    from rpl.batch.rows import Row
    from rpl.batch.work import Answer

    Answers = Generator[tuple[Project, Answer], None, None]

INTERRUPTED = 130
_LIMIT_S = 300.0
_MOST_TOLD = 20


@click.command("batch")
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--check", "checking", is_flag=True, help="Read every project, as `rpl check` does.")
@click.option("--run", "running", is_flag=True, help="Run every project, as `rpl run` does.")
@click.option("--to", "target", metavar="D", help="Write every project in that language, as `rpl translate` does.")
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="OUT",
    help="Folder to write, with --to.",
)
@click.option("--prove", "proving", is_flag=True, help="With --to: run both programs and compare what they do.")
@click.option(
    "--results",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.csv|F.parquet",
    help="Write the table of results.",
)
@click.option("--timings", is_flag=True, help="A column more: the seconds that each project took here.")
@click.option("--together", is_flag=True, help="Take the program files of one folder for one project.")
@click.option("--resume/--fresh", "resuming", default=True, help="Go on where a batch ended (usual), or begin anew.")
@click.option("--jobs", type=int, metavar="N", help="Processes at the same time; usually as many as there are cores.")
@click.option(
    "--limit", "limit_s", type=float, default=_LIMIT_S, help=f"Seconds that a project or a run may take ({_LIMIT_S:g})."
)
@click.option("--dask", "address", metavar="ADDRESS", help="Spread over the machines of this scheduler of dask.")
@from_option
@robot_option
@click.option("--to-robot", metavar="R2", help="Arm that will run the results; else the same.")
@limit_options
@force_option
@json_option
def command(
    folder: Path,
    checking: bool,
    running: bool,
    target: str | None,
    output: Path | None,
    proving: bool,
    results: Path | None,
    timings: bool,
    together: bool,
    resuming: bool,
    jobs: int | None,
    limit_s: float,
    address: str | None,
    dialect: str | None,
    robot: str | None,
    to_robot: str | None,
    max_time: float | None,
    max_steps: int | None,
    max_events: int | None,
    as_json: bool,
) -> int:
    """Check, run or translate every project of an archive: each backup in it, and each program with its files.

    No project ends the others. Exit status 0 when all are good, 3 when something is to be looked at (guarded stops),
    1 when some have errors. --json gives one line for each row of the table.
    """
    from rpl.batch.finding import projects
    from rpl.batch.rows import columns, status
    from rpl.batch.tables import table

    limits = limits_of(max_time, max_steps, max_events)
    asked = _asked(checking, running, target, proving)
    asked = replace(asked, dialect=dialect_exists(dialect), robot=robot, to_robot=to_robot, limits=limits)
    _can_be_done(folder, asked, output, results, jobs, limit_s)
    with waiting("looking for projects"):
        found = projects(folder, together)
    if not found:
        raise UsageError(f"no program and no backup is in {folder}")
    journal = _journal(output, results)
    answers = _answers(address, jobs or os.cpu_count() or 1, limit_s)
    rows = _work(found, asked, journal, resuming, answers, output, timings, as_json)
    shown = columns(asked, timings)
    if not as_json:
        _show(rows, len(found))
    if results is not None:
        write_files({results: table(results, rows, shown)})
        say(f"rpl: wrote {results}", err=True)
    return status(rows)


def _asked(checking: bool, running: bool, target: str | None, proving: bool) -> Asked:
    """Raises UsageError where not exactly one thing is asked for."""
    from rpl.batch.asked import CHECK, RUN, TRANSLATE, Asked

    if checking + running + (target is not None) != 1:
        raise UsageError("say what to do with every project: --check, --run or --to D")
    if target is None:
        if proving:
            raise UsageError("--prove compares with what is written: ask for that with --to")
        return Asked(RUN if running else CHECK)
    return Asked(TRANSLATE, registry.target_called(target).name, prove=proving)


def _can_be_done(
    folder: Path, asked: Asked, output: Path | None, results: Path | None, jobs: int | None, limit_s: float
) -> None:
    """Raises UsageError for what would fail at the end of long work."""
    from rpl.batch.tables import can_be_made

    robots_exist(asked.robot, asked.to_robot)
    if (output is not None) != bool(asked.target):
        raise UsageError("-o OUT is the folder that --to D writes: give both or none")
    if output is not None and output.resolve().is_relative_to(folder.resolve()):
        raise UsageError(f"{output} is in {folder}: what is written there would be one of the projects")
    if jobs is not None and jobs < 1:
        raise UsageError(f"--jobs: {jobs} is not a number above 0")
    if not limit_s > 0.0:
        raise UsageError(f"--limit: {limit_s:g} is not a time above 0 s")
    if results is not None:
        can_be_made(results)
        refuse_others([results])


def _journal(output: Path | None, results: Path | None) -> Path | None:
    """Where it is kept what is done: in the folder that is written, or beside the results."""
    from rpl.batch.journal import NAME

    if output is not None:
        return output / NAME
    return results.with_name(f".{results.name}{NAME}") if results is not None else None


def _answers(address: str | None, jobs: int, limit_s: float) -> Callable[[Sequence[Project], Asked], Answers]:
    """Who does the work."""
    from rpl.batch import cluster, processes

    if address is not None:
        cluster.needs_dask()
        return lambda projects, asked: cluster.answers(projects, asked, address, limit_s)
    return lambda projects, asked: processes.answers(projects, asked, jobs, limit_s)


def _work(
    found: Sequence[Project],
    asked: Asked,
    place: Path | None,
    resuming: bool,
    answers: Callable[[Sequence[Project], Asked], Answers],
    output: Path | None,
    timings: bool,
    as_json: bool,
) -> list[Row]:
    """The rows of all projects, in order; what is done already is not done again."""
    from rpl.batch.journal import Done, Journal
    from rpl.batch.rows import columns

    key = asked.key()
    with waiting("looking at what is done"):
        kept = _kept(found, key, place, output) if resuming and place is not None else {}
    if kept:
        say(f"rpl: {len(kept)} of {len(found)} projects are done already (--fresh begins anew)", err=True)
    homes = _homes(found)
    done, shown = dict(kept), columns(asked, timings)
    order = _InOrder([one.name for one in found], shown if as_json else ())
    order.tell(done)
    with Journal(place, kept) as journal, counting(asked.kind, len(found)) as tell:
        tell(len(done), "")
        ahead = answers([one for one in found if one.name not in kept], asked)
        try:
            for project, answer in ahead:
                rows, written = _written(answer, output, homes[project.name])
                rows = tuple(replace(row, seconds=round(answer.seconds, 3)) for row in rows)
                made = Done(project.name, key, answer.digest, answer.seconds, written, rows)
                journal.add(made)
                done[project.name] = made
                tell(len(done), project.name)
                order.tell(done)
        except KeyboardInterrupt as stopped:
            more = "; the same command goes on from there" if place is not None else ""
            stopped.add_note(f"with {len(done)} of {len(found)} projects done{more}")
            raise
        finally:
            ahead.close()
    return [row for one in found for row in done[one.name].rows]


def _kept(found: Sequence[Project], key: str, place: Path, output: Path | None) -> dict[str, Done]:
    """What of a journal still counts."""
    from rpl.batch.journal import read_journal

    before = read_journal(place)
    kept = {}
    for project in found:
        done = before.get(project.name)
        if done is None or done.asked != key or not done.is_lasting or done.digest != project.digest():
            continue
        if output is None or all((output / name).is_file() for name in done.written):
            kept[project.name] = done
    return kept


def _homes(found: Sequence[Project]) -> dict[str, str]:
    """The folder that each project is written to: its path without the ending, or with it where two would meet."""
    short = {one.name: _without_ending(one) for one in found}
    often = Counter(name.lower() for name in short.values())
    return {name: home if often[home.lower()] == 1 else name for name, home in short.items()}


def _without_ending(project: Project) -> str:
    name = PurePosixPath(project.name)
    return project.name if Path(project.paths[0]).is_dir() else name.with_suffix("").as_posix()


def _written(answer: Answer, output: Path | None, home: str) -> tuple[tuple[Row, ...], tuple[str, ...]]:
    """The rows, and the files that were written; a folder that takes them not is the trouble of its project alone."""
    from rpl.batch.rows import NOT_WRITTEN

    if output is None or not answer.files:
        return answer.rows, ()
    names = [PurePosixPath(home) / name for name, _ in answer.files]
    try:
        if any(".." in name.parts or name.is_absolute() for name in names):
            raise UsageError("a name leads out of the output folder")
        write_files({output / name: data for name, (_, data) in zip(names, answer.files, strict=True)})
    except UsageError as error:
        return tuple(replace(row, outcome=NOT_WRITTEN, reason=str(error), written=0) for row in answer.rows), ()
    return answer.rows, tuple(name.as_posix() for name in names)


class _InOrder:
    """Lines of JSON in the order of the projects, each as soon as all before it are known."""

    def __init__(self, names: Sequence[str], columns: Sequence[str]) -> None:
        self.ahead = iter(names if columns else ())
        self.columns = columns
        self.next = next(self.ahead, None)

    def tell(self, done: dict[str, Done]) -> None:
        while self.next is not None and self.next in done:
            for row in done[self.next].rows:
                click.echo(json_text(row.cells(self.columns)))
            self.next = next(self.ahead, None)


def _show(rows: Iterable[Row], projects: int) -> None:
    """For people: what is not as asked, and how much there is of each."""
    from rpl.batch.rows import GOOD

    rows = list(rows)
    others = [row for row in rows if row.outcome != GOOD]
    for row in others[:_MOST_TOLD]:
        entry = f" ({row.entry})" if row.entry else ""
        say(f"{row.project}{entry}: {row.outcome}{f', {row.reason}' if row.reason else ''}")
    if len(others) > _MOST_TOLD:
        say(f"and {len(others) - _MOST_TOLD} more")
    counts = Counter(row.outcome for row in rows)
    said = ", ".join(
        f"{count} {outcome}" for outcome, count in sorted(counts.items(), key=lambda one: (-one[1], one[0]))
    )
    more = f" in {len(rows)} runs" if len(rows) != projects else ""
    say(f"{projects} projects{more}: {said}")
