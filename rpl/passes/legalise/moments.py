"""What stood in front of a pass while stretches stand for the moves of runs: from there it can be done again with all
moves, when a pass looks inside of a stretch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.columns import LooksInsideError, Stretch
from rpl.passes.expanded import expanded
from rpl.passes.stretches import settled


class Known(Protocol):
    """What passes may change of their context (rpl.passes.legalise.context.Context is one)."""

    diagnostics: Diagnostics
    taken: set[str]
    register_names: dict[tuple[str, int], str]
    register_types: dict[tuple[str, int], str]
    signal_groups: dict[str, ir.Signal]
    stretches: tuple[Stretch, ...]
    before: int


@dataclass(frozen=True, slots=True)
class Moment:
    """In front of pass `at`: the program, how many reports there were, and what the context knew."""

    at: int
    program: ir.Program
    reports: int
    taken: frozenset[str]
    register_names: dict[tuple[str, int], str]
    register_types: dict[tuple[str, int], str]
    signal_groups: dict[str, ir.Signal]

    def restore(self, context: Known) -> None:
        del context.diagnostics.items[self.reports :]
        context.taken = set(self.taken)
        context.register_names, context.register_types = dict(self.register_names), dict(self.register_types)
        context.signal_groups = dict(self.signal_groups)


def note(moments: list[Moment], at: int, program: ir.Program, context: Known) -> None:
    """Add this moment; of those with the same program the last one is kept."""
    if moments and moments[-1].program is program:
        moments.pop()
    names, types, groups = context.register_names, context.register_types, context.signal_groups
    reports, taken = len(context.diagnostics), frozenset(context.taken)
    moments.append(Moment(at, program, reports, taken, dict(names), dict(types), dict(groups)))


def moved_back(moments: list[Moment], context: Known) -> tuple[int, ir.Program]:
    """The last moment in which each stretch is what it has to be: its pass, and its program with all moves. The first
    one is, as no pass has run."""
    while True:
        moment = moments.pop()
        moment.restore(context)
        try:
            whole = settled(moment.program, context.stretches, context.diagnostics.items[context.before :])
        except LooksInsideError:
            if not moments:
                raise
            continue
        context.stretches = ()
        return moment.at, expanded(whole)
