"""What only V+ needs of a program, each pass with its place among those of the core, and right in front of the
writer."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .onenamespace import one_namespace
from .reactionsearches import reaction_searches
from .writeonly import kept_outputs

PASSES: tuple[Placed, ...] = (
    Placed(reaction_searches, "searches", behind="searches"),
    Placed(kept_outputs, "io", behind="groups_to_bits"),
)
LAST = (one_namespace,)
