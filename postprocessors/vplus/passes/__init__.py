"""What only V+ needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .reactionsearches import reaction_searches
from .writeonly import kept_outputs

PASSES: tuple[Placed, ...] = (
    Placed(reaction_searches, "searches", behind="searches"),
    Placed(kept_outputs, "io", behind="groups_to_bits"),
)
