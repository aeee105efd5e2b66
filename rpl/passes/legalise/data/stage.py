"""Values, types and elements of arrays, as the target keeps and calculates them. They stand behind io, because a
signal's value is converted as any other.
"""

from __future__ import annotations

from rpl.passes.legalise.data.arrays import array_bases
from rpl.passes.legalise.data.datalists import set_data_at_start
from rpl.passes.legalise.data.defaults import starting_values
from rpl.passes.legalise.data.lists import lists_in_variables
from rpl.passes.legalise.data.numbers import numbers
from rpl.passes.legalise.data.subscripts import joined_subscripts
from rpl.passes.legalise.data.wholesubscripts import whole_subscripts
from rpl.passes.legalise.stages import Clause, Stage

STAGE = Stage(
    "data",
    (
        lists_in_variables,
        joined_subscripts,
        array_bases,
        set_data_at_start,
        whole_subscripts,
        numbers,
        starting_values,
    ),
    Clause(
        operators="mod",
        types="CharType",
    ),
)
