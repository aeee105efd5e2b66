"""Interrupts known by a number of their own (V+ REACT of a signal), for targets where the priority is that number.

Each gets a priority of its own, in the order of the source's priorities. What stops the motion at once becomes a
routine that brakes first; what comes once only becomes one that switches the interrupt off first. Where no urgency can
be masked (V+ LOCK), the interrupts that wait are disabled, all of them at once or one by one.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import InterruptRule, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.reach import key_of, number_of
from rpl.passes.legalise.facts.usage import called_names, exposed
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising

DROPS = code(
    "reaction-drops-motion",
    Severity.WARNING,
    "{name} stops the robot and drops its move; on the target that leaves the routines below the declaration",
    "on the controller, put the watched moves into a routine of their own",
)
MASKED = code(
    "interrupt-mask-lost",
    Severity.LOSS,
    "some interrupts are to wait until others may act; the target can only let all of them wait",
    "lock all reactions, or switch the single ones off",
)
QUEUED = code(
    "waiting-interrupts-in-turn",
    Severity.WARNING,
    "interrupts that have waited act in the order in which they came; in the source the most urgent acts first",
)
_FIRST_PRIORITY = 10  # as passes.interrupts numbers them


@legalising(
    unless=lambda context: (
        context.capabilities.interrupts.watched is Watched.ALL
        or context.capabilities.interrupts.watched is Watched.INTERRUPTS
        or not {"DeclareInterrupt", "ConnectInterrupt"} & context.capabilities.statements
    ),
    sees=("DeclareInterrupt",),
)
def reactions(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with interrupts, and programs that give theirs an identity."""
    can = context.capabilities
    declared = [one for one in walk_for({"DeclareInterrupt"}, *program.modules) if isinstance(one, ir.DeclareInterrupt)]
    drops = InterruptRule.STOPPING not in context.capabilities.interrupts.rules
    switched = InterruptRule.ONE_SHOT not in can.interrupts.rules
    if not any(one.identity is not None or (one.once and switched) or (one.stops and drops) for one in declared):
        return program
    if any(number_of(one.priority) is None or key_of(one) is None for one in declared):
        return program  # the writer names what it cannot say
    worker = _Reactions(context)
    worker.number(declared)
    worker.masks(program)
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
    urgency: dict[int, int] = field(default_factory=dict)  # priority in the target -> the source's
    partial: bool = False  # some mask lets only a part of the interrupts wait
    routines: list[ir.Routine] = field(default_factory=list)

    def number(self, declared: list[ir.DeclareInterrupt]) -> None:
        urgency: dict[int, int] = {}
        for one in declared:
            identity, priority = key_of(one), number_of(one.priority)
            assert identity is not None and priority is not None  # the caller has looked
            urgency[identity] = min(priority, urgency.get(identity, priority))
        for place, identity in enumerate(sorted(urgency, key=lambda key: urgency[key])):
            self.numbers[identity] = _FIRST_PRIORITY + place
            self.urgency[_FIRST_PRIORITY + place] = urgency[identity]

    def masks(self, program: ir.Program) -> None:
        for node in walk_for({"ControlInterrupt"}, *program.modules):
            if isinstance(node, ir.ControlInterrupt) and node.op == "mask":
                self.partial = self.partial or 0 < len(self.waiting(node)) < len(self.urgency)

    def waiting(self, mask: ir.ControlInterrupt) -> list[int]:
        """The interrupts that wait behind the mask, by their priorities in the target."""
        level = number_of(mask.handle)
        return [] if level is None else [own for own, urgency in self.urgency.items() if urgency >= level]

    def mask(self, mask: ir.ControlInterrupt) -> ir.Body:
        """What lets the less urgent interrupts wait from here on, the others no longer."""
        can, waiting = self.context.capabilities, self.waiting(mask)
        if mask.handle is not None and number_of(mask.handle) is None:
            return (mask,)  # the writer names what it cannot say
        if InterruptRule.MASKED in can.interrupts.rules:
            return (replace(mask, handle=ir.IntLiteral(min(waiting)) if waiting else None),)
        if 0 < len(waiting) < len(self.urgency) and "DeclareInterrupt" not in can.statements:
            self.context.diagnostics.report(MASKED, mask.origin)
            return (mask,)
        if len(waiting) > 1 and "DeclareInterrupt" not in can.statements:
            self.context.diagnostics.report(QUEUED, mask.origin)
        all_of_them = ir.ControlInterrupt("disable" if len(waiting) == len(self.urgency) else "enable")
        single = self.partial and "DeclareInterrupt" in can.statements and all_of_them.op == "enable"
        steps = [*((("disable" if own in waiting else "enable"), own) for own in sorted(self.urgency) if single)]
        each = [ir.ControlInterrupt(op, ir.IntLiteral(own)) for op, own in steps]
        first, *rest = (*each, all_of_them)
        return (replace(first, origin=mask.origin), *rest)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.DeclareInterrupt():
                own = ir.IntLiteral(self.numbers[number_of(_identity(statement)) or 0])
                action = self.action(statement, own)
                stops = statement.stops and InterruptRule.STOPPING in self.context.capabilities.interrupts.rules
                # What drops the motion leaves down to the level that declared it.
                everywhere = statement.everywhere and (stops or not statement.stops)
                once = statement.once and InterruptRule.ONE_SHOT in self.context.capabilities.interrupts.rules
                done = replace(statement, priority=own, identity=None, once=once, stops=stops, action=action)
                return (replace(done, everywhere=everywhere),)
            case ir.ControlInterrupt(op="mask"):
                return self.mask(statement)
            case ir.ControlInterrupt(op=op, handle=handle) if number_of(handle) in self.numbers:
                own = ir.IntLiteral(self.numbers[number_of(handle) or 0])
                return (replace(statement, handle=own, op="off" if op == "delete" else op),)
        return (inside(statement, self.body),)

    def action(self, declared: ir.DeclareInterrupt, own: ir.Expression) -> ir.CallRoutine | ir.Assign:
        """The action, or a routine around it."""
        once = declared.once and InterruptRule.ONE_SHOT not in self.context.capabilities.interrupts.rules
        first: ir.Body = (ir.ControlInterrupt("off", own),) if once else ()
        stops = declared.stops and InterruptRule.STOPPING not in self.context.capabilities.interrupts.rules
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
