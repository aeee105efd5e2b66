"""Loads that a program keeps in variables of its language (`$LOAD`), which are plain data to another controller.

What such a variable gets is the load that the arm drives with. Other controllers keep theirs elsewhere, so the load is
named with its mass for somebody to set it there. The loads of tools (`LOAD_DATA`) are in force with the number of the
tool; they are named where the program puts no load in force itself.
"""

from __future__ import annotations

from functools import partial

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name, each_statement
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope, rules_of
from rpl.passes.values import Record

LEFT = code(
    "load-left-out",
    Severity.WARNING,
    "{name} is the load that the arm drives with ({mass}); to the target's controller it is plain data",
    "set the load on the target's controller, or in the data of its tool",
)


@legalising()
def load_variables(program: ir.Program, context: Context) -> ir.Program:
    """The program as it is; only loads of sources whose load is a variable are reported."""
    names = rules_of(context.source).load_variables
    if names is None:
        return program
    scopes, unchanged = ProgramScope(program), unchanged_in(program)
    own = names.variable.lower() in unchanged.assigned
    name, path = names.variable if own else names.table, names.components["mass"]

    def look(statement: ir.Statement, scope: Scope) -> None:
        if not isinstance(statement, ir.Assign) or base_name(statement.target) != name.lower():
            return
        if _path(statement.target) not in ("", path):
            return  # the centre or an inertia; the load is named where it gets its mass
        mass = _number(statement, path, scope, unchanged)
        if (own and mass is None) or (mass is not None and mass > 0.0):
            said = "a mass that is computed" if mass is None else f"{mass:g} kg"
            context.diagnostics.report(LEFT, statement.origin, name=name, mass=said)

    for module in program.modules:
        for declaration in module.declarations:
            if isinstance(declaration, ir.Initialise):
                look(declaration.assign, scopes.module(module))
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for body in bodies(routine):
                each_statement(body, partial(look, scope=scope))
    return program


def _path(target: ir.Expression) -> str:
    """The component that is assigned, `a.b` folded; empty for a whole load."""
    parts: list[str] = []
    while isinstance(target, ir.Field):
        parts.insert(0, target.name.lower())
        target = target.base
    return ".".join(parts)


def _number(assign: ir.Assign, path: str, scope: Scope, unchanged: Unchanged) -> float | None:
    """The component `a.b` that an assignment of a load, or of a part of it, sets to a constant."""
    given, part = assign.value, _path(assign.target)
    if part and part != path:
        return None
    rest = [] if part else path.split(".")
    while rest and isinstance(given, ir.Aggregate):
        name = rest.pop(0)
        entries = {(key or "").lower(): value for key, value in given.entries}
        if name not in entries:
            return None
        given = entries[name]
    value = constant(given, scope, unchanged)
    for name in rest:
        value = value.part(name) if isinstance(value, Record) else None
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


__all__ = ["load_variables"]
