"""Moves that a condition ends, as the target ends them. They stand before errors: handlers read what a search found."""

from __future__ import annotations

from rpl.passes.legalise.advance.atrest import at_rest
from rpl.passes.legalise.advance.latedelays import without_late_delays
from rpl.passes.legalise.interrupts.reactionsearches import reaction_searches
from rpl.passes.legalise.interrupts.searches import searches
from rpl.passes.legalise.interrupts.searchparts import search_parts
from rpl.passes.legalise.stages import Stage

STAGE = Stage(
    "searches",
    (
        searches,
        reaction_searches,
        search_parts,
        at_rest,
        without_late_delays,
    ),
)
