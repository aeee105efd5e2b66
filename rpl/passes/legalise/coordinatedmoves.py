"""Moves that are coordinated with a mechanism, for targets that cannot say so: reported by name, and guarded.

The path of such a move is straight (or round) in the moving frame of the mechanism. Driven beside it, the tool would go
another way over the part, so the program stops in front of the move.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.walk import Rewriter

COORDINATED = code(
    "coordinated-move-lost",
    Severity.LOSS,
    "the target has no move that is coordinated with the mechanism {unit}",
    "the program stops there; write the move by hand",
)
SETTING = "coordinated"


def coordinated_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the setting."""
    if SETTING in context.capabilities.system_variables:
        return program
    return _Guarded(program, context).program()


class _Guarded(Rewriter):
    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move):
            led = [value for place, value in statement.settings if _is_led(place)]
            if led:
                unit = led[0].value if isinstance(led[0], ir.TextLiteral) else "that the program chooses"
                self.context.diagnostics.report(COORDINATED, statement.origin, unit=unit)
                rest = tuple(one for one in statement.settings if not _is_led(one[0]))
                bare = replace(statement, settings=rest, origin=replace(statement.origin, comments=()))
                return [ir.Halt(origin=statement.origin), *super().statement(bare)]
        return super().statement(statement)


def _is_led(place: ir.Expression) -> bool:
    return isinstance(place, ir.System) and place.name == SETTING


__all__ = ["coordinated_moves"]
