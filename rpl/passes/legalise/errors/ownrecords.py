"""Record types of a program that are called like a neutral one (KRL's LOAD): another name keeps the two apart."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising

_NEUTRAL = frozenset(("tool", "workobject", "load", "speed", "zone"))


@legalising(unless=lambda context: context.capabilities.carries_rules)
def apart_from_neutral_records(program: ir.Program, context: Context) -> ir.Program:
    """For targets that do not carry the source's settings, which thus get records of tools and loads."""
    new = {
        one.name.lower(): context.fresh(f"{one.name}_data")
        for module in program.modules
        for one in module.declarations
        if isinstance(one, ir.RecordDeclaration) and one.name.lower() in _NEUTRAL
    }
    if not new:
        return program

    def renamed(node: object) -> object:
        match node:
            case ir.RecordDeclaration(name=name) if name.lower() in new:
                return replace(node, name=new[name.lower()])
            case ir.NamedType(name=name) if name.lower() in new:
                return replace(node, name=new[name.lower()])
            case ir.Aggregate(type_name=str() as name) if name.lower() in new:
                return replace(node, type_name=new[name.lower()])
        return node

    return rewrite(program, renamed)


__all__ = ["apart_from_neutral_records"]
