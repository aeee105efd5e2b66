"""Waits for a time or a place, for controllers that look at such a condition at intervals (RAPID's WaitUntil: 0.1 s).

The program goes on up to such an interval later than in the source, and so comes what is measured behind it; this is
only told.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.advance import looks
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

SELDOM = code(
    "wait-looks-seldom",
    Severity.WARNING,
    "the target looks at this condition only every {seconds:g} s: the program goes on up to so much later",
    "where the moment matters, make the interval shorter on the controller, or wait for a signal",
)
_CYCLE_S = 0.02  # a controller that looks in each of its cycles
_TIMES = frozenset(("timer", "timer_positive", "time"))
_CLOCKS = frozenset(("clock_seconds",))


@legalising(sees=("WaitUntil",))
def seldom_looks(program: ir.Program, context: Context) -> ir.Program:
    """Tells of such waits, each statement of the source once; the program stays as it is."""
    source, target = (rules_of(one).wait_poll_s for one in (context.source, context.target))
    if target <= max(source, _CYCLE_S):
        return program
    told = set()
    for node in walk_for({"WaitUntil"}, *program.modules):
        if isinstance(node, ir.WaitUntil) and any(map(_passes, walk(node.condition))) and node.origin not in told:
            told.add(node.origin)
            context.diagnostics.report(SELDOM, node.origin, seconds=target)
    return program


def _passes(node: object) -> bool:
    """Is it a time, or where the robot is?"""
    match node:
        case ir.System(name=name) if name in _TIMES:
            return True
        case ir.Builtin(function=function) if function in _CLOCKS:
            return True
    return looks(node)


__all__ = ["seldom_looks"]
