"""Whether a wait has taken too long is asked by what it waits for: a wait is a loop that gives no answer."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.lateflags import asked_again
from rpl.passes.legalise.stages import legalising

__all__ = ["asked_by_condition"]


@legalising(sees=("WaitUntil",))
def asked_by_condition(program: ir.Program, context: Context) -> ir.Program:
    """`IF NOT ok` in place of a flag that nothing else asks."""
    return asked_again(program, context, by_condition=True)
