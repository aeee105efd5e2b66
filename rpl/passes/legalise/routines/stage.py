"""Calls, parameters and results, as the target gives and takes them. They stand behind data, because a parameter has
the type that the target gives its data.
"""

from __future__ import annotations

from rpl.passes.legalise.routines.aliases import without_aliases
from rpl.passes.legalise.routines.arraysizes import array_sizes
from rpl.passes.legalise.routines.optional import fit_parameters
from rpl.passes.legalise.routines.results import list_results
from rpl.passes.legalise.routines.subscriptchecks import checked_subscripts
from rpl.passes.legalise.routines.textpartchecks import checked_text_parts
from rpl.passes.legalise.routines.undefined import asked_values
from rpl.passes.legalise.routines.valuearrays import copy_value_arrays
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "routines",
    (
        list_results,
        without_aliases,
        fit_parameters,
        asked_values,
        copy_value_arrays,
        checked_subscripts,
        checked_text_parts,
        array_sizes,
    ),
    Clause(
        functions="is_uninitialised",
        further=frozenset(("call by a computed name", "function that gives a list", "optional parameter")),
    ),
)
