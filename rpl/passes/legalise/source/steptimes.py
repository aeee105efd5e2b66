"""The cycle of the source's controller as a number, for targets that cannot ask for theirs.

Programs wait for a cycle and count its time. Where the target's shortest wait is longer, that is what they count.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import children, statements_in
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.source import NOWHERE, Origin

LONGER = code(
    "step-time-longer",
    Severity.WARNING,
    "a cycle of the source's controller is {cycle:g} s, the shortest wait of the target {seconds:g} s: the program "
    "waits and counts in steps of that",
    "times that are counted stay right; what is done once in a cycle is done less often",
)
_STEP = ir.System("step_time")
_CYCLE_S = 0.012  # of a source that says nothing about it: the cycle in which controllers interpolate


@legalising(unless=lambda context: _STEP.name in context.capabilities.system_variables, sees=("system step_time",))
def step_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such a system variable."""
    if _STEP not in list(walk_for({"system step_time"}, *program.modules)):
        return program
    cycle = rules_of(context.source).wait_poll_s or _CYCLE_S
    seconds = max(cycle, context.capabilities.io.shortest_wait_s)
    known = ir.RealLiteral(seconds)
    if seconds > cycle:
        context.diagnostics.report(LONGER, _first(program), cycle=cycle, seconds=seconds)
    modules = tuple(rewrite(module, lambda node: known if node == _STEP else node) for module in program.modules)
    return replace(program, modules=modules)


def _first(program: ir.Program) -> Origin:
    """The first statement that asks for the cycle."""
    for module in program.modules:
        for routine in module.routines:
            for statement in (one for body in bodies(routine) for one in statements_in(body)):
                if _STEP in list(walk(*children(statement))):
                    return statement.origin
    return NOWHERE


__all__ = ["step_times"]
