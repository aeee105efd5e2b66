"""Signals of the end of the arm (RI, RO) by their names: a signal that is called RO2 elsewhere, or that a variable or a
declaration of that name says, is RO[2] here, and no DO."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

from .. import tables


@legalising(unless=lambda context: not context.foreign, sees=("SignalDeclaration",))
def own_words(program: ir.Program, context: Context) -> ir.Program:
    """What is declared as RI2 or RO2 is the controller's own signal of that word; `number_signals` leaves it."""
    declared = (one for one in walk_for({"SignalDeclaration"}, *program.modules))
    words = {
        one.name.lower(): own
        for one in declared
        if isinstance(one, ir.SignalDeclaration) and (own := _own(one)) is not None
    }
    if not words:
        return program
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            work = partial(_with_words, words=words, scope=scopes.routine(module, routine))
            routines.append(edit_bodies(routine, work))
        modules.append(changed(module, routines=tuple(routines)))
    return changed(program, modules=tuple(modules))


def _own(one: ir.SignalDeclaration) -> ir.Signal | None:
    kind = tables.OWN_SIGNALS.get(one.name.lower(), "")
    single = one.signal.last is None and one.signal.kind == kind
    return ir.Signal(kind, name=one.name.upper()) if kind and single else None


def _with_words(body: ir.Body, words: Mapping[str, ir.Signal], scope: Scope) -> ir.Body:
    def expression(one: ir.Expression) -> ir.Expression:
        if isinstance(one, ir.Name) and (own := words.get(one.id.lower())) is not None:
            symbol = scope.value(one.id)
            if symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration):
                return ir.Signal(own.kind, name=own.name, origin=one.origin)
        return rewrite_parts(one, expression)

    def inner(statements: ir.Body) -> ir.Body:
        return map_body(statements, lambda one: (rewrite_parts(one, expression, inner),), {"Name"})

    return inner(body)
