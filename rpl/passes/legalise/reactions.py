"""Interrupts known by a number of their own (V+ REACT of a signal), for targets where the priority is that number.

Each gets a priority of its own, in the order of the source's priorities. What stops the motion at once becomes a
routine that brakes first; what comes once only becomes one that switches the interrupt off first.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import edit_bodies, map_body
from rpl.passes.legalise.jumps import inside
from rpl.passes.legalise.support import with_support
from rpl.passes.legalise.usage import called_names, exposed
from rpl.passes.legalise.watching import key_of, number_of

DROPS = code(
    "reaction-drops-motion",
    Severity.WARNING,
    "{name} stops the robot and drops its move; on the target that leaves the routines below the declaration",
    "on the controller, put the watched moves into a routine of their own",
)
_FIRST_PRIORITY = 10  # as passes.interrupts numbers them


def reactions(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with interrupts, and programs that give theirs an identity."""
    can = context.capabilities
    if can.watching_tasks or can.watched_interrupts or not {"DeclareInterrupt", "ConnectInterrupt"} & can.statements:
        return program
    declared = [one for one in walk(*program.modules) if isinstance(one, ir.DeclareInterrupt)]
    drops = not context.capabilities.stopping_reactions
    if not any(one.identity is not None or one.once or (one.stops and drops) for one in declared):
        return program
    if any(number_of(one.priority) is None or key_of(one) is None for one in declared):
        return program  # the writer names what it cannot say
    worker = _Reactions(context)
    worker.number(declared)
    modules = tuple(
        replace(module, routines=tuple(edit_bodies(routine, worker.body) for routine in module.routines))
        for module in program.modules
    )
    if not worker.routines:
        return replace(program, modules=modules)
    done = exposed(replace(program, modules=modules), called_names(worker.routines))
    return with_support(done, context, (), worker.routines, modules[0].task)


def _identity(one: ir.DeclareInterrupt) -> ir.Expression:
    return one.identity if one.identity is not None else one.priority


@dataclass(slots=True)
class _Reactions:
    context: Context
    numbers: dict[int, int] = field(default_factory=dict)  # identity -> priority in the target
    routines: list[ir.Routine] = field(default_factory=list)

    def number(self, declared: list[ir.DeclareInterrupt]) -> None:
        urgency: dict[int, int] = {}
        for one in declared:
            identity, priority = key_of(one), number_of(one.priority)
            assert identity is not None and priority is not None  # the caller has looked
            urgency[identity] = min(priority, urgency.get(identity, priority))
        for place, identity in enumerate(sorted(urgency, key=lambda key: urgency[key])):
            self.numbers[identity] = _FIRST_PRIORITY + place

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.DeclareInterrupt():
                own = ir.IntLiteral(self.numbers[number_of(_identity(statement)) or 0])
                action = self.action(statement, own)
                stops = statement.stops and self.context.capabilities.stopping_reactions
                return (replace(statement, priority=own, identity=None, once=False, stops=stops, action=action),)
            case ir.ControlInterrupt(op=op, handle=handle) if op != "mask" and number_of(handle) in self.numbers:
                own = ir.IntLiteral(self.numbers[number_of(handle) or 0])
                return (replace(statement, handle=own, op="off" if op == "delete" else op),)
        return (inside(statement, self.body),)

    def action(self, declared: ir.DeclareInterrupt, own: ir.Expression) -> ir.CallRoutine | ir.Assign:
        """The action, or a routine around it."""
        first: ir.Body = (ir.ControlInterrupt("off", own),) if declared.once else ()
        stops = declared.stops and not self.context.capabilities.stopping_reactions
        if stops:
            first = (*first, ir.StopMotion(hard=True))
        if not first:
            return declared.action
        leave: ir.Body = (ir.ResumeLevel(),) if stops else ()
        name = self.context.fresh("rpl_reaction")
        if stops:
            called = declared.action.name if isinstance(declared.action, ir.CallRoutine) else "an assignment"
            self.context.diagnostics.report(DROPS, declared.origin, name=called)
        self.routines.append(ir.Routine(name, body=(*first, declared.action, *leave), scope="global"))
        return ir.CallRoutine(name)


__all__ = ["reactions"]
