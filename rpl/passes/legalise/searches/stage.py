"""Moves that a condition ends, as the target ends them. They stand before errors, because what a search found is read
by handlers and it may raise errors of the source; and before places, because what it found is a place.
"""

from __future__ import annotations

from rpl.passes.legalise.searches.searchparts import search_parts
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "searches",
    (search_parts,),
    Clause(further=frozenset(("result of a search",))),
)
