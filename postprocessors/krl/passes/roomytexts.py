"""What keeps parts of texts beside those that got more room (passes make it when the room is given already)."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.textroom import declared_types, with_room
from rpl.passes.legalise.stages import legalising


@legalising()
def roomy_texts(program: ir.Program, context: Context) -> ir.Program:
    """What keeps parts of texts beside those that got more room gets as much."""
    if context.capabilities.texts.room is None:
        return program
    most = context.capabilities.texts.room[1]
    return with_room(program, most) if ir.StringType(ir.IntLiteral(most)) in declared_types(program) else program
