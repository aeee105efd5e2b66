"""Data that programs read and to which nothing in the project gives a value, with a value that a run can begin with.

That is the same data that a run with `assume_data` meets, as far as it can be told without running: whole variables,
and elements and components that are written out. What the project sets somewhere is left out: whether that comes in
time only a run tells.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import get_args

from rpl import ir
from rpl.inventory.contents import place_of
from rpl.inventory.outside import Outside
from rpl.ir.walk import bodies, walk
from rpl.passes.roles import Roles, last_name, roles_of
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.passes.undeclared import MODULE, declared_by_use
from rpl.source import NOWHERE

_STATEMENTS = get_args(ir.Statement)
_WHOLE = (ir.PoseType, ir.TargetType, ir.JointsType)  # their components are not told one by one
_ZERO_POSE = "{ x = 0, y = 0, z = 0, a = 0, b = 0, c = 0 }"
_ZERO_JOINTS = "{ j1 = 0, j2 = 0, j3 = 0, j4 = 0, j5 = 0, j6 = 0 }"


@dataclass(frozen=True, slots=True)
class Lacking:
    """One datum. path: as a cell file calls it; `value`: as TOML. `left`: why the run is left to begin it itself: moves
    go there, so that only the run knows a good value (where the arm stands, in the tool and frame in force), or it is
    a number or text that the controller keeps and that begins at zero anyway."""

    path: str
    value: str
    left: str
    places: tuple[str, ...]


def lacking(program: ir.Program) -> list[Lacking]:
    """In the order of their names; of a normalised program."""
    program = declared_by_use(program)
    outside, roles = Outside(program), roles_of(program)
    declared = (one for module in program.modules for one in module.declarations)
    names = [one.name.lower() for one in declared if isinstance(one, ir.Variable) and _is_empty(one)]
    found: dict[str, tuple[str, str, str, dict[str, None]]] = {}
    for module, routine in outside.scopes.routines():
        scope = outside.scopes.routine(module, routine)
        if not scope.rules.undefined:
            continue
        here = NOWHERE
        for node in walk(*bodies(routine)):
            if isinstance(node, _STATEMENTS):
                here = node.origin
            elif isinstance(node, ir.Name | ir.Index | ir.Field):
                told = _told(node, scope, outside, roles, names)
                if told is not None:
                    found.setdefault(told[0].lower(), (*told, {}))[3][place_of(here)] = None
    return [Lacking(path, value, left, tuple(places)) for _, (path, value, left, places) in sorted(found.items())]


def _told(
    node: ir.Expression, scope: Scope, outside: Outside, roles: Roles, names: list[str]
) -> tuple[str, str, str] | None:
    """Path, value and why it is left to the run; None for a place that has a value, or no single one."""
    path, root = _path(node)
    symbol = scope.value(root) if path else None
    declared = symbol.declaration if symbol is not None else None
    if symbol is None or symbol.module is None or symbol.routine is not None or not _is_empty(declared):
        return None
    if id(declared) in outside.changed or _is_initialised(symbol.module, root):
        return None
    value = _value(type_of(node, scope), scope, last_name(node) in roles.indices)
    if value is None or (isinstance(node, ir.Field) and isinstance(type_of(node.base, scope), _WHOLE)):
        return None
    several = names.count(root.lower()) > 1 and symbol.module.name != MODULE
    goes = root.lower() in roles.goals and value in (_ZERO_POSE, _ZERO_JOINTS)
    kept = isinstance(declared, ir.Variable) and declared.initial is not None and value in ("0", '""')
    left = "a place, begins where the arm stands" if goes else "kept, begins at zero" if kept else ""
    return (f"{symbol.module.name}.{path}" if several else path), value, left


def _is_empty(declared: object) -> bool:
    """A variable of a module without a first value."""
    if not isinstance(declared, ir.Variable) or declared.storage == "constant":
        return False
    match declared.initial:
        case None | ir.VendorValue():
            return True
        case ir.Aggregate(entries=entries):
            return any(isinstance(value, ir.VendorValue) for _, value in entries)
    return False


def _is_initialised(module: ir.Module, root: str) -> bool:
    """Does a data list of the module give values to it or to parts of it?"""
    for one in module.declarations:
        if isinstance(one, ir.Initialise):
            target = one.assign.target
            while isinstance(target, ir.Index | ir.Field):
                target = target.base
            if isinstance(target, ir.Name) and target.id.lower() == root.lower():
                return True
    return False


def _path(place: ir.Expression) -> tuple[str, str]:
    """A place as a cell file writes it, and its root; empty where an index is worked out."""
    match place:
        case ir.Name(id=name):
            return name, name
        case ir.Field(base=base, name=name):
            path, root = _path(base)
            return (f"{path}.{name}" if path else ""), root
        case ir.Index(base=base, indices=(ir.IntLiteral(value=number),)):
            path, root = _path(base)
            return (f"{path}[{number}]" if path else ""), root
    return "", ""


def _value(type: ir.Type | None, scope: Scope, index: bool) -> str | None:
    """What such a datum begins with, as TOML; None for one with parts of its own."""
    match scope.resolve(type) if type is not None else None:
        case ir.IntType() | ir.RealType():
            return "1" if index else "0"
        case ir.BoolType():
            return "false"
        case ir.StringType() | ir.CharType():
            return '""'
        case ir.PoseType() | ir.TargetType():
            return _ZERO_POSE
        case ir.JointsType():
            return _ZERO_JOINTS
        case ir.NamedType(name=name):
            kind = scope.type(name)
            return json.dumps(f"#{kind.members[0]}") if isinstance(kind, ir.EnumDeclaration) and kind.members else None
    return None


__all__ = ["Lacking", "lacking"]
