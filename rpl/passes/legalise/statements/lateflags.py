"""Whether a wait has taken too long, asked as the target's people ask it (`rewriting.lateflags`)."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.lateflags import asked_again
from rpl.passes.legalise.stages import legalising

__all__ = ["late_flags"]


@legalising(sees=("WaitUntil",))
def late_flags(program: ir.Program, context: Context) -> ir.Program:
    """A wait that is tried again and again is a loop that looks first; whether it has taken too long is asked by the
    condition where waits have no limit, else by their flag."""
    return asked_again(program, context, by_condition=not context.capabilities.io.wait_timeout)
