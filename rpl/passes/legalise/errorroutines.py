"""A routine for all errors of a task (OnError) as error handlers of its routines, for targets without such a statement.

That is the same where the program names one routine, at its very start, and that routine has no data of its own: each
routine then gets its body as handler. Anything else is reported.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.activations import Activations
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import edit_bodies, expansion, map_body
from rpl.passes.legalise.effects import statements_in
from rpl.passes.legalise.jumps import inside
from rpl.passes.legalise.usage import bodies
from rpl.passes.scope import ProgramScope

LOST = code(
    "error-routine-lost",
    Severity.LOSS,
    "from here on errors call {name}; the target has no such routine, and handlers cannot stand for it: {reason}",
)
_BEFORE = (ir.Nothing, ir.Assign, ir.Message)


def error_routines(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without OnError."""
    if "OnError" in context.capabilities.statements:
        return program
    found = [
        (routine, one)
        for module in program.modules
        for routine in module.routines
        for body in bodies(routine)
        for one in statements_in(body)
        if isinstance(one, ir.OnError)
    ]
    if not found:
        return program
    named = [(routine, one) for routine, one in found if one.routine is not None]
    if not named:
        return _without(program)  # there is nothing to switch off
    reason = _reason(program, named, len(found))
    if reason:
        for _, one in named:
            context.diagnostics.report(LOST, one.origin, name=one.routine, reason=reason)
        return program
    return _without(_with_handlers(program, named[0][1].routine or ""))


def _reason(program: ir.Program, named: list[tuple[ir.Routine, ir.OnError]], count: int) -> str:
    """Why handlers cannot stand for it; empty when they can."""
    home, statement = named[0]
    if len(named) > 1 or count > 1:
        return "it is set or switched off more than once"
    facts = Activations.of(program)
    if any(id(home) in callees for callees in facts.calls.values()):
        return "it is not set by the program's first routine"
    for one in home.body:
        if one is statement:
            break
        if not isinstance(one, _BEFORE):
            return "it is not set at the start"
    else:
        return "it is not set at the start"
    module = next(m for m in program.modules if any(r is home for r in m.routines))
    routine = ProgramScope(program).routine(module, home).routine(statement.routine or "")
    if routine is None:
        return "the routine was not read"
    if routine.parameters or any(isinstance(one, ir.Variable) for one in routine.declarations):
        return "the routine has variables of its own"
    if any(r.handlers for m in program.modules for r in m.routines):
        return "there are other handlers"
    return ""


def _with_handlers(program: ir.Program, name: str) -> ir.Program:
    facts = Activations.of(program)
    reaction = next(r for r in facts.routines.values() if r.name.lower() == name.lower())
    spared = facts.reached({id(reaction)})

    def ended(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return):
            return expansion(statement.origin, (ir.Retry(),))
        return (inside(statement, lambda inner: map_body(inner, ended)),)

    body = map_body(reaction.body, ended)
    if not body or not isinstance(body[-1], ir.Retry | ir.TryNext | ir.Halt):
        body = (*body, ir.Retry())
    handler = ir.Handler((), body, origin=reaction.origin)

    def routine(one: ir.Routine) -> ir.Routine:
        return one if id(one) in spared or one.open_ended else replace(one, handlers=(handler,))

    modules = tuple(
        replace(module, routines=tuple(routine(one) for one in module.routines if one is not reaction))
        if not _called(facts, reaction)
        else replace(module, routines=tuple(map(routine, module.routines)))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _called(facts: Activations, routine: ir.Routine) -> bool:
    return any(id(routine) in callees for callees in facts.calls.values())


def _without(program: ir.Program) -> ir.Program:
    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.OnError):
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        return (inside(statement, lambda inner: map_body(inner, change)),)

    modules = tuple(
        replace(
            module,
            routines=tuple(edit_bodies(one, lambda body: map_body(body, change)) for one in module.routines),
        )
        for module in program.modules
    )
    return replace(program, modules=modules)
