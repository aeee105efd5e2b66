"""Signals by the names that the program declares for them: `suction=TRUE` where `SIGNAL suction $OUT[1]` stands in the
data list. Readers of other languages know such a signal by its number.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

_KINDS = ("digital_in", "digital_out")


@legalising(sees=("Signal",))
def signals_by_name(program: ir.Program, context: Context) -> ir.Program:
    """Only names that the whole program knows, and that stand for one signal alone."""
    names: dict[ir.Signal, str] = {}
    for one in walk_for({"SignalDeclaration"}, *program.modules):
        if isinstance(one, ir.SignalDeclaration) and one.scope == "global" and one.signal.kind in _KINDS:
            names.setdefault(one.signal, one.name)

    def named(node: object) -> object:
        if not isinstance(node, ir.Signal) or node not in names:
            return node
        return ir.Name(names[node], origin=node.origin)

    modules = (
        replace(module, routines=tuple(rewrite(one, named) for one in module.routines)) for module in program.modules
    )
    return replace(program, modules=tuple(modules))


__all__ = ["signals_by_name"]
