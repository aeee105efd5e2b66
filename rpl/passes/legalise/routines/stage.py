"""Calls, parameters and results, as the target gives and takes them."""

from __future__ import annotations

from rpl.passes.legalise.data.arrays import array_sizes
from rpl.passes.legalise.data.defaults import starting_values
from rpl.passes.legalise.data.numbers import numbers
from rpl.passes.legalise.data.subscriptchecks import checked_subscripts
from rpl.passes.legalise.data.undefined import asked_values
from rpl.passes.legalise.data.undefinedparts import asked_elements
from rpl.passes.legalise.data.wholesubscripts import whole_subscripts
from rpl.passes.legalise.routines.givenarrays import given_arrays
from rpl.passes.legalise.routines.optional import fit_parameters
from rpl.passes.legalise.routines.valuearrays import copy_value_arrays
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.texts.textpartchecks import checked_text_parts

STAGE = Stage(
    "routines",
    (
        whole_subscripts,
        numbers,
        starting_values,
        fit_parameters,
        asked_values,
        given_arrays,
        asked_elements,
        copy_value_arrays,
        checked_subscripts,
        checked_text_parts,
        array_sizes,
    ),
)
