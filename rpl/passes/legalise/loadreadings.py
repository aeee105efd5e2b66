"""The mass of the payload that a program asks for, for targets whose moves know no payload that could be asked.

It is what the program has set last: kept in a variable beside each setting, zero before the first one.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.support import with_support

_LOAD = ir.System("load")
_MASS = ir.Field(_LOAD, "mass")


def load_readings(program: ir.Program, context: Context) -> ir.Program:
    """Only for programs that ask for the mass and set it by written-out loads."""
    nodes = list(walk(*program.modules))
    if _MASS not in nodes:
        return program
    settings = [node for node in nodes if isinstance(node, ir.Assign) and node.target == _LOAD]
    if any(not isinstance(one.value, ir.Aggregate) for one in settings):
        return program
    name = context.fresh("payload_mass")

    def change(node: object) -> object:
        if node == _MASS:
            return ir.Name(name)
        match node:
            case ir.Assign(target=target, value=ir.Aggregate(entries=entries)) if target == _LOAD:
                mass = next((value for part, value in entries if part == "mass"), None)
                if mass is not None:
                    return (node, ir.Assign(ir.Name(name), mass))
        return node

    modules = tuple(rewrite(module, change) for module in program.modules)
    data = ir.Variable(name, ir.RealType(), ir.RealLiteral(0.0), scope="global")
    return with_support(replace(program, modules=modules), context, (data,), (), modules[0].task)


__all__ = ["load_readings"]
