"""Stop watches that a routine has for itself, for targets whose stop watches are data (or timers) of the program.

Such a watch becomes one that lasts from call to call (passes.legalise.statics gives it a place in the module). It is
stopped and set to zero where the routine begins, as it was new in each call, unless the routine does that itself.
A routine that calls itself has several of them at once; its watches stay for the writer.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TypeGuard

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import Local
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Fold, rules_of


@legalising(
    unless=lambda context: (
        Local.CLOCKS in context.capabilities.routines.locals and "ClockType" in context.capabilities.types
    )
)
def clocks_of_routines(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose routines have no stop watches: theirs are data of the program, or numbered timers."""
    recursive = Activations.of(program).recursive
    fold = Fold(rules_of(context.source).case_sensitive)
    modules = tuple(
        replace(
            module,
            routines=tuple(one if id(one) in recursive else _lasting(one, fold) for one in module.routines),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


def _lasting(routine: ir.Routine, fold: Fold) -> ir.Routine:
    own = [one for one in routine.declarations if _is_own_clock(one)]
    if not own:
        return routine
    started: list[ir.Statement] = []
    for one in own:
        name = ir.Name(one.name)
        if not _reset_first(routine, one.name, fold):
            started.extend((ir.Clock("stop", name), ir.Clock("reset", name)))
    declarations = tuple(
        replace(one, storage="persistent") if _is_own_clock(one) else one for one in routine.declarations
    )
    return replace(routine, declarations=declarations, body=(*started, *routine.body))


def _is_own_clock(one: ir.Declaration) -> TypeGuard[ir.Variable]:
    return isinstance(one, ir.Variable) and isinstance(one.type, ir.ClockType) and one.storage == "variable"


def _reset_first(routine: ir.Routine, name: str, fold: Fold) -> bool:
    """Is the watch set to zero and started before anything else happens to it, without a condition?"""
    uses = list(_uses(routine, name, fold))
    return [one.op if isinstance(one, ir.Clock) else "" for one in uses[:2]] == ["reset", "start"] and all(
        any(one is statement for statement in routine.body) for one in uses[:2]
    )


def _uses(routine: ir.Routine, name: str, fold: Fold) -> Iterator[ir.Clock | ir.Name]:
    """Statements on a watch, and where it is read, as they stand in the routine."""
    seen: set[int] = set()
    for node in walk(routine):
        if isinstance(node, ir.Clock) and isinstance(node.clock, ir.Name) and fold(node.clock.id) == fold(name):
            seen.add(id(node.clock))
            yield node
        elif isinstance(node, ir.Name) and fold(node.id) == fold(name) and id(node) not in seen:
            yield node


__all__ = ["clocks_of_routines"]
