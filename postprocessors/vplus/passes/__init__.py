"""What only V+ needs of a program, each pass with its place among those of the core, and right in front of the
writer."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .brakedmoves import braked_moves
from .broughtvalues import brought_values
from .lateroutputs import later_outputs
from .onenamespace import one_namespace
from .pathsteps import path_steps
from .reactionsearches import reaction_searches

PASSES: tuple[Placed, ...] = (
    Placed(reaction_searches, "searches", before="search_parts"),
    Placed(braked_moves, "interrupts", behind="interrupts"),
    Placed(brought_values, "control", behind="functions_to_procedures"),
)
LAST = (one_namespace, path_steps, later_outputs)
