"""Registers: which position registers hold one value all the time, and which numbers nothing has."""

from __future__ import annotations

from collections.abc import Mapping

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Bank
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.scope import ProgramScope, Scope
from rpl.writing.statements import CannotSayError

from .. import tables
from ..frames import constant_pose


def kept_registers(program: ir.Program) -> dict[int, tuple[float, ...]]:
    """Position registers that are set once, to a constant pose: x, y, z, a, b, c (mm, deg)."""
    values: dict[int, list[tuple[float, ...] | None]] = {}
    scopes = ProgramScope(program)
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            points = {one.name: one.initial for one in routine.declarations if isinstance(one, ir.Variable)}
            for node in walk(routine):
                if not isinstance(node, ir.Assign):
                    continue
                match node.target:
                    case ir.Index(base=ir.Name(id="PR"), indices=(ir.IntLiteral(value=number),)):
                        values.setdefault(number, []).append(_kept(node.value, points, scope))
                    case ir.Field(base=ir.Index(base=ir.Name(id="PR"), indices=(ir.IntLiteral(value=number),))):
                        values.setdefault(number, []).append(None)
                    case ir.Index(base=ir.Name(id="PR")) | ir.Field(base=ir.Index(base=ir.Name(id="PR"))):
                        return {}
    return {number: found[0] for number, found in values.items() if len(found) == 1 and found[0] is not None}


def _kept(value: ir.Expression, points: Mapping[str, ir.Expression | None], scope: Scope) -> tuple[float, ...] | None:
    given = points.get(value.id) if isinstance(value, ir.Name) else value
    try:
        return None if given is None else constant_pose(given, scope)
    except CannotSayError:
        return None


def highest_free_registers(program: ir.Program, names: Mapping[tuple[str, int], str]) -> tuple[int, int]:
    """Two position registers that nothing has, from the top."""
    free = free_numbers(program, names, tables.PR)
    return (free[0], free[1]) if len(free) > 1 else (tables.PR.last, tables.PR.last - 1)


def free_numbers(program: ir.Program, names: Mapping[tuple[str, int], str], bank: Bank) -> list[int]:
    """Numbers of a bank that no statement and no name (of data that is chosen at run time) has, from the top; those
    behind it where it is full, as for a program that needs a larger bank."""
    used = {number for kind, number in names if kind == bank.name}
    for node in walk_for({"Index", "Name", "For", "Variable"}, program):
        match node:
            case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=number),)) if name.upper() == bank.name:
                used.add(number)
            case ir.Name(id=name) | ir.For(counter=name) | ir.Variable(name=name):
                prefix, digits = name[: len(bank.name)], name[len(bank.name) :]
                if prefix.upper() == bank.name and digits.isdigit():
                    used.add(int(digits))
    free = [number for number in range(bank.last, bank.first - 1, -1) if number not in used]
    highest = max(used, default=0)
    if len(free) > 1 or highest <= bank.last:
        return free
    return [*free, highest + 1, highest + 2]
