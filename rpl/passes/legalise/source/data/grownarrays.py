"""Arrays of controllers where arrays grow as they are used (V+), for targets that keep data under numbers.

The reader's guess of their size is for a run; numbers of a controller are few. What the other data leaves is shared out
among them, and the size that each gets is told.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from math import prod

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Bank
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising

SIZED = code(
    "array-size-chosen",
    Severity.WARNING,
    "{name} grows as it is used in the source; here it has {count} elements (last index {last})",
    "check that the program needs no more of them: what lies behind them belongs to other data",
)
_MOST = 50  # elements along a dimension that grows, where there is room
_SPARE = 5  # this part of a bank is left for what the passes need themselves


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def grown_arrays(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with banks."""
    banks = context.capabilities.storage.banks
    fixed, grown = _data(program, banks)
    if not grown:
        return program
    bounds: dict[int, ir.ArrayType] = {}
    for bank, some in grown.items():
        room = (bank.last - bank.first + 1) * (_SPARE - 1) // _SPARE - fixed[bank.name]
        for one in some:
            type = one.type
            assert isinstance(type, ir.ArrayType)  # the caller has looked
            bounds[id(one)] = sized = _sized(type, room // len(some))
            last = ", ".join(str(_number(bound)) for bound in sized.dimensions)
            context.diagnostics.report(SIZED, one.origin, name=one.name, count=_count(sized), last=last)

    def declared(one: ir.Declaration) -> ir.Declaration:
        sized = bounds.get(id(one))
        return replace(one, type=sized) if sized is not None and isinstance(one, ir.Variable) else one

    modules = tuple(
        replace(
            module,
            declarations=tuple(map(declared, module.declarations)),
            routines=tuple(
                replace(one, declarations=tuple(map(declared, one.declarations))) for one in module.routines
            ),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


def _data(program: ir.Program, banks: Mapping[str, Bank]) -> tuple[dict[str, int], dict[Bank, list[ir.Variable]]]:
    """How many numbers of each bank the data of known size needs, and the variables that grow."""
    fixed, grown = defaultdict[str, int](int), defaultdict[Bank, list[ir.Variable]](list)
    for module in program.modules:
        for one in (*module.declarations, *(own for routine in module.routines for own in routine.declarations)):
            if not isinstance(one, ir.Variable):
                continue
            element = one.type.element if isinstance(one.type, ir.ArrayType) else one.type
            bank = banks.get(type(element).__name__)
            if bank is None:
                continue
            if isinstance(one.type, ir.ArrayType) and one.type.grows:
                grown[bank].append(one)
            else:
                fixed[bank.name] += _count(one.type) if isinstance(one.type, ir.ArrayType) else 1
    return fixed, grown


def _sized(type: ir.ArrayType, room: int) -> ir.ArrayType:
    """The array with as many elements as there is room for, but no fewer than are known to be used."""
    least = dict(type.grows)
    others = prod(_number(bound) - type.base + 1 for at, bound in enumerate(type.dimensions) if at not in least)
    each = int((max(room, 0) / max(others, 1)) ** (1 / len(least)))
    along = min(each, _MOST)
    dimensions = tuple(
        ir.IntLiteral(max(least[at], type.base + along - 1)) if at in least else bound
        for at, bound in enumerate(type.dimensions)
    )
    return replace(type, dimensions=dimensions)


def _number(bound: ir.Expression | None) -> int:
    return bound.value if isinstance(bound, ir.IntLiteral) else 0


def _count(type: ir.ArrayType) -> int:
    return prod(_number(bound) - type.base + 1 for bound in type.dimensions)


__all__ = ["grown_arrays"]
