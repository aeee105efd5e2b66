"""Signals as parameters, for targets whose signals have numbers: the number is passed.

`SetDO sig,1` of a parameter `sig` becomes an output whose number is the parameter; a call passes the number of the
signal it names. The first half is done before named signals get their numbers, the second behind it.
Parameters that are groups stay: their number does not tell their width.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import is_expression, rewrite
from rpl.passes.legalise.kinds import walk_for

# By folded name of the routine: folded names and places (from 0) of the parameters that became numbers.
Places = Mapping[str, frozenset[str | int]]


def parameters_as_numbers(program: ir.Program) -> tuple[ir.Program, Places]:
    """The program with numbers for signal parameters, its calls still unchanged, and which parameters these are."""
    places: dict[str, frozenset[str | int]] = {}

    def changed(routine: ir.Routine) -> ir.Routine:
        kinds = dict(_single_signals(routine))
        if not kinds:
            return routine
        numbers = {place for place, one in enumerate(routine.parameters) if one.name.lower() in kinds}
        places[routine.name.lower()] = frozenset({*kinds, *numbers})

        def indexed(node: object) -> object:
            match node:
                case ir.Signal(kind=kind, name=str() as name) if kinds.get(name.lower()) == kind:
                    return replace(node, name=None, index=ir.Name(name, origin=node.origin))
                case ir.Parameter(name=name) if name.lower() in kinds:
                    return replace(node, type=ir.IntType(), mode="value")
            return node

        return rewrite(routine, indexed)

    modules = tuple(
        replace(module, routines=tuple(changed(routine) for routine in module.routines)) for module in program.modules
    )
    return (replace(program, modules=modules), places) if places else (program, places)


def numbers_as_arguments(program: ir.Program, places: Places) -> ir.Program:
    """The calls of those routines pass the numbers."""
    if not places:
        return program
    declared = {
        node.name.lower(): node.signal
        for node in walk_for({"SignalDeclaration"}, *program.modules)
        if isinstance(node, ir.SignalDeclaration)
    }

    def passed(node: object) -> object:
        match node:
            case (
                ir.Call(name=str() as name, arguments=arguments)
                | ir.CallRoutine(name=str() as name, arguments=arguments)
            ):
                chosen = places.get(name.lower())
                if chosen:
                    return replace(
                        node,
                        arguments=tuple(
                            _numbered(one, declared) if _key(one, place) in chosen else one
                            for place, one in enumerate(arguments)
                        ),
                    )
        return node

    return rewrite(program, passed)


def _single_signals(routine: ir.Routine) -> Iterator[tuple[str, str]]:
    for one in routine.parameters:
        if isinstance(one.type, ir.SignalType) and not one.type.kind.startswith("group"):
            yield one.name.lower(), one.type.kind


def _key(argument: ir.Argument, place: int) -> str | int:
    return place if argument.name is None else argument.name.lower()


def _numbered(argument: ir.Argument, declared: Mapping[str, ir.Signal]) -> ir.Argument:
    value = argument.value
    while isinstance(value, ir.Convert):
        value = value.operand
    if isinstance(value, ir.Name):
        value = declared.get(value.id.lower())
    if isinstance(value, ir.Signal) and value.last is None and is_expression(value.index):
        return replace(argument, value=value.index)
    return argument
