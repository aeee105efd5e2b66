"""Handlers, raised errors and their numbers; then the source's own routines and data come along (its prelude), because
errors have their names from it, and jumps out of handlers become structure. A routine for all errors stays one until
the settings of moves are known (places).
"""

from __future__ import annotations

from rpl.passes.legalise.errors.errornumbers import error_numbers
from rpl.passes.legalise.errors.errorplaces import unreachable_moves
from rpl.passes.legalise.errors.errortexts import error_texts
from rpl.passes.legalise.errors.interruptplaces import interrupt_places
from rpl.passes.legalise.errors.ownrecords import apart_from_neutral_records
from rpl.passes.legalise.errors.possiblecases import possible_cases
from rpl.passes.legalise.errors.prelude import link_prelude
from rpl.passes.legalise.errors.usedelements import used_elements
from rpl.passes.legalise.interrupts.emptyreactions import without_empty_reactions
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.statements.jumps.structure import labels_to_structure

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
        labels_to_structure,
    ),
)
