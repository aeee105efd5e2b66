"""Conditions that break into a program, in the one form that the target has, with the clocks that they may stop; then
tasks again, because an interrupt may have become one.
"""

from __future__ import annotations

from rpl.passes.legalise.interrupts.clocks.heldtimers import held_timers
from rpl.passes.legalise.interrupts.clocks.programtimes import program_times
from rpl.passes.legalise.interrupts.clocks.routineclocks import clocks_of_routines
from rpl.passes.legalise.interrupts.interrupts import interrupts
from rpl.passes.legalise.interrupts.nestedinterrupts import nested_interrupts
from rpl.passes.legalise.interrupts.onceonly import reactions_once, rearmed_reactions
from rpl.passes.legalise.interrupts.reactions import reactions
from rpl.passes.legalise.interrupts.resumes import resumes
from rpl.passes.legalise.interrupts.statics import static_variables
from rpl.passes.legalise.interrupts.storedpaths import stored_paths
from rpl.passes.legalise.interrupts.tasks.background import background_tasks
from rpl.passes.legalise.interrupts.tasks.criticals import without_criticals
from rpl.passes.legalise.interrupts.tasks.joins import joins
from rpl.passes.legalise.interrupts.tasks.stoppedtasks import stopped_tasks
from rpl.passes.legalise.interrupts.tasks.taskarguments import task_arguments
from rpl.passes.legalise.interrupts.tasks.taskreferences import task_references
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "interrupts",
    (
        program_times,
        held_timers,
        clocks_of_routines,
        reactions_once,
        nested_interrupts,
        stored_paths,
        reactions,
        resumes,
        interrupts,
        rearmed_reactions,
        static_variables,
        task_references,
        without_criticals,
        background_tasks,
        stopped_tasks,
        joins,
        task_arguments,
    ),
    Clause(
        statements="StoreMotion TaskControl",
        further=frozenset(("operation join of a task", "operation stop of a task")),
    ),
)
