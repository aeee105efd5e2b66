"""Ways, and what happens on them while the program runs ahead. They stand before interrupts, because actions on a way
may become interrupts. Arguments by reference are looked at before routines of their own make the calls of actions, and
these are made before the actions get the target's form.
"""

from __future__ import annotations

from rpl.passes.legalise.paths.actionarguments import action_arguments
from rpl.passes.legalise.paths.atrest import at_rest
from rpl.passes.legalise.paths.begunmoves import begun_moves
from rpl.passes.legalise.paths.begunoutputs import begun_outputs
from rpl.passes.legalise.paths.idlewaits import idle_waits
from rpl.passes.legalise.paths.latedelays import without_late_delays
from rpl.passes.legalise.paths.lookahead import stop_blends
from rpl.passes.legalise.paths.targets import whole_targets
from rpl.passes.legalise.paths.triggers import triggers
from rpl.passes.legalise.paths.wristpaths import wrist_paths
from rpl.passes.legalise.routines.aliasing import without_shared_references
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "paths",
    (
        at_rest,
        idle_waits,
        without_late_delays,
        wrist_paths,
        without_shared_references,
        stop_blends,
        begun_moves,
        begun_outputs,
        action_arguments,
        triggers,
        whole_targets,
    ),
    Clause(
        statements="ClearMotion LookAhead",
        further=frozenset(("arc by its angle", "even turn of the wrist", "relative move")),
    ),
)
