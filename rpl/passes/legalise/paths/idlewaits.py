"""Waits for the end of a motion where the robot rests in any case: up to the first move of a program, for it starts at
rest, and behind another such wait (V+ TOOL waits by itself wherever it stands).
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.forward import started
from rpl.passes.legalise.facts.motion.resting import Rests
from rpl.passes.legalise.interrupts.tasks.criticals import Facts
from rpl.passes.legalise.kinds import kinds_in, rewrite_for
from rpl.passes.legalise.stages import legalising

_BESIDE = frozenset(
    ("DeclareInterrupt", "ConnectInterrupt", "Trigger", "DefineTrigger", "OnError", "TaskControl", "Vendor", "Opaque")
)


@legalising(sees=("WaitForMotion",))
def idle_waits(program: ir.Program, context: Context) -> ir.Program:
    """Only where nothing runs beside the program: that may move the robot meanwhile."""
    if program.tasks or not _BESIDE.isdisjoint(kinds_in(program)):
        return program
    facts = Facts(program)
    resting = Rests(program, holds=rules_of(context.source).advance.runs_ahead_of == "fly_by")
    resting.solve(sorted({*started(program), *facts.alone, *facts.started}), sorted(facts.several))

    def change(node: object) -> object:
        if not isinstance(node, ir.WaitForMotion) or not resting.before.get(id(node), False):
            return node
        return ir.Nothing(origin=node.origin) if node.origin.comments else ()

    return rewrite_for({"WaitForMotion"}, program, change)


__all__ = ["idle_waits"]
