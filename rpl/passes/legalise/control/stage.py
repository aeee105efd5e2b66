"""Loops, branches and nested expressions, in the blocks and steps that the target has."""

from __future__ import annotations

from rpl.passes.legalise.control.elseif import nest_branches
from rpl.passes.legalise.control.labels import structure_to_labels
from rpl.passes.legalise.control.longlogic import long_logic
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.control.steps import steps
from rpl.passes.legalise.places.components import read_components
from rpl.passes.legalise.routines.functions import functions_to_procedures
from rpl.passes.legalise.routines.parameters import fit_arguments
from rpl.passes.legalise.stages import Stage
from rpl.passes.legalise.storage.locals import variables_of_routines

STAGE = Stage(
    "control",
    (
        functions_to_procedures,
        fit_arguments,
        fit_loops,
        read_components,
        long_logic,
        steps,
        variables_of_routines,
        nest_branches,
        structure_to_labels,
        steps,
    ),
)
