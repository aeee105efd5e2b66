"""The payload that a program asks for, for targets whose moves know no payload that could be asked.

It is what the program has set last: kept in variables beside each setting, zero before the first one.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising

_LOAD = ir.System("load")
# What can be asked, with the name of its variable.
_ASKED = {
    ir.Field(_LOAD, "mass"): "payload_mass",
    **{ir.Field(ir.Field(_LOAD, "cog"), axis): f"payload_{axis}" for axis in "xyz"},
}


@legalising(sees=("System",))
def load_readings(program: ir.Program, context: Context) -> ir.Program:
    """Only for programs that ask for the mass or its centre and set them by written-out loads."""
    nodes = list(walk(*program.modules))
    asked = [place for place in _ASKED if place in nodes]
    if not asked:
        return program
    settings = [node for node in nodes if isinstance(node, ir.Assign) and node.target == _LOAD]
    if any(not isinstance(one.value, ir.Aggregate) for one in settings):
        return program
    names = {place: ir.Name(context.fresh(_ASKED[place])) for place in asked}

    def change(node: object) -> object:
        if isinstance(node, ir.Field) and node in names:
            return names[node]
        match node:
            case ir.Assign(target=target, value=ir.Aggregate(entries=entries)) if target == _LOAD:
                parts = dict(_parts(entries))
                kept = [ir.Assign(name, parts[place]) for place, name in names.items() if place in parts]
                changed = [one for one in kept if one.target != one.value]
                return (node, *changed) if changed else node
        return node

    modules = tuple(rewrite(module, change) for module in program.modules)
    kept = tuple(ir.Variable(name.id, ir.RealType(), ir.RealLiteral(0.0), scope="global") for name in names.values())
    return with_support(replace(program, modules=modules), context, kept, (), modules[0].task)


def _parts(entries: tuple[tuple[str | None, ir.Expression], ...]) -> list[tuple[ir.Field, ir.Expression]]:
    """The places of a load that a written-out one sets, with their values."""
    found: list[tuple[ir.Field, ir.Expression]] = []
    for name, value in entries:
        if name == "mass":
            found.append((ir.Field(_LOAD, "mass"), value))
        elif name == "cog" and isinstance(value, ir.Aggregate):
            centre = ir.Field(_LOAD, "cog")
            found += [(ir.Field(centre, axis), part) for axis, part in value.entries if axis is not None]
    return found


__all__ = ["load_readings"]
