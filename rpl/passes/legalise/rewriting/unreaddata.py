"""Data that a pass has said otherwise: where nothing reads it any more, what is left are assignments for nobody."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.facts.effects import Effects
from rpl.passes.legalise.kinds import walk_for


def without_unread(program: ir.Program, names: Collection[str]) -> ir.Program:
    """The program without those of the variables (folded names) that are only the whole target of assignments whose
    values change nothing, call nothing and cannot fail. Remarks of the assignments stay."""
    used, noted, effects = Counter[str](), Counter[str](), Effects(program)
    for node in walk_for({"Name", "Assign"}, *program.modules):
        match node:
            case ir.Name(id=name):
                used[name.lower()] += 1
            case ir.Assign(target=ir.Name(id=name), value=value) if effects.safe(value):
                noted[name.lower()] += 1
    gone = {name for name in names if used[name] == noted[name]}
    if not gone:
        return program

    def change(node: object) -> object:
        match node:
            case ir.Assign(target=ir.Name(id=name), origin=origin) if name.lower() in gone:
                return ir.Nothing(origin=origin) if origin.comments else ()
        return node

    modules = []
    for module in program.modules:
        kept = [one for one in module.declarations if not (isinstance(one, ir.Variable) and one.name.lower() in gone)]
        modules.append(rewrite(replace(module, declarations=tuple(kept)), change))
    return replace(program, modules=tuple(modules))


__all__ = ["without_unread"]
