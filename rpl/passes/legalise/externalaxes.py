"""External axes that a program has places for but does not use: their values stand at 9E9, and nothing needs them."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant
from rpl.passes.scope import Scope

_UNUSED = 9e8  # an external axis that a target does not use stands at 9E9
_NAMES = frozenset(ir.COMPONENTS[ir.ExternalType])


def is_unused(value: ir.Expression, scope: Scope) -> bool:
    known = constant(value, scope)
    return isinstance(known, int | float) and abs(known) >= _UNUSED


def has_external_axes(program: ir.Program) -> bool:
    """Does the program look at a single external axis, move one, or give a target a place for one?"""
    cleared: set[int] = set()  # components that are only said to be unused
    for node in walk(*program.modules):
        match node:
            case ir.Assign(target=target, value=ir.RealLiteral(value=set_to)) if abs(set_to) >= _UNUSED:
                cleared.add(id(target))
    for node in walk(*program.modules):
        match node:
            case ir.MoveExternal():
                return True
            case ir.Field(name=name) if name in _NAMES and id(node) not in cleared:
                return True
            case ir.Aggregate(entries=entries) if len(entries) == len(_NAMES):
                values = [abs(v.value) for _, v in entries if isinstance(v, ir.RealLiteral | ir.IntLiteral)]
                if any(one >= _UNUSED for one in values) and any(one < _UNUSED for one in values):
                    return True
            case ir.Aggregate(entries=entries) if any(name in _NAMES for name, _ in entries):
                return True
    return False
