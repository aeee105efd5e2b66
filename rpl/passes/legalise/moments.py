"""What stood in front of a pass while stretches stand for the moves of runs: from there it can be done again with all
moves, or with a few more of them, when a pass looks inside of a stretch.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import Protocol

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.columns import LooksInsideError, Stretch
from rpl.passes.expanded import expanded
from rpl.passes.stretches import parted, settled


class Known(Protocol):
    """What is asked of a context besides what passes add to it (rpl.passes.legalise.context.Context is one)."""

    diagnostics: Diagnostics
    stretches: tuple[Stretch, ...]
    before: int


# What passes add to their context.
_FOUND = (
    "taken",
    "stretches",
    "register_names",
    "register_types",
    "signal_groups",
    "signal_names",
    "unreached",
    "flanges",
)


@dataclass(frozen=True, slots=True)
class Moment:
    """In front of pass `at`: the program, how many reports there were, and what the context knew."""

    at: int
    program: ir.Program
    reports: int
    found: dict[str, object]

    def restore(self, context: Known) -> None:
        del context.diagnostics.items[self.reports :]
        for name, value in self.found.items():
            setattr(context, name, copy(value))


def note(moments: list[Moment], at: int, program: ir.Program, context: Known) -> None:
    """Add this moment; of those with the same program the last one is kept."""
    if moments and moments[-1].program is program:
        moments.pop()
    found = {name: copy(getattr(context, name)) for name in _FOUND}
    moments.append(Moment(at, program, len(context.diagnostics), found))


def moved_back(moments: list[Moment], context: Known, asked: LooksInsideError, part: bool) -> tuple[int, ir.Program]:
    """The last moment in which each stretch is what it has to be: its pass, and its program. There the moves that
    answer otherwise than most are ordinary ones, or all where they are many, or `part` is not said. The first moment is
    one, as no pass has run."""
    while True:
        moment = moments.pop()
        moment.restore(context)
        try:
            whole = settled(moment.program, context.stretches, context.diagnostics.items[context.before :])
        except LooksInsideError:
            if not moments:
                raise
            continue
        found = parted(moment.program, whole, context.stretches, asked) if part else None
        program, context.stretches = found or (expanded(whole), ())
        return moment.at, program
