"""Signals and variables that a cell file names and that no program has: a typing error there would only show as a wait
that never ends, or as a value that is never used. A signal is known by its declaration, by a spelling with a number, or
because the program uses the name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from difflib import get_close_matches

from rpl import ir
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.errors import RplError
from rpl.ir.walk import walk
from rpl.linking import link
from rpl.runtime.signals import keys_named, usual_key
from rpl.source import NOWHERE, Origin, Source, read_source
from rpl.tomlfile import key_lines, line_of

UNKNOWN_SIGNAL = code(
    "cell-unknown-signal",
    Severity.WARNING,
    "the cell file names the signal {name}, which the program does not have{nearest}",
    "write the name as the program or its language does",
)
UNKNOWN_VARIABLE = code(
    "cell-unknown-variable",
    Severity.WARNING,
    "the cell file gives a value to {name}, which the program does not have{nearest}: the value is not used",
    "write the name as the program or its language does",
)
UNUSED_ROUTINE = code(
    "cell-routine-not-used",
    Severity.WARNING,
    "the cell file says what {name} stands for, and {why}: it is not used",
    "take it out, or write the name as the program calls it",
)
_WORD = re.compile(r"[\w$]+")
_NEAR = 0.5  # how much of a name has to agree to be offered


def report_unknown_names(programs: Sequence[ir.Program], cell: Cell | None, diagnostics: Diagnostics) -> None:
    """A warning at each signal of the cell file that the first program does not have, at each variable that none has,
    and at each routine that is there or that none calls."""
    report_unknown_signals(programs[0], cell, diagnostics)
    report_unknown_variables(programs, cell, diagnostics)
    report_unused_routines(programs, cell, diagnostics)


def report_unused_routines(programs: Sequence[ir.Program], cell: Cell | None, diagnostics: Diagnostics) -> None:
    """A warning at each routine of the cell file whose call it never stands for."""
    if cell is None or not cell.routines:
        return
    there = {routine.name.lower() for program in programs for module in program.modules for routine in module.routines}
    nodes = (node for program in programs for node in walk(program))
    called = {node.name.lower() for node in nodes if isinstance(node, ir.CallRoutine | ir.Call)}
    for name in cell.routines:
        if name in there or name not in called:
            why = "the program has that routine" if name in there else "nothing calls it"
            diagnostics.report(UNUSED_ROUTINE, NOWHERE, name=name, why=why)


def report_unknown_signals(program: ir.Program, cell: Cell | None, diagnostics: Diagnostics) -> None:
    """A warning at each name of the cell file that stands for no signal of the program."""
    if cell is None:
        return
    linked, used = link(program), _used(program)
    source, names = _source(cell), sorted(used.values())
    for name in dict.fromkeys(_named(cell)):
        alias = linked.alias(name)
        if alias is not None or usual_key(name) is not None or keys_named(name, alias) & used.keys():
            continue
        diagnostics.report(UNKNOWN_SIGNAL, _place(name, source), name=name, nearest=_nearest(name, names))


def report_unknown_variables(programs: Sequence[ir.Program], cell: Cell | None, diagnostics: Diagnostics) -> None:
    """A warning at each variable of the cell file that none of the programs has."""
    if cell is None or not cell.variables:
        return
    names = {name.lower(): name for program in programs for name in _variables(program)}
    modules = {module.name.lower() for program in programs for module in program.modules}
    source = _source(cell)
    lines = key_lines(source.text) if source is not None else {}
    for path in cell.variables:
        words = _WORD.findall(path.lower())
        if words and (words[0] in names or (words[0] in modules and words[1:2] and words[1] in names)):
            continue
        line = line_of(lines, f"variables.{path}")
        place = Origin(source, source.line_starts()[line - 1]) if source is not None and line else NOWHERE
        nearest = _nearest(path, names.values())
        diagnostics.report(UNKNOWN_VARIABLE, place, name=path, nearest=nearest)


def _variables(program: ir.Program) -> Iterator[str]:
    """Every name that the program declares for data or uses as one."""
    for node in walk(program):
        if isinstance(node, ir.Variable):
            yield node.name
        elif isinstance(node, ir.Name):
            yield node.id


def _nearest(name: str, names: Iterable[str]) -> str:
    """The end of a complaint about an unknown name: those that are most like it."""
    known = {one.lower(): one for one in sorted(names)}
    near = get_close_matches(name.lower(), list(known), 3, _NEAR)
    return f"; the nearest are {', '.join(known[one] for one in near)}" if near else ""


def _used(program: ir.Program) -> dict[str, str]:
    """Signals that are declared, or used by name: folded -> as written."""
    signals = (node for node in walk(program) if isinstance(node, ir.Signal | ir.SignalDeclaration))
    return {one.name.lower(): one.name for one in signals if one.name is not None}


def _named(cell: Cell) -> Iterator[str]:
    """Every signal that the cell file names, in its order."""
    yield from (one.signal for one in cell.inputs)
    for reaction in cell.reactions:
        yield reaction.when
        yield reaction.signal
    for meaning in cell.vendor:
        yield from (name for name, _ in meaning.set)
    if len(cell.layout.robots) < 2:
        yield from cell.layout.signals()


def _source(cell: Cell) -> Source | None:
    try:
        return read_source(cell.path) if cell.path else None
    except (OSError, RplError):
        return None  # the cell was made from a text


def _place(name: str, source: Source | None) -> Origin:
    """Where the name stands first in the file."""
    for quoted in (f'"{name}"', f"'{name}'"):
        at = source.text.find(quoted) if source is not None else -1
        if at >= 0:
            return Origin(source, at, at + len(quoted))
    return NOWHERE


__all__ = ["report_unknown_names"]
