"""Settings that a program takes from a register of the controller whose value stands in no file of the project.

A run begins such a register at zero. Where zero is no value that the controller takes for that setting (an override of
0 %), a run would end at the first statement of most programs for want of a file; so the setting stays as it was there,
which is said. A register that anything in the project sets is left alone, and so is what a cell file gives.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.kept import kept_values
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import rules_of

SETTING_LEFT = code(
    "kept-setting-unknown",
    Severity.WARNING,
    "the {setting} is taken from {name}, whose value stands on the controller only: it stays as it was",
    "add the controller's file with the values to the project, or give the value in the cell file:"
    ' [variables] "{path}" = ...',
)


def settings_as_they_were(program: ir.Program, known: ir.Program, diagnostics: Diagnostics) -> ir.Program:
    """The program for a run without the statements that would set what nobody knows; each is reported. known: the same
    program with what a cell file gives."""
    kept = kept_values(known)
    given = _set(program, kept) if kept else frozenset()
    unset = {key: names for key, names in kept.items() if key not in given}
    if not unset:
        return program
    return replace(program, modules=tuple(_left(module, unset, diagnostics) for module in program.modules))


def _left(module: ir.Module, unset: dict[str, tuple[str, str]], diagnostics: Diagnostics) -> ir.Module:
    leaving = _Leaving(unset, module.dialect, diagnostics)
    return replace(module, routines=tuple(leaving.routine(one) for one in module.routines))


def _set(program: ir.Program, kept: Iterable[str]) -> frozenset[str]:
    """Keys of kept values that something sets; with a computed number all of the list."""
    found: set[str] = set()
    lists: set[str] = set()
    for module in program.modules:
        for routine in module.routines:
            for node in walk(*bodies(routine)):
                for name in _written(node):
                    (lists if name.endswith("[") else found).add(name)
    return frozenset(found | {key for key in kept if key.partition("[")[0] + "[" in lists})


def _written(node: object) -> Iterator[str]:
    """What a node may set: an assignment its target; a call whatever it is given."""
    match node:
        case ir.Assign(target=target):
            places: tuple[ir.Expression, ...] = (target,)
        case ir.CallRoutine(arguments=arguments) | ir.Call(arguments=arguments):
            places = tuple(one.value for one in arguments if one.value is not None)
        case ir.For(counter=str(counter)):
            yield counter.lower()
            return
        case _:
            return
    for place in places:
        key = _key(place)
        if key is not None:
            yield key
        elif isinstance(place, ir.Index) and isinstance(place.base, ir.Name):
            yield f"{place.base.id.lower()}["


def _key(place: ir.Expression) -> str | None:
    match place:
        case ir.Name(id=name):
            return name.lower()
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)):
            return f"{name.lower()}[{at}]"
    return None


@dataclass(frozen=True, slots=True)
class _Leaving:
    unset: dict[str, tuple[str, str]]
    language: str
    diagnostics: Diagnostics

    def routine(self, routine: ir.Routine) -> ir.Routine:
        handlers = tuple(replace(one, body=self.body(one.body)) for one in routine.handlers)
        return replace(routine, body=self.body(routine.body), handlers=handlers)

    def body(self, body: ir.Body) -> ir.Body:
        return tuple(self.statement(rewrite_bodies(one, self.body)) for one in body)

    def statement(self, statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.Assign(target=ir.System(name=setting), value=value):
                names = self.unset.get(_key(_bare(value)) or "")
                allowed = rules_of(self.language).inputs.range_of(setting)
                if names is not None and allowed is not None and not allowed.holds(0.0):
                    word = setting.replace("_", " ")
                    self.diagnostics.report(SETTING_LEFT, statement.origin, setting=word, name=names[0], path=names[1])
                    return ir.Nothing(origin=statement.origin)
        return statement


def _bare(value: ir.Expression) -> ir.Expression:
    """Without the conversions that a reader puts around a register."""
    while isinstance(value, ir.Convert):
        value = value.operand
    return value


__all__ = ["settings_as_they_were"]
