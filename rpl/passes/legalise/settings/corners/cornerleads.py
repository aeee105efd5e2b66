"""Outputs behind a corner, for controllers whose program goes on some time before it (RAPID).

Where the source's program goes on at the corner itself, the output comes that much earlier here; this is only told.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.stages import legalising

EARLY = code(
    "output-before-corner",
    Severity.WARNING,
    "the target's program goes on {seconds:g} s before a corner; the outputs behind this move come that much earlier",
    "where the moment matters, write the output as an action on the path or let the move stop",
)
_QUIET = (ir.Nothing, ir.Label, ir.Trigger, ir.LookAhead)


@legalising()
def corner_leads(program: ir.Program, context: Context) -> ir.Program:
    """Tells of such outputs; the program stays as it is."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    if {source.runs_ahead_of, target.runs_ahead_of} == {"fly_by"} and target.lead_s > source.lead_s:
        for module in program.modules:
            for routine in module.routines:
                for body in bodies(routine):
                    _look(body, target.lead_s - source.lead_s, context)
    return program


def _look(body: ir.Body, lead_s: float, context: Context) -> None:
    for at, statement in enumerate(body):
        for inner in blocks(statement):
            _look(inner, lead_s, context)
        if not isinstance(statement, ir.Move) or statement.blend in (None, ir.BlendStop()) or statement.concurrent:
            continue
        behind = next((one for one in body[at + 1 :] if not isinstance(one, _QUIET)), None)
        if behind is not None and any(_acts(node) for node in walk(behind)):
            context.diagnostics.report(EARLY, statement.origin, seconds=lead_s)


def _acts(node: object) -> bool:
    """Does it set an output?"""
    return isinstance(node, ir.Pulse) or (isinstance(node, ir.Assign) and isinstance(node.target, ir.Signal))


__all__ = ["corner_leads"]
