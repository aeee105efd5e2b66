"""Drives a whole backup through its branches: every program that people start, in the cells that an exploration finds.

Reports what was reached, the faults with the surroundings that lead to them, where tasks stood for good, and the waits
that nothing ends but what they wait for. Routines that are not there take no time and do nothing; they are named.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rpl import ir
from rpl.cell import Cell, RoutineMeaning
from rpl.errors import RplError
from rpl.ir.walk import bodies, walk
from rpl.passes.scope import ProgramScope, Scope
from rpl.proof.explore import Budget, explore
from rpl.proof.exploring import cell_told
from rpl.proof.reach import Reach, reach_of
from rpl.proof.record import Place, place_of
from rpl.proof.unreached import Key
from rpl.proof.watched import Seen, Side, named_inputs
from rpl.runtime.limits import Limits
from rpl.runtime.reached import Reached

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.linking.program import LinkedProgram
    from rpl.runtime.trace import RunResult

# Ends that say what is missing beside the programs, and nothing about them.
_MISSING = frozenset(("unknown-routine", "unknown-function", "unknown-data", "vendor", "opaque"))


@dataclass(frozen=True, slots=True)
class Start:
    """A program to begin with: its name, and the numbers of the routines that it can come to (in the program's
    order)."""

    name: str
    routines: frozenset[int]


@dataclass(frozen=True, slots=True)
class Ending:
    """How a run ended early. kind: fault, missing, waits. `cell`: the surroundings that lead there, in words."""

    kind: str
    code: str
    message: str
    place: Place
    cell: str

    def as_json(self) -> dict[str, object]:
        """A stable document: code, message, place, cell."""
        return {"code": self.code, "message": self.message, **self.place.as_json(), "cell": self.cell}


@dataclass(frozen=True, slots=True)
class OpenWait:
    """A wait for a condition without a time-out, and the signals that the condition looks at."""

    place: Place
    signals: tuple[str, ...]

    def as_json(self) -> dict[str, object]:
        """A stable document: place, signals."""
        return {**self.place.as_json(), "signals": list(self.signals)}


@dataclass(frozen=True, slots=True)
class Driven:
    """One program: what it reached of what it can come to, in how many cells, what `ended` the exploration early
    (see Exploration), and how its runs ended early. `refused`: why it cannot be run at all. `assumed`: data without a
    value that got one, with that value in words and the statement that read it first."""

    name: str
    reach: Reach
    cells: int = 0
    ended: str = ""
    endings: tuple[Ending, ...] = ()
    refused: str = ""
    assumed: tuple[tuple[str, str, Place], ...] = ()

    def of(self, kind: str) -> tuple[Ending, ...]:
        """The endings of a kind."""
        return tuple(one for one in self.endings if one.kind == kind)

    def as_json(self) -> dict[str, object]:
        """A stable document."""
        return {
            "entry": self.name,
            "refused": self.refused,
            "cells": self.cells,
            "ended": self.ended,
            **self.reach.as_json(),
            "faults": [one.as_json() for one in self.of("fault")],
            "missing": [one.as_json() for one in self.of("missing")],
            "stands": [one.as_json() for one in self.of("waits")],
            "assumed": [{"name": name, "value": value, **place.as_json()} for name, value, place in self.assumed],
        }


@dataclass(frozen=True, slots=True)
class Drive:
    """A whole backup: its programs, the reach of all of them together, waits without a time-out, and the routines that
    are not there."""

    programs: tuple[Driven, ...]
    reach: Reach
    waits: tuple[OpenWait, ...]
    stubs: tuple[str, ...]

    @property
    def has_faults(self) -> bool:
        """Did a run end in a fault of the programs themselves?"""
        return any(one.of("fault") for one in self.programs)

    @property
    def is_clean(self) -> bool:
        """Nothing to look at: all was reached, nothing is missing, and every wait ends."""
        ends = any(one.endings or one.refused or one.assumed for one in self.programs)
        return not (ends or self.reach.unreached or self.waits or self.stubs)

    def as_json(self) -> dict[str, object]:
        """A stable document: entries, reach, waits, stubs."""
        return {
            "entries": [one.as_json() for one in self.programs],
            "reach": self.reach.as_json(),
            "waits_without_time_out": [one.as_json() for one in self.waits],
            "stubs": list(self.stubs),
        }


def drive(
    linked: LinkedProgram,
    starts: Sequence[Start],
    stubs: Collection[str],
    cell: Cell,
    robot: RobotModel | None,
    limits: Limits,
    cells: int,
    tell: Callable[[int, str], None] = lambda number, name: None,
) -> Drive:
    """Explore each start for itself. stubs: names of routines that are not there; what the cell says of one stands.
    cells: how many cells are tried for each; the result does not hang on the machine. tell: is told of each program
    that is done."""
    program = linked.program
    unsaid = {name.lower(): RoutineMeaning() for name in stubs if name.lower() not in cell.routines}
    around = replace(cell, routines={**cell.routines, **unsaid})
    named, runs, programs = named_inputs(program), list[Reached](), list[Driven]()
    remarks: dict[Key, str] = {}
    for number, start in enumerate(starts, 1):
        side = _Noting(program, linked, robot, start.name, limits, kinds=named)
        done = _driven(side, start, around, cells, remarks)
        programs.append(done)
        runs += (result.reached for _, result in side.noted if result.reached is not None)
        tell(number, start.name)
    reach = reach_of(program, runs, None, remarks)
    return Drive(tuple(programs), reach, tuple(open_waits(program, linked)), tuple(sorted(unsaid)))


@dataclass(frozen=True, slots=True, eq=False)
class _Noting(Side):
    """A side that keeps what its runs showed."""

    noted: list[tuple[Cell, RunResult]] = field(default_factory=list)

    def run(self, cell: Cell, limits: Limits) -> Seen:
        seen = Side.run(self, cell, limits)
        self.noted.append((cell, replace(seen.result, trace=())))
        return seen


def _driven(side: _Noting, start: Start, cell: Cell, cells: int, remarks: dict[Key, str]) -> Driven:
    try:
        found = explore([side], cell, Budget(cells, math.inf))
    except RplError as error:
        return Driven(start.name, Reach(0, 0), refused=str(error))
    remarks.update(found.remarks[0])
    runs = [result.reached for _, result in side.noted]
    reach = reach_of(side.program, runs, start.name, found.remarks[0], found.one_way[0], start.routines)
    return Driven(
        start.name,
        reach,
        found.tried + 1,
        found.ended,
        tuple(_endings(side.noted, _MISSING if side.robot else _MISSING | {"motion"})),
        assumed=_assumed(result for _, result in side.noted),
    )


def _assumed(results: Iterable[RunResult]) -> tuple[tuple[str, str, Place], ...]:
    """What the runs assumed, each datum once."""
    found: dict[str, tuple[str, str, Place]] = {}
    for one in (one for result in results for one in result.assumed or ()):
        found.setdefault(one.name.lower(), (one.name, one.shown, place_of(one.origin)))
    return tuple(found.values())


def _endings(noted: Sequence[tuple[Cell, RunResult]], missing: Collection[str]) -> list[Ending]:
    """Each place where runs ended early, with the first cell that led there. missing: codes of faults that say what is
    not there (without an arm that is what asks for one)."""
    found: dict[tuple[str, str, Place], Ending] = {}
    for cell, result in noted:
        fault = result.fault
        if fault is None or result.status == "limit":
            continue
        kind = "waits" if result.status == "deadlock" else "missing" if fault.code in missing else "fault"
        place = place_of(fault.origin)
        key = (kind, fault.code, place)
        if key not in found:
            found[key] = Ending(kind, fault.code, fault.message, place, cell_told(cell))
    return list(found.values())


def open_waits(program: ir.Program, linked: LinkedProgram) -> list[OpenWait]:
    """Every wait for a condition that has no time-out."""
    scopes = ProgramScope(program)
    found = []
    for module, routine in scopes.routines():
        scope = scopes.routine(module, routine)
        for node in walk(*bodies(routine)):
            if isinstance(node, ir.WaitUntil) and node.timeout is None and node.origin.source is not None:
                found.append(OpenWait(place_of(node.origin), tuple(_signals(node.condition, scope, linked))))
    return found


def _signals(condition: ir.Expression, scope: Scope, linked: LinkedProgram) -> Mapping[str, None]:
    """Signals of a condition, as the program spells them."""
    found: dict[str, None] = {}
    for node in walk(condition):
        if isinstance(node, ir.Signal):
            found[_spelled(node, scope.module.dialect, linked)] = None
        elif isinstance(node, ir.Name):
            symbol = scope.value(node.id)
            if symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration):
                found[node.id] = None
    return found


def _spelled(signal: ir.Signal, language: str, linked: LinkedProgram) -> str:
    """As the language calls it; one whose number is worked out by its kind."""
    if signal.name is not None:
        return signal.name
    if isinstance(signal.index, ir.IntLiteral):
        return linked.signal_name(language, signal.kind, signal.index.value)
    return f"a {signal.kind.replace('_', ' ')}"


__all__ = ["Drive", "Driven", "Ending", "OpenWait", "Start", "drive", "open_waits"]
