"""Paths that a program puts aside where the robot stands and nothing of a path is left (RAPID StorePath and RestoPath
in the error handler of a search), for targets without.

There is nothing to keep there: the statements go. In what an interrupt does, and in a program that stops its own
motion, a path may be under way; there they stay for the writer.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.activations import Activations
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import edit_bodies, map_body
from rpl.passes.legalise.jumps import inside


def stored_paths(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such statements."""
    if "StoreMotion" in context.capabilities.statements:
        return program
    if not any(isinstance(one, ir.StoreMotion) for one in walk(program)):
        return program
    facts = Activations.of(program)
    beside: set[int] = set().union(*facts.threads[1:])
    plain = {key for key, routine in facts.routines.items() if key not in beside and routine.kind != "trap"}
    if any(isinstance(one, ir.StopMotion) for key in plain for one in walk(facts.routines[key])):
        return program
    modules = tuple(
        replace(
            module,
            routines=tuple(_without(one) if id(one) in plain else one for one in module.routines),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)


def _without(routine: ir.Routine) -> ir.Routine:
    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.StoreMotion):
            return (ir.Nothing(origin=statement.origin),)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return edit_bodies(routine, lambda body: map_body(body, change))


__all__ = ["stored_paths"]
