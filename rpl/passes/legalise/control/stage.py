"""Loops, branches and nested expressions, in the blocks and steps that the target has. Functions become procedures
when no pass makes calls any more; what that puts in front of conditions makes loops, so these are fitted again;
nested expressions become steps, and again behind labels, whose conditions are opposites.
"""

from __future__ import annotations

from rpl.passes.legalise.control.elseif import join_branches, nest_branches
from rpl.passes.legalise.control.functions import functions_to_procedures
from rpl.passes.legalise.control.labels import structure_to_labels
from rpl.passes.legalise.control.locals import variables_of_routines
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.control.parameters import fit_arguments
from rpl.passes.legalise.control.samevariables import same_variables
from rpl.passes.legalise.control.steps import steps
from rpl.passes.legalise.stages import Clause, Stage, again

STAGE = Stage(
    "control",
    (
        functions_to_procedures,
        same_variables,
        fit_arguments,
        fit_loops,
        steps,
        variables_of_routines,
        nest_branches,
        join_branches,
        structure_to_labels,
        again(steps, "conditions of the jumps that structure has become are opposites"),
    ),
    Clause(
        statements="ExitLoop Loop NextPass Repeat While",
        operators="cand cor not",
        further=frozenset(("function of the program", "parameter")),
    ),
)
