"""The order of the passes. Each is listed once; its module says what it needs from the ones before it."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context, Pass, names_in

PASSES: tuple[Pass, ...] = ()


def legalise(program: ir.Program, context: Context) -> ir.Program:
    """The program rewritten for the context's target. Same-language writing leaves it as it is."""
    context.taken |= names_in(program)
    if not context.foreign:
        return program
    for one in PASSES:
        program = one(program, context)
    return program
