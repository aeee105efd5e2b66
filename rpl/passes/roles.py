"""What a program uses its data for, where that tells what a datum without a value may be.

A position register to which a move goes, itself or by way of copies and sums, stands for a place of the arm; any other
for a shift or a frame, which may be zero. A number that says which element of an array is meant, or from which one is
worked out, is taken for the first of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import bodies, walk


@dataclass(frozen=True, slots=True)
class Roles:
    """Names of variables, folded; an array counts as one. `goals` of moves, `indices` of arrays."""

    goals: frozenset[str] = frozenset()
    indices: frozenset[str] = frozenset()


def roles_of(program: ir.Program) -> Roles:
    """By all routines of the program."""
    found: set[str] = set()
    indices: set[str] = set()
    copies: list[tuple[str, str]] = []
    counts: list[tuple[str, set[str]]] = []
    for module in program.modules:
        for routine in module.routines:
            for node in walk(*bodies(routine)):
                match node:
                    case ir.Move(target=target, via=via, relative=None):
                        found |= {_root(target), _root(via) if via is not None else ""}
                    case ir.Assign(target=ir.Name() | ir.Index() as target, value=value):
                        copies.append((_root(target), _root(value)))
                        counts.append((last_name(target), set(_numbers(value))))
                    case ir.Index(indices=numbers):
                        indices |= {name for one in numbers for name in _numbers(one)}
    before = -1
    while len(found) != before:
        before = len(found)
        found |= {taken for given, taken in copies if given in found}
    before = -1
    while len(indices) != before:
        before = len(indices)
        indices |= {name for given, taken in counts if given in indices for name in taken}
    return Roles(frozenset(found - {""}), frozenset(indices - {""}))


def _root(place: ir.Expression) -> str:
    """The variable that a place begins with: of a sum or a composed place its first part."""
    match place:
        case ir.Name(id=name):
            return name.lower()
        case ir.Index(base=base) | ir.Field(base=base):
            return _root(base)
        case ir.Binary(left=left):
            return _root(left)
        case ir.Convert(operand=operand):
            return _root(operand)
        case ir.Builtin(arguments=(first, *_)):
            return _root(first)
    return ""


def _numbers(value: ir.Expression) -> Iterator[str]:
    """The data that a number is worked out from."""
    match value:
        case ir.Binary(op="+" | "-" | "*", left=left, right=right):
            yield from _numbers(left)
            yield from _numbers(right)
        case ir.Name() | ir.Field() | ir.Index():
            yield last_name(value)
        case ir.Convert(operand=operand):
            yield from _numbers(operand)


def last_name(place: ir.Expression) -> str:
    """The name of the datum that a place means: of a component its own, else that of the variable."""
    match place:
        case ir.Name(id=name) | ir.Field(name=name):
            return name.lower()
        case ir.Index(base=base):
            return last_name(base)
        case ir.Convert(operand=operand):
            return last_name(operand)
    return ""


__all__ = ["Roles", "last_name", "roles_of"]
