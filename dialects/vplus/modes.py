"""Which parameters of V+ programs may just as well be passed by value.

V+ passes variables by reference. Where a program never stores into a parameter, and nothing else can store into what
was passed while it runs, passing the value means the same and is what people write in other languages. Arrays and
parameters that are asked for with DEFINED stay references.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk

from .blocks import ProgramPart
from .expressions import root_name, significant
from .inference import Symbol, Symbols


def by_value(programs: dict[str, ProgramPart], symbols: Symbols) -> frozenset[Symbol]:
    """The parameters that can be values."""
    if not any(part.header.parameters for part in programs.values()):
        return frozenset()
    nodes = {key: list(walk(part.body)) for key, part in programs.items()}
    if any(
        isinstance(node, ir.TaskControl | ir.DeclareInterrupt | ir.OnError) for all in nodes.values() for node in all
    ):
        return frozenset()  # another task or a reaction may store into it meanwhile
    stored = {key: _stored(key, all, symbols) for key, all in nodes.items()}
    calls = [
        (key, node)
        for key, all in nodes.items()
        for node in all
        if isinstance(node, ir.CallRoutine) and significant(node.name) in programs
    ]
    changes = _closure(stored, calls, programs)
    candidates = {
        (key, significant(name))
        for key, part in programs.items()
        for name, count in part.header.parameters
        if not count and (key, significant(name)) not in changes[key]
    }
    parameters = {(key, significant(name)) for key, part in programs.items() for name, _ in part.header.parameters}
    before = -1
    while before != len(candidates):
        before = len(candidates)
        for key, call in calls:
            callee = significant(call.name)
            passed = _passed(symbols, key, call, programs[callee])
            for parameter, symbol in passed:
                if parameter not in candidates:
                    candidates.discard(symbol)
                elif _changed_meanwhile(parameter, symbol, passed, changes[callee], parameters - candidates):
                    candidates.discard(parameter)
    if any(isinstance(node, ir.CallRoutine) and node.dynamic is not None for all in nodes.values() for node in all):
        return frozenset()
    return frozenset(candidates)


def _passed(symbols: Symbols, key: str, call: ir.CallRoutine, part: ProgramPart) -> list[tuple[Symbol, Symbol]]:
    """Parameter and symbol of each argument that is a variable, an element or an array."""
    callee = significant(call.name)
    return [
        ((callee, significant(name)), symbols.symbol(key, given))
        for (name, _), argument in zip(part.header.parameters, call.arguments, strict=False)
        if (given := root_name(argument.value)) is not None
    ]


def _changed_meanwhile(
    parameter: Symbol,
    symbol: Symbol,
    passed: list[tuple[Symbol, Symbol]],
    changes: set[Symbol],
    references: set[Symbol],
) -> bool:
    """May a program that changes `changes` store into what it gets as `parameter`: by the variable's own name, or by
    another parameter that stands for the same variable or array? What the caller itself has by reference may be any
    variable."""
    others = [(other, given) for other, given in passed if other != parameter and other in changes]
    if symbol in references:
        return bool(others) or any(not place for place, _ in changes)
    if any(given == symbol or (given in references and not symbol[0]) for _, given in others):
        return True
    return not symbol[0] and symbol in changes


def _stored(key: str, nodes: list[object], symbols: Symbols) -> set[Symbol]:
    """What a program stores into by itself, or asks for with DEFINED."""
    found: set[Symbol] = set()
    for node in nodes:
        name: str | None = None
        match node:
            case ir.Assign(target=target):
                name = root_name(target)
            case ir.For(counter=counter):
                name = counter
            case ir.Dialog(answer=answer):
                name = root_name(answer)
            case ir.Builtin(function="is_uninitialised", arguments=(asked,)):
                name = root_name(asked)
            case ir.Vendor(text=text):
                words = "".join(sign if sign.isalnum() or sign in "._$#%" else " " for sign in text).split()
                found.update(symbols.symbol(key, word) for word in words)
        if name is not None:
            found.add(symbols.symbol(key, name))
    return found


def _closure(
    stored: dict[str, set[Symbol]], calls: list[tuple[str, ir.CallRoutine]], programs: dict[str, ProgramPart]
) -> dict[str, set[Symbol]]:
    """What each program and everything it calls stores into, arguments of the calls included."""
    changes = {key: set(found) for key, found in stored.items()}
    grown = True
    while grown:
        grown = False
        for key, call in calls:
            callee = significant(call.name)
            new = {symbol for symbol in changes[callee] if not symbol[0]} - changes[key]
            for (name, _), argument in zip(programs[callee].header.parameters, call.arguments, strict=False):
                given = root_name(argument.value)
                if given is not None and (callee, significant(name)) in changes[callee]:
                    new |= {("", significant(given)), (key, significant(given))} - changes[key]
            if new:
                changes[key] |= new
                grown = True
    return changes


__all__ = ["by_value"]
