"""The generated module `rpl_support`: variables and routines that rewritten programs need, each made once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.rewrite import changed, each

SUPPORT = "rpl_support"
_NAMED = ir.Variable | ir.SignalDeclaration


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
    program = _seen(program, routines, {one.name.lower() for one in declarations if isinstance(one, _NAMED)})
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


def _seen(program: ir.Program, routines: Sequence[ir.Routine], own: set[str]) -> ir.Program:
    """What the routines name becomes visible in all modules: a signal or a variable that only its module saw."""
    inside = (one for routine in routines for one in (*routine.parameters, *routine.declarations))
    own = own | {one.name.lower() for one in inside if isinstance(one, _NAMED | ir.Parameter)}
    named = {node.id.lower() for node in walk(*routines) if isinstance(node, ir.Name)} - own
    holders = Counter(
        one.name.lower() for module in program.modules for one in module.declarations if isinstance(one, _NAMED)
    )
    wanted = {name for name in named if holders[name] == 1}

    def shown(one: ir.Declaration) -> ir.Declaration:
        hidden = isinstance(one, _NAMED) and one.scope == "module" and one.name.lower() in wanted
        return replace(one, scope="global") if hidden and isinstance(one, _NAMED) else one

    if not wanted:
        return program
    modules = tuple(changed(one, declarations=each(one.declarations, shown)) for one in program.modules)
    return changed(program, modules=modules)


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
