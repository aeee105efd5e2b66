"""Names of signals as data with their numbers, `GRIPPER = 3` at the head, for targets whose signals have numbers alone.

Their programmers name signals so; the opposite way is `source/signalwords.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.passes.scope import Scope

_Ranges = Mapping[str, tuple[tuple[int, int, int], ...]]


@legalising(unless=lambda context: not context.capabilities.io.number_data, sees=("SignalDeclaration",))
def named_numbers(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that have such data. What declares a signal that nothing uses stays a declaration."""
    ranges = context.capabilities.io.number_data
    names = _names(program)
    used: set[str] = set()

    def change(node: object, scope: Scope) -> object:
        signal = node if isinstance(node, ir.Signal) else _declared(node, scope)
        declared = None if signal is None else names.get((signal.kind, _number(signal)))
        added = None if declared is None else _added(declared.signal, ranges)
        if signal is None or declared is None or added is None:
            return node
        used.add(declared.name)
        context.signal_groups.setdefault(declared.name, declared.signal)
        return replace(signal, index=_less(ir.Name(declared.name), added))

    scopes, modules = ProgramScope(program), []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            routines.append(rewrite(routine, partial(change, scope=scope)))
        modules.append(changed(module, routines=tuple(routines)))
    if not used:
        return program
    done = [changed(one, declarations=tuple(_data(d, ranges, used) for d in one.declarations)) for one in modules]
    return changed(program, modules=tuple(done))


def _names(program: ir.Program) -> dict[tuple[str, int], ir.SignalDeclaration]:
    """The first declaration of a single signal that the whole program may name, by kind and number."""
    found: dict[tuple[str, int], ir.SignalDeclaration] = {}
    for module in program.modules:
        for one in module.declarations:
            if isinstance(one, ir.SignalDeclaration) and (number := _number(one.signal)):
                found.setdefault((one.signal.kind, number), one)
    return found


def _number(signal: ir.Signal) -> int:
    """Of a single signal by a constant number; else 0."""
    return signal.index.value if signal.last is None and isinstance(signal.index, ir.IntLiteral) else 0


def _declared(node: object, scope: Scope) -> ir.Signal | None:
    symbol = scope.value(node.id) if isinstance(node, ir.Name) else None
    if symbol is None or not isinstance(symbol.declaration, ir.SignalDeclaration):
        return None
    return symbol.declaration.signal


def _added(signal: ir.Signal, ranges: _Ranges) -> int | None:
    """What the data has more than the signal's number."""
    number = _number(signal)
    return next((more for first, last, more in ranges.get(signal.kind, ()) if first <= number <= last), None)


def _less(value: ir.Expression, added: int) -> ir.Expression:
    if not added:
        return value
    return ir.Binary("-" if added > 0 else "+", value, ir.IntLiteral(abs(added)))


def _data(one: ir.Declaration, ranges: _Ranges, used: set[str]) -> ir.Declaration:
    if not isinstance(one, ir.SignalDeclaration) or one.name not in used:
        return one
    added = _added(one.signal, ranges)
    if added is None:
        return one
    number = ir.IntLiteral(_number(one.signal) + added)
    return ir.Variable(one.name, ir.IntType(), number, storage="constant", scope=one.scope, origin=one.origin)


__all__ = ["named_numbers"]
