"""Ways and what happens on them. They stand before interrupts: actions on a way may become interrupts."""

from __future__ import annotations

from rpl.passes.legalise.advance.begunmoves import begun_moves
from rpl.passes.legalise.advance.begunoutputs import begun_outputs
from rpl.passes.legalise.advance.lookahead import stop_blends
from rpl.passes.legalise.advance.triggers import triggers
from rpl.passes.legalise.interrupts.nestedinterrupts import nested_interrupts
from rpl.passes.legalise.interrupts.onceonly import reactions_once
from rpl.passes.legalise.interrupts.singledisables import single_disables
from rpl.passes.legalise.io.heldtimers import held_timers
from rpl.passes.legalise.io.programtimes import program_times
from rpl.passes.legalise.routines.actionarguments import action_arguments
from rpl.passes.legalise.stages import Stage

STAGE = Stage(
    "paths",
    (
        stop_blends,
        begun_moves,
        begun_outputs,
        program_times,
        held_timers,
        reactions_once,
        nested_interrupts,
        single_disables,
        action_arguments,
        triggers,
    ),
)
