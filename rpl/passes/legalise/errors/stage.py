"""Handlers, raised errors and their numbers; then the source's own routines and data come along (its prelude), because
errors have their names from it, and what it does where all is known stands in the place of its calls; jumps out of
handlers become structure.
"""

from __future__ import annotations

from rpl.passes.legalise.errors.bookkeeping import without_bookkeeping
from rpl.passes.legalise.errors.declaredvalues import declared_values
from rpl.passes.legalise.errors.errortexts import error_texts
from rpl.passes.legalise.errors.interruptplaces import interrupt_places
from rpl.passes.legalise.errors.knowncalls import known_calls
from rpl.passes.legalise.errors.ownrecords import apart_from_neutral_records
from rpl.passes.legalise.errors.posetables import drop_called_ahead, poses_of_tables
from rpl.passes.legalise.errors.possiblecases import possible_cases
from rpl.passes.legalise.errors.prelude import link_prelude
from rpl.passes.legalise.errors.usedelements import used_elements
from rpl.passes.legalise.stages import Clause, Stage, again
from rpl.passes.legalise.statements.structure import labels_to_structure

STAGE = Stage(
    "errors",
    (
        interrupt_places,
        error_texts,
        link_prelude,
        apart_from_neutral_records,
        known_calls,
        drop_called_ahead,
        poses_of_tables,
        without_bookkeeping,
        used_elements,
        declared_values,
        possible_cases,
        again(labels_to_structure, "ways through the program are followed behind it, and are structure then"),
    ),
    Clause(
        statements="Goto Label",
        functions="error_text",
        system="interrupt_joints interrupt_pose",
    ),
)
