"""Data that a controller keeps and no program sets: taught tools, frames, registers. A cell file gives their values,
and what is written for another controller begins with them, because that one does not have them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.passes.typewords import type_word

_PATH = re.compile(r"(?:(?P<module>\w+)\.)?(?P<name>\w+)(?:\[(?P<element>\d+)\])?")


@dataclass(frozen=True, slots=True)
class _Given:
    """A value for a variable, or for one element of an array."""

    module: str
    name: str
    element: int | None
    value: object


def with_given(program: ir.Program, values: Mapping[str, object]) -> ir.Program:
    """The program whose kept data (persistent, or without a value of its own) begins with these values; what has no
    such variable, or another shape than a number, text, truth value or place, stays out."""
    given = [one for path, value in values.items() if (one := _parsed(path, value)) is not None]
    modules = tuple(
        replace(module, declarations=tuple(_begun(one, module.name, given) for one in module.declarations))
        for module in program.modules
    )
    same = all(
        new is old
        for one, other in zip(modules, program.modules, strict=True)
        for new, old in zip(one.declarations, other.declarations, strict=True)
    )
    return program if same else replace(program, modules=modules)


def _parsed(path: str, value: object) -> _Given | None:
    found = _PATH.fullmatch(path)
    if found is None:
        return None
    element = None if found["element"] is None else int(found["element"])
    return _Given((found["module"] or "").lower(), found["name"].lower(), element, value)


def _begun(declaration: ir.Declaration, module: str, given: list[_Given]) -> ir.Declaration:
    if not isinstance(declaration, ir.Variable):
        return declaration
    kept = declaration.storage == "persistent" or (declaration.storage == "variable" and declaration.initial is None)
    if not kept:
        return declaration
    for one in given:
        if one.name == declaration.name.lower() and one.module in ("", module.lower()):
            initial = _placed(one, declaration.type, declaration.initial)
            if initial is not None:
                declaration = replace(declaration, initial=initial)
    return declaration


def _placed(given: _Given, type: ir.Type, initial: ir.Expression | None) -> ir.Expression | None:
    """The first value of the variable with the given one in it."""
    if given.element is None:
        return _expression(given.value, type, initial)
    if not isinstance(type, ir.ArrayType) or not isinstance(initial, ir.Aggregate):
        return None
    at = given.element - type.base
    entries = list(initial.entries)
    if not 0 <= at < len(entries):
        return None
    name, old = entries[at]
    value = _expression(given.value, type.element, old)
    if value is None:
        return None
    entries[at] = name, value
    return ir.Aggregate(tuple(entries), origin=initial.origin)


def _expression(value: object, type: ir.Type, old: ir.Expression | None) -> ir.Expression | None:
    match value, type:
        case bool(), ir.BoolType():
            return ir.BoolLiteral(value)
        case bool(), _:
            return None
        case int(), ir.IntType():
            return ir.IntLiteral(value)
        case int() | float(), ir.RealType():
            return ir.RealLiteral(float(value))
        case str(), ir.StringType():
            return ir.TextLiteral(value)
        case dict(), ir.PoseType() | ir.TargetType():
            return _place(value, type, old)
    return None


def _place(components: dict[str, object], type: ir.Type, old: ir.Expression | None) -> ir.Expression | None:
    """A place by its components; those that are not given are as they were, or zero."""
    named = old.entries if isinstance(old, ir.Aggregate) else ()
    parts: dict[str, ir.Expression] = {name: ir.RealLiteral(0.0) for name in ir.POSE}
    parts |= {name.lower(): value for name, value in named if name is not None}
    for name, value in components.items():
        if name.lower() not in parts or isinstance(value, bool) or not isinstance(value, int | float):
            return None
        parts[name.lower()] = ir.RealLiteral(float(value))
    return ir.Aggregate(tuple(parts.items()), type_name=type_word(type))
