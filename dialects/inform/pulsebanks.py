"""Pulses in a bank of positions that a job indexes: variables of their own where no computed index reaches them.

A bank with a computed index is one array. Its elements that hold pulses stand in a second array beside it; nearly
always these are a few with fixed numbers (the present position read in pulses), which need no array.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk

_SUFFIX = "_PULSES"


def without_pulse_banks(program: ir.Program) -> ir.Program:
    """The program with `P_PULSES[3]` as `P003_PULSES`, unless some index of that array is computed."""
    banks = {
        node.name
        for module in program.modules
        for declarations in (module.declarations, *(one.declarations for one in module.routines))
        for node in declarations
        if isinstance(node, ir.Variable) and node.name.endswith(_SUFFIX) and isinstance(node.type, ir.ArrayType)
    }
    if not banks:
        return program
    numbers: dict[str, set[int]] = {name: set() for name in banks}
    whole = dict.fromkeys(banks, 0)
    for node in walk(program):
        match node:
            case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=number),)) if name in banks:
                numbers[name].add(number)
                whole[name] -= 1
            case ir.Name(id=name) if name in banks:
                whole[name] += 1
    plain = {name for name, count in whole.items() if count == 0}
    if not plain:
        return program

    def alone(node: object) -> object:
        match node:
            case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=number),)) if name in plain:
                return ir.Name(_spelled(name, number), origin=node.origin)
            case ir.Module() | ir.Routine() if any(_named(one, plain) for one in node.declarations):
                return replace(node, declarations=_declared(node.declarations, plain, numbers))
        return node

    return rewrite(program, alone)


def _spelled(name: str, number: int) -> str:
    return f"{name.removesuffix(_SUFFIX)}{number:03d}{_SUFFIX}"


def _named(declaration: ir.Declaration, plain: set[str]) -> bool:
    return isinstance(declaration, ir.Variable) and declaration.name in plain


def _declared(
    declarations: tuple[ir.Declaration, ...], plain: set[str], numbers: dict[str, set[int]]
) -> tuple[ir.Declaration, ...]:
    done: list[ir.Declaration] = []
    for one in declarations:
        if isinstance(one, ir.Variable) and one.name in plain:
            assert isinstance(one.type, ir.ArrayType)  # they were chosen so
            element = one.type.element
            done.extend(replace(one, name=_spelled(one.name, at), type=element) for at in sorted(numbers[one.name]))
        else:
            done.append(one)
    return tuple(done)
