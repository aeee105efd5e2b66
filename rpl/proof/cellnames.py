"""Signals that a cell file names and that the program cannot mean: a typing error there would only show as a wait that
never ends. A signal is known by its declaration, by a spelling with a number, or because the program uses the name.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from rpl import ir
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.errors import RplError
from rpl.ir.walk import walk
from rpl.linking import link
from rpl.runtime.signals import keys_named, usual_key
from rpl.source import NOWHERE, Origin, Source, read_source

UNKNOWN_SIGNAL = code(
    "cell-unknown-signal",
    Severity.WARNING,
    "the cell file names the signal {name}, which the program does not have{nearest}",
    "write the name as the program or its language does",
)
_NEAR = 0.5  # how much of a name has to agree to be offered


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
        near = get_close_matches(name.lower(), [one.lower() for one in names], 3, _NEAR)
        found = [next(one for one in names if one.lower() == lower) for lower in near]
        nearest = f"; the nearest are {', '.join(found)}" if found else ""
        diagnostics.report(UNKNOWN_SIGNAL, _place(name, source), name=name, nearest=nearest)


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


__all__ = ["report_unknown_signals"]
