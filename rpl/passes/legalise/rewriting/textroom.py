"""Texts with room for so many characters, for targets that declare how much each has."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir


def declared_types(program: ir.Program) -> Iterator[ir.Type]:
    """What is declared, of lists their elements."""
    for module in program.modules:
        for one in (*module.declarations, *(d for routine in module.routines for d in routine.declarations)):
            types = [one.type] if isinstance(one, ir.Variable) else []
            types += [type for _, type in one.fields] if isinstance(one, ir.RecordDeclaration) else []
            for type in types:
                while isinstance(type, ir.ArrayType):
                    type = type.element
                yield type


def with_room(program: ir.Program, most: int) -> ir.Program:
    def declared(one: ir.Declaration) -> ir.Declaration:
        match one:
            case ir.Variable(type=type):
                return replace(one, type=_roomy(type, most))
            case ir.RecordDeclaration(fields=fields):
                return replace(one, fields=tuple((name, _roomy(type, most)) for name, type in fields))
        return one

    modules = []
    for module in program.modules:
        routines = tuple(replace(one, declarations=tuple(map(declared, one.declarations))) for one in module.routines)
        modules.append(replace(module, declarations=tuple(map(declared, module.declarations)), routines=routines))
    return replace(program, modules=tuple(modules))


def _roomy(type: ir.Type, most: int) -> ir.Type:
    match type:
        case ir.StringType(capacity=None):
            return ir.StringType(ir.IntLiteral(most))
        case ir.ArrayType(element=element):
            return replace(type, element=_roomy(element, most))
    return type


__all__ = ["declared_types", "with_room"]
