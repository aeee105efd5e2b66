"""The verdict of a proof that explores: the user's cell, then every found cell, and the worst of what they show."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from rpl.cell import Cell
from rpl.proof.deviations import Deviation
from rpl.proof.difference import Difference
from rpl.proof.verdict import DIFFERENT, UNDECIDED, ProofResult

# Two runs that wait for good: one is told at once, the other goes on beside a task that never ends.
_WAITING = frozenset(("deadlock", "limit"))
_MOST_TOLD = 6


def worst_of(
    base: ProofResult, cells: Sequence[tuple[Cell, Cell]], prove: Callable[[Cell, Cell], ProofResult]
) -> ProofResult:
    """The result in the user's cell joined with those in the found cells, each as A and as B has it.

    A difference anywhere is a difference. In a found cell both programs may end in the same fault or wait for good:
    that is an end like any other, and no reason to doubt. The user's own cell decides nothing only as long as no found
    cell does.
    """
    deviations = list(base.deviations)
    reason, tried = base.reason, 0
    notes = dict.fromkeys(base.notes)
    most = [base.max_path_mm, base.max_joint_deg, base.max_time_s]
    for tried, (cell, other) in enumerate(cells, 1):
        if base.verdict == DIFFERENT:
            break
        found = prove(cell, other)
        difference = found.difference
        if difference is not None and not _both_wait(difference):
            told = replace(difference, explanation=f"{difference.explanation} ({cell_told(cell)})")
            return replace(
                found, difference=told, notes=(*base.notes, f"found by exploring, in cell {tried} of {len(cells)}")
            )
        if found.verdict != UNDECIDED and difference is None:
            reason = ""
        notes |= dict.fromkeys(found.notes)
        deviations += found.deviations
        most = [max(pair) for pair in zip(most, _maxima(found), strict=True)]
    return replace(
        base,
        deviations=_each_once(deviations),
        reason=reason,
        notes=tuple(notes),
        max_path_mm=most[0],
        max_joint_deg=most[1],
        max_time_s=most[2],
    )


def _maxima(result: ProofResult) -> tuple[float, float, float]:
    return (result.max_path_mm, result.max_joint_deg, result.max_time_s)


def _both_wait(difference: Difference) -> bool:
    return {str(difference.a.value), str(difference.b.value)} == _WAITING


def _each_once(deviations: Iterable[Deviation]) -> tuple[Deviation, ...]:
    """Of deviations of one kind at one place the greatest, in the order of their first."""
    greatest: dict[object, Deviation] = {}
    for one in deviations:
        key = (one.kind, one.task, one.a.place, one.b.place)
        known = greatest.get(key)
        if known is None or one.amount > known.amount:
            greatest[key] = one
    return tuple(greatest.values())


def cell_told(cell: Cell) -> str:
    """What a cell gives, in a few words (`with di1 = True from 2 s`)."""
    said = [f"{one.signal} = {one.value} from {one.time_s:g} s" for one in cell.inputs]
    said += [f"{name} = {value}" for name, value in cell.variables.items()]
    said += [f"answer {one.answer}" for one in cell.answers]
    more = f" and {len(said) - _MOST_TOLD} more" if len(said) > _MOST_TOLD else ""
    return f"with {', '.join(said[:_MOST_TOLD])}{more}" if said else "without inputs"


__all__ = ["cell_told", "worst_of"]
