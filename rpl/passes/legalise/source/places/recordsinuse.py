"""The tool and the work object in use as records, for targets that can ask for their frames only: each part by itself,
where the program sets both as poses and no move names its own.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_PLACES = (ir.Name, ir.Field, ir.Index)
_NONE = ir.System("null_frame")


@legalising(
    unless=lambda context: (
        context.capabilities.carries_rules
        or not context.capabilities.settings.modal
        or not {"current_tool", "current_frame"} - context.capabilities.functions
    ),
    sees=("function current_tool", "function current_frame"),
)
def records_in_use(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without functions for them."""
    can = context.capabilities
    asked = {"current_tool", "current_frame"} - can.functions
    nodes = list(walk(*program.modules))
    if not any(isinstance(node, ir.Builtin) and node.function in asked and not node.arguments for node in nodes):
        return program
    if any(isinstance(node, ir.Move) and (node.tool or node.frame) for node in nodes):
        return program
    worker = _Parts(program, context)
    done = worker.program()
    return program if worker.records else done


class _Parts(Rewriter):
    """`records`: a setting is given as a record, so the frame in use is none by itself."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.records = False

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=ir.System(name="tool" | "base"), value=value):
                self.records = self.records or isinstance(self.type_of(value), ir.ToolType | ir.WorkObjectType)
            case ir.Assign(target=target, value=ir.Builtin(function="current_tool", arguments=())) if isinstance(
                target, _PLACES
            ):
                return self.given(statement, target, {"held": ir.BoolLiteral(True), "frame": ir.System("tool")})
            case ir.Assign(target=target, value=ir.Builtin(function="current_frame", arguments=())) if isinstance(
                target, _PLACES
            ):
                frames = {"user_frame": ir.System("base"), "object_frame": _NONE}
                return self.given(statement, target, {"held": ir.BoolLiteral(False), **frames})
        return super().statement(statement)

    def given(self, statement: ir.Assign, place: ir.Expression, parts: dict[str, ir.Expression]) -> list[ir.Statement]:
        return [ir.Assign(ir.Field(place, name), value, origin=statement.origin) for name, value in parts.items()]


__all__ = ["records_in_use"]
