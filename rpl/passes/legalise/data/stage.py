"""Values, types and elements of arrays, as the target keeps and calculates them."""

from __future__ import annotations

from rpl.passes.legalise.data.arrays import array_bases
from rpl.passes.legalise.data.subscripts import joined_subscripts
from rpl.passes.legalise.stages import Stage

STAGE = Stage(
    "data",
    (
        joined_subscripts,
        array_bases,
    ),
)
