"""Corners whose next step stands behind a choice, a label or a call, for controllers whose program stands still for the
robot at every signal (KRL).

What directly follows a corner in its own list of steps is marked so that the corner stays (`explicit`). Here the ways
of the program are followed: an output that comes behind a corner on some of them, and behind a standing robot on the
others, gets the mark too. Where that cannot be, or where the program decides by a signal, which has to be read when
the robot is there, the robot stops at the corner, and that is told.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.advance import touches
from rpl.passes.legalise.facts.motion.cornerways import Ways
from rpl.passes.legalise.settings.corners.cornersteps import STOPS_BEHIND
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope


@legalising()
def kept_corners(program: ir.Program, context: Context) -> ir.Program:
    """Only where the target's program stands still at signals and the source's goes on at a corner."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    marks = "LookAhead" in context.capabilities.statements
    if not (target.signals_stop and marks and source.runs_ahead_of == "fly_by" and not source.signals_stop):
        return program

    def waits(statement: ir.Statement, scope: Scope) -> bool:
        return statement.__class__.__name__ in target.stop_statements or touches(statement, scope)

    def may_run_on(statement: ir.Statement, scope: Scope) -> bool:
        return waits(statement, scope) and _only_sets(statement, scope)

    ways = Ways(program, context, waits, may_run_on)
    done = ways.followed()
    if done is None:
        return program
    for origin, line in ways.stopped.items():
        context.diagnostics.report(STOPS_BEHIND, origin, line=line)
    return done


def _only_sets(statement: ir.Statement, scope: Scope) -> bool:
    """Does it set an output, and ask for nothing?"""
    match statement:
        case ir.Pulse():
            return True
        case ir.Assign(target=ir.Signal() | ir.Name(), value=value):
            return not touches(ir.Assign(ir.Name(""), value), scope)
    return False


__all__ = ["kept_corners"]
