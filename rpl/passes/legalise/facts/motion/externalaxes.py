"""External axes that a program has places for but does not use: their values stand at 9E9, and nothing needs them."""

from __future__ import annotations

from collections.abc import Iterable

from rpl import ir
from rpl.passes.fold import constant
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.scope import Scope

_UNUSED = 9e8  # an external axis that a target does not use stands at 9E9
AXES = tuple(ir.COMPONENTS[ir.ExternalType])
_NAMES = frozenset(AXES)


def is_unused(value: ir.Expression, scope: Scope) -> bool:
    known = constant(value, scope)
    return isinstance(known, int | float) and abs(known) >= _UNUSED


def used_externals(program: ir.Program) -> int:
    """How many external axes places of the program move: up to the last that one sends away from zero."""
    last = 0
    for node in walk_for({"Aggregate"}, *program.modules):
        for name, value in node.entries if isinstance(node, ir.Aggregate) else ():
            if name in _NAMES and not is_nothing(value):
                last = max(last, AXES.index(name) + 1)
    return last


def leading(numbers: Iterable[int], count: int) -> int:
    """How many of so many external axes are these, from the first on; 0 where they are not the first ones."""
    found = sorted(numbers)
    return min(len(found), count) if found == list(range(1, len(found) + 1)) else 0


def is_nothing(value: ir.Expression) -> bool:
    """Is it written as zero, or as an axis that is not there?"""
    if isinstance(value, ir.Unary):
        return is_nothing(value.operand)
    return isinstance(value, ir.IntLiteral | ir.RealLiteral) and (value.value == 0 or abs(value.value) >= _UNUSED)


def has_external_axes(program: ir.Program) -> bool:
    """Does the program look at a single external axis, move one, or give a target a place for one?"""
    cleared: set[int] = set()  # components that are only said to be unused
    for node in walk_for({"Assign"}, *program.modules):
        match node:
            case ir.Assign(target=target, value=ir.RealLiteral(value=set_to)) if abs(set_to) >= _UNUSED:
                cleared.add(id(target))
    for node in walk_for({"MoveExternal", "Field", "Aggregate"}, *program.modules):
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
