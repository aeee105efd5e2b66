"""A routine for all errors of a task (OnError) as error handlers of its routines, for targets without such a statement.

That is the same where the program names one routine that has no data of its own: each routine then gets its body as
handler. Set anywhere but at the very start, or switched off, a flag says whether the handler holds; without it the
error is passed on. Anything else is reported.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.rewriting.editing import edit_all, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope

LOST = code(
    "error-routine-lost",
    Severity.LOSS,
    "from here on errors call {name}; the target has no such routine, and handlers cannot stand for it: {reason}",
)
MOTION = code(
    "error-routine-no-motion",
    Severity.LOSS,
    "{name} is not called here for errors of the robot's motion (a place out of reach, a joint limit): they stop it",
    "ask whether the place can be reached in front of the move",
)
_BEFORE = (ir.Nothing, ir.Assign, ir.Message)


@legalising(sees=("OnError",))
def error_routines(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without OnError, and for programs that raise errors of their own where the target cannot."""
    raised = any(isinstance(one, ir.Raise) for one in walk(*program.modules))
    if "OnError" in context.capabilities.statements and not (raised and "Raise" not in context.capabilities.statements):
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
    reason, always = _reason(program, named), len(found) == 1 and _at_start(program, *named[0])
    homes = {id(routine) for routine, _ in found}
    if not reason and not always:
        reason = _switched_reason(program, homes, named[0][1].routine or "")
    if reason:
        for _, one in named:
            context.diagnostics.report(LOST, one.origin, name=one.routine, reason=reason)
        return program
    if any(isinstance(node, ir.Move) for node in walk(*program.modules)):
        where = next(
            (one for routine, one in named if routine.name.lower() != (one.routine or "").lower()), named[0][1]
        )
        context.diagnostics.report(MOTION, where.origin, name=where.routine)
    if always:
        return _without(_with_handlers(program, named[0][1].routine or ""))
    flag = ir.Name(context.fresh("errors_caught"))
    done = _without(_with_handlers(program, named[0][1].routine or "", flag), flag)
    data = [ir.Variable(flag.id, ir.BoolType(), ir.BoolLiteral(False), scope="global")]
    return with_support(done, context, data, (), program.modules[0].task)


def _reason(program: ir.Program, named: list[tuple[ir.Routine, ir.OnError]]) -> str:
    """Why handlers cannot stand for it; empty when they can."""
    home, statement = named[0]
    if len({(one.routine or "").lower() for _, one in named}) > 1:
        return "several routines take turns"
    module = next(m for m in program.modules if any(r is home for r in m.routines))
    routine = ProgramScope(program).routine(module, home).routine(statement.routine or "")
    if routine is None:
        return "the routine was not read"
    if routine.parameters or any(isinstance(one, ir.Variable) for one in routine.declarations):
        return "the routine has variables of its own"
    if any(r.handlers for m in program.modules for r in m.routines):
        return "there are other handlers"
    return ""


def _at_start(program: ir.Program, home: ir.Routine, statement: ir.OnError) -> bool:
    """Is it set before anything can go wrong, so that it always holds?"""
    facts = Activations.of(program)
    if any(id(home) in callees for callees in facts.calls.values()):
        return False
    for one in home.body:
        if one is statement:
            return True
        if not isinstance(one, _BEFORE):
            return False
    return False


def _switched_reason(program: ir.Program, homes: set[int], name: str) -> str:
    """Why one flag cannot say whether it holds: it belongs to a task, and the flag to all of them."""
    facts = Activations.of(program)
    own, *others = facts.threads or [set()]
    trap = {key for key, routine in facts.routines.items() if routine.name.lower() == name.lower()}
    apart = set().union(*others) if others else set()
    homes = homes - trap  # what it sets itself, it sets while it runs for the errors of the program
    if not homes <= own or homes & (apart - facts.reached(trap)):
        return "it is set by another task or a reaction"
    if any(facts.routines[key].name for key in (own & apart) - facts.reached(trap)):
        return "other tasks or reactions call the same routines"
    return ""


def _with_handlers(program: ir.Program, name: str, flag: ir.Name | None = None) -> ir.Program:
    """With a flag the handlers hold only while it is set, and only in the program's own thread."""
    facts = Activations.of(program)
    reaction = next(r for r in facts.routines.values() if r.name.lower() == name.lower())
    spared = facts.reached({id(reaction)})
    if flag is not None:
        spared |= set(facts.routines) - facts.threads[0]

    def ended(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return):
            return expansion(statement.origin, (ir.Retry(),))
        return (inside(statement, lambda inner: map_body(inner, ended)),)

    body = map_body(reaction.body, ended)
    if not body or not isinstance(body[-1], ir.Retry | ir.TryNext | ir.Halt):
        body = (*body, ir.Retry())
    if flag is not None:
        body = (ir.If(((ir.Unary("not", flag), (ir.Raise(),)),)), *body)
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


def _without(program: ir.Program, flag: ir.Name | None = None) -> ir.Program:
    """The program without the statements that set it; a flag is set there instead."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.OnError):
            if flag is not None:
                return (ir.Assign(flag, ir.BoolLiteral(statement.routine is not None), origin=statement.origin),)
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return edit_all(program, lambda body: map_body(body, change))
