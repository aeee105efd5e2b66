"""The generated module `rpl_support`: variables and routines that rewritten programs need, each made once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context

SUPPORT = "rpl_support"


def with_support(
    program: ir.Program,
    context: Context,
    declarations: Sequence[ir.Declaration] = (),
    routines: Sequence[ir.Routine] = (),
    task: str = "",
) -> ir.Program:
    """The program with these in its support module (made when there is none yet); `task` has one of its own."""
    if not declarations and not routines:
        return program
    for module in program.modules:
        if module.name.lower().startswith(SUPPORT) and module.task == task:
            grown = replace(
                module,
                declarations=(*module.declarations, *declarations),
                routines=(*module.routines, *routines),
            )
            return replace(program, modules=tuple(grown if one is module else one for one in program.modules))
    made = ir.Module(
        context.fresh(SUPPORT), context.source, tuple(declarations), tuple(routines), task=task, public=True
    )
    return replace(program, modules=(*program.modules, made))


def default_value(type: ir.Type) -> ir.Expression | None:
    """A neutral value of a simple type; None for structures."""
    match type:
        case ir.IntType():
            return ir.IntLiteral(0)
        case ir.RealType():
            return ir.RealLiteral(0.0)
        case ir.BoolType():
            return ir.BoolLiteral(False)
        case ir.StringType():
            return ir.TextLiteral("")
        case ir.CharType():
            return ir.TextLiteral(" ")
    return None
