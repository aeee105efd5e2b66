"""Moves that are coordinated with a mechanism, and places seen from frames while one of them is on a mechanism, for
targets that cannot say so: reported by name, and guarded.

The path of such a move is straight (or round) in the moving frame of the mechanism. Driven beside it, the tool would go
another way over the part, so the program stops in front of the move.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.types import POSITIONAL
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.kinds import kinds_in, walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.signatures import PLACES

COORDINATED = code(
    "coordinated-move-lost",
    Severity.LOSS,
    "the target has no move that is coordinated with the mechanism {unit}",
    "the program stops there; write the move by hand",
)
SEEN = code(
    "carried-place-lost",
    Severity.LOSS,
    "where the tool is in a frame of its own cannot be composed while frames stand on mechanisms",
    "the program stops there; ask in the frame of the moves",
)
REMOTE_LOST = code(
    "remote-tool-lost",
    Severity.LOSS,
    "the target has no path in the held part under places of the tool",
    "the program stops there; write the move with a tool fixed in the room",
)
SETTING, REMOTE = "coordinated", "remote_tool"
_UNIT = "base_unit"


@legalising()
def coordinated_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the setting."""
    can = context.capabilities
    if "WorkObjectType" not in can.types and any(
        _is_carried(node) for node in walk_for({"Assign", "Variable"}, *program.modules)
    ):
        program = _Composed(program, context).program()
    lacking = tuple(name for name in (SETTING, REMOTE) if name not in can.system_variables)
    if kinds_in(program).isdisjoint(f"system {name}" for name in lacking):
        return program
    return _Guarded(program, context, lacking).program()


def _is_carried(node: object) -> bool:
    """Does it put a frame on a mechanism?"""
    match node:
        case ir.Assign(target=ir.System(name=name)):
            return name == _UNIT
        case ir.Variable(type=ir.WorkObjectType(), initial=ir.Aggregate(entries=entries)):
            names = POSITIONAL[ir.WorkObjectType]
            given = {name or names[place]: value for place, (name, value) in enumerate(entries)}
            fixed, unit = given.get("fixed"), given.get("unit")
            return fixed == ir.BoolLiteral(False) and isinstance(unit, ir.TextLiteral) and bool(unit.value.strip())
    return False


class _Composed(Rewriter):
    """Stops in front of what asks for a place in a frame that it names."""

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        asked: list[ir.Builtin] = []
        each_expression(statement, lambda node: asked.append(node) if _names_frame(node) else None)
        done = super().statement(statement)
        if not asked:
            return done
        self.context.diagnostics.report(SEEN, statement.origin)
        return [ir.Halt(origin=replace(statement.origin, comments=())), *done]


def _names_frame(node: object) -> TypeGuard[ir.Builtin]:
    if not isinstance(node, ir.Builtin) or node.function not in PLACES:
        return False
    return len(node.arguments) > PLACES[node.function][1]


class _Guarded(Rewriter):
    def __init__(self, program: ir.Program, context: Context, lacking: tuple[str, ...]) -> None:
        super().__init__(program, context)
        self.lacking = lacking

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move):
            lost = [(place.name, value) for place, value in statement.settings if self.is_lost(place)]
            if lost:
                for name, value in lost:
                    if name == REMOTE:
                        self.context.diagnostics.report(REMOTE_LOST, statement.origin)
                        continue
                    unit = value.value if isinstance(value, ir.TextLiteral) else "that the program chooses"
                    self.context.diagnostics.report(COORDINATED, statement.origin, unit=unit)
                rest = tuple(one for one in statement.settings if not self.is_lost(one[0]))
                bare = replace(statement, settings=rest, origin=replace(statement.origin, comments=()))
                return [ir.Halt(origin=statement.origin), *super().statement(bare)]
        return super().statement(statement)

    def is_lost(self, place: ir.Expression) -> TypeGuard[ir.System]:
        """A setting of the move that the target has no word for."""
        return isinstance(place, ir.System) and place.name in self.lacking


__all__ = ["REMOTE", "SETTING", "coordinated_moves"]
