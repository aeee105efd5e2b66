"""`rpl run --explore`: a whole backup is driven through its branches, and what that shows is reported."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import wraps
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, cast

import click

from rpl.cli.output import Decorated, counting, print_json, say
from rpl.errors import UsageError
from rpl.showing import counted

if TYPE_CHECKING:
    from rpl import ir
    from rpl.cell import Cell
    from rpl.diagnostics import Diagnostics
    from rpl.emulator.model import RobotModel
    from rpl.inventory.contents import Contents
    from rpl.project import ReadProgram
    from rpl.proof.driving import Drive, Driven, Ending, Start
    from rpl.proof.record import Place
    from rpl.runtime.limits import Limits

_CELLS = 60  # tried for each program, unless --max-cells says otherwise
_TIME_S = 600.0  # of one run, unless --max-time says otherwise
_STATEMENTS = 50_000  # of one run
_NOTHING, _FAULTS, _LOOK = 0, 1, 3


def exploring_options(command: Decorated) -> Decorated:
    """The options of exploring; the command gets `explore`, how many cells are tried for each program, or None."""

    @wraps(command)
    def with_cells(exploring: bool, max_cells: int | None, **values: Any) -> Any:
        if max_cells is not None and not exploring:
            raise UsageError("--max-cells says how far --explore goes: ask for it with --explore")
        return command(explore=(_CELLS if max_cells is None else max_cells) if exploring else None, **values)

    options = (
        click.option(
            "--explore", "exploring", is_flag=True, help="Drive every program through its branches, and report."
        ),
        click.option(
            "--max-cells",
            type=click.IntRange(0),
            metavar="N",
            help=f"How many cells --explore tries for each program ({_CELLS}).",
        ),
    )
    decorated: Any = with_cells
    for option in reversed(options):
        decorated = option(decorated)
    return cast(Decorated, decorated)


def explore_backup(
    read: ReadProgram,
    program: ir.Program,
    diagnostics: Diagnostics,
    model: RobotModel | None,
    cell: Cell | None,
    entry: str | None,
    limits: Limits,
    cells: int,
    as_json: bool,
) -> int:
    """Drive every program that people start, or the named one. program: what of the project is run. Exit status 0 when
    nothing is to be looked at, 1 for a fault of the programs, 3 for statements that were not reached, waits without a
    time-out and what is missing."""
    from rpl.cell import Cell as NoCell
    from rpl.depth import at_any_depth
    from rpl.inventory.contents import contents
    from rpl.linking import link
    from rpl.proof.driving import drive

    found = contents(read, diagnostics)
    starts = _starts(read, found, entry)
    stubs = [one.name for one in found.missing if one.kind == "routine"]
    tight = replace(limits, statements=_STATEMENTS)
    around = cell if cell is not None else NoCell()
    with counting("exploring", len(starts)) as tell:
        linked = at_any_depth(lambda: link(program, around.assume_data, around.variables))
        result = at_any_depth(lambda: drive(linked, starts, stubs, around, model, tight, cells, tell))
    if as_json:
        print_json(result.as_json())
    else:
        for line in _lines(result):
            say(line)
    return _FAULTS if result.has_faults else _NOTHING if result.is_clean else _LOOK


def limit_of_a_run(max_time: float | None) -> float:
    """Simulated seconds of one run."""
    return _TIME_S if max_time is None else max_time


def _starts(read: ReadProgram, found: Contents, entry: str | None) -> list[Start]:
    """The programs to begin with, each with what it can come to."""
    from rpl.proof.driving import Start

    number = {one.name: at for at, one in enumerate(found.programs)}
    if entry is None:
        names = [one.name for one in found.entries]
    else:
        names = [one.name for one in found.programs if one.name.lower() == entry.lower()]
    if not names:
        missing = f"there is no routine {entry}" if entry is not None else "nothing here can be started"
        raise UsageError(f"{missing} (rpl project shows what is there)")
    tasks = [one.entry for one in read.program.tasks]
    starts = []
    for name in names:
        known: set[str] = set()
        ahead = [name, *(one.name for one in found.programs if one.name in tasks and one.name not in names)]
        while ahead:
            now = ahead.pop()
            if now not in known:
                known.add(now)
                ahead += found.programs[number[now]].calls
        starts.append(Start(name, frozenset(number[one] for one in known)))
    return starts


def _lines(result: Drive) -> Iterator[str]:
    assumed = sum(len(one.assumed) for one in result.programs)
    if assumed:
        yield f"rests on {counted(assumed, 'assumed value')} of data to which nothing in the project gives one"
    for one in result.programs:
        yield from _program(one)
    yield f"all programs: {result.reach.as_text()}"
    if result.stubs:
        yield f"not there, taken as doing nothing: {', '.join(result.stubs)}"
    if result.waits:
        yield "waits without a time-out:"
        yield from (f"  {_at(one.place)}: {', '.join(one.signals) or one.place.text}" for one in result.waits)


def _program(one: Driven) -> Iterator[str]:
    if one.refused:
        yield f"{one.name}: cannot be run: {one.refused}"
        return
    reached = f"{one.reach.reached} of {counted(one.reach.statements, 'statement')}"
    ended = "; more cells might show more (--max-cells)" if one.ended else ""
    yield f"{one.name}: reached {reached} in {counted(one.cells, 'run')}{ended}"
    yield from (f"  assumed: {_at(place)}: {name} = {value}" for name, value, place in one.assumed)
    for kind, word in (("fault", "fault"), ("missing", "missing"), ("waits", "stands for good")):
        yield from (f"  {word}: {_ending(each)}" for each in one.of(kind))


def _ending(one: Ending) -> str:
    return f"{_at(one.place)}: {one.message} ({one.cell})"


def _at(place: Place) -> str:
    return f"{PurePath(place.file).name}:{place.line}"


__all__ = ["explore_backup", "exploring_options", "limit_of_a_run"]
