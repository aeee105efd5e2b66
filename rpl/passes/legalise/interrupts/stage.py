"""Conditions that break into a program, in the one form that the target has; then what has no form is refused."""

from __future__ import annotations

from rpl.passes.legalise.interrupts.brakedmoves import braked_moves
from rpl.passes.legalise.interrupts.heldmotion import held_motion
from rpl.passes.legalise.interrupts.interrupts import interrupts
from rpl.passes.legalise.interrupts.onceonly import rearmed_reactions
from rpl.passes.legalise.interrupts.reactions import reactions
from rpl.passes.legalise.interrupts.resumes import resumes
from rpl.passes.legalise.interrupts.storedpaths import stored_paths
from rpl.passes.legalise.io.resetclocks import stopped_resets
from rpl.passes.legalise.io.routineclocks import clocks_of_routines
from rpl.passes.legalise.refusals import refuse
from rpl.passes.legalise.settings.keptsettings import kept_settings
from rpl.passes.legalise.settings.overrides import full_override
from rpl.passes.legalise.settings.readoverrides import read_overrides
from rpl.passes.legalise.settings.speedshares import speed_shares
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.storage.statics import static_variables
from rpl.passes.legalise.tasks.background import background_tasks
from rpl.passes.legalise.tasks.criticals import without_criticals
from rpl.passes.legalise.tasks.joins import joins
from rpl.passes.legalise.tasks.locks import critical_flags
from rpl.passes.legalise.tasks.stoppedtasks import stopped_tasks
from rpl.passes.legalise.tasks.taskarguments import task_arguments
from rpl.passes.legalise.tasks.taskreferences import task_references

STAGE = Stage(
    "interrupts",
    (
        stored_paths,
        held_motion,
        reactions,
        resumes,
        interrupts,
        rearmed_reactions,
        braked_moves,
        clocks_of_routines,
        stopped_resets,
        static_variables,
        task_references,
        without_criticals,
        critical_flags,
        background_tasks,
        stopped_tasks,
        joins,
        task_arguments,
        speed_shares,
        full_override,
        read_overrides,
        kept_settings,
        refuse,
    ),
)
