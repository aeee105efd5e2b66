"""Interrupts that interrupt others, for controllers where one waits until the other has ended: it is told."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.reach import number_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import closure
from rpl.passes.legalise.stages import legalising

NOT_NESTED = code(
    "interrupts-not-nested",
    Severity.WARNING,
    "{urgent} is more urgent than {other}, which takes time; on the target it waits until that has ended",
    "let {other} do what takes time in the program instead",
)
_TAKES_TIME = (ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Move, ir.Spline, ir.Dialog)


@legalising(
    unless=lambda context: (
        "DeclareInterrupt" in context.capabilities.statements
        and (
            not (
                context.capabilities.interrupts.watched is Watched.ALL
                or context.capabilities.interrupts.watched is Watched.INTERRUPTS
            )
        )
    ),
    sees=("DeclareInterrupt",),
)
def nested_interrupts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose interrupts do not interrupt each other. The program stays as it is."""
    declared = [one for one in walk_for({"DeclareInterrupt"}, program) if isinstance(one, ir.DeclareInterrupt)]
    slow = closure(program, _TAKES_TIME) if len(declared) > 1 else frozenset()
    for other in declared:
        rank, name = number_of(other.priority), _called(other)
        if rank is None or name.lower() not in slow:
            continue
        for urgent in declared:
            mine = number_of(urgent.priority)
            if mine is not None and mine < rank and _called(urgent):
                context.diagnostics.report(NOT_NESTED, urgent.origin, urgent=_called(urgent), other=name)
    return program


def _called(declared: ir.DeclareInterrupt) -> str:
    return declared.action.name if isinstance(declared.action, ir.CallRoutine) else ""


__all__ = ["nested_interrupts"]
