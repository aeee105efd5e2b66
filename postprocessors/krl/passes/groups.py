"""Groups of signals given by their numbers get a name, for targets that know groups by their declarations only."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising


@legalising(sees=("Signal",))
def name_groups(program: ir.Program, context: Context) -> ir.Program:
    """Each group with constant numbers is declared once; computed ones stay and are reported by the writer."""
    names: dict[tuple[str, int, int], str] = {}

    def change(node: object) -> object:
        match node:
            case ir.Signal(
                kind=kind, index=ir.IntLiteral(value=first), last=ir.IntLiteral(value=last), name=None, origin=origin
            ):
                way = "in" if kind.endswith("in") else "out"
                key = (f"digital_{way}", first, last)
                if key not in names:
                    names[key] = context.fresh(f"{way}_{first}_{last}")
                return ir.Name(names[key], origin=origin)
        return node

    done = replace(
        program,
        modules=tuple(
            replace(module, routines=tuple(rewrite(routine, change) for routine in module.routines))
            for module in program.modules
        ),
    )
    if not names:
        return program
    declared = tuple(
        ir.SignalDeclaration(name, ir.Signal(kind, ir.IntLiteral(first), ir.IntLiteral(last)), scope="global")
        for (kind, first, last), name in names.items()
    )
    first_module = done.modules[0]
    module = ir.Module(context.fresh("rpl_groups"), first_module.dialect, declared, task=first_module.task, public=True)
    return replace(done, modules=(*done.modules, module))
