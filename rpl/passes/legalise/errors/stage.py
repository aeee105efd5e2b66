"""Handlers, raised errors and their numbers, as the target catches and tells them."""

from __future__ import annotations

from rpl.passes.legalise.control.structure import labels_to_structure
from rpl.passes.legalise.data.comparedrecords import compared_records
from rpl.passes.legalise.data.lists import lists_in_variables
from rpl.passes.legalise.errors.errornumbers import error_numbers
from rpl.passes.legalise.errors.errorplaces import unreachable_moves
from rpl.passes.legalise.errors.errorroutines import error_routines
from rpl.passes.legalise.errors.errortexts import error_texts
from rpl.passes.legalise.interrupts.emptyreactions import without_empty_reactions
from rpl.passes.legalise.interrupts.interruptplaces import interrupt_places
from rpl.passes.legalise.io.queuedwaits import queued_waits
from rpl.passes.legalise.paths.wristpaths import wrist_paths
from rpl.passes.legalise.routines.aliasing import without_shared_references
from rpl.passes.legalise.routines.results import list_results
from rpl.passes.legalise.settings.joinedmoves import joined_moves
from rpl.passes.legalise.settings.movetimes import move_times
from rpl.passes.legalise.settings.nextmove import settings_of_next_move
from rpl.passes.legalise.settings.nextmovecalls import next_moves_behind_calls
from rpl.passes.legalise.settings.scaledaccelerations import scaled_accelerations
from rpl.passes.legalise.settings.turningtimes import turning_times
from rpl.passes.legalise.source.ownrecords import apart_from_neutral_records
from rpl.passes.legalise.source.possiblecases import possible_cases
from rpl.passes.legalise.source.prelude import link_prelude
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.storage.usedelements import used_elements

STAGE = Stage(
    "errors",
    (
        without_empty_reactions,
        interrupt_places,
        unreachable_moves,
        error_numbers,
        error_texts,
        link_prelude,
        apart_from_neutral_records,
        used_elements,
        possible_cases,
        wrist_paths,
        labels_to_structure,
        queued_waits,
        next_moves_behind_calls,
        settings_of_next_move,
        scaled_accelerations,
        joined_moves,
        move_times,
        turning_times,
        error_routines,
        without_shared_references,
        list_results,
        lists_in_variables,
        compared_records,
    ),
)
