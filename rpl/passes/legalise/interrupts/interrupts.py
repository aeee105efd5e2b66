"""Interrupts by identity with trap routines (RAPID) as interrupts by priority (KRL).

What a target's interrupts cannot watch is left as it is for the writer to report.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.capabilities import InterruptRule, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name, called_names, each_statement, exposed
from rpl.passes.legalise.interrupts.changes import watched_changes
from rpl.passes.legalise.interrupts.identities import one_meaning_each, one_name_each
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

_FIRST_PRIORITY = 10  # KRL allows 1..39 and 81..128; the lower ones are left to the user


@legalising(
    unless=lambda context: (
        "ConnectInterrupt" in context.capabilities.statements
        or "DeclareInterrupt" not in context.capabilities.statements
    )
)
def interrupts(program: ir.Program, context: Context) -> ir.Program:
    """Interrupts by identity as interrupts by priority, for targets that have those alone."""
    program = one_name_each(watched_changes(program, context), context)
    kept = one_meaning_each(program, context)
    return _Priorities(kept, context).program(refused=kept is not program)


@dataclass(slots=True)
class _Priorities:
    source: ir.Program
    context: Context
    routine_of: dict[str, str] = field(default_factory=dict)
    priority_of: dict[str, int] = field(default_factory=dict)
    once: dict[str, str] = field(default_factory=dict)
    timer_of: dict[str, int] = field(default_factory=dict)
    made: list[ir.Routine] = field(default_factory=list)

    def program(self, refused: bool) -> ir.Program:
        """refused: some of the names that were interrupts are none any more."""

        def find(statement: ir.Statement) -> None:
            if isinstance(statement, ir.ConnectInterrupt):
                name = base_name(statement.handle)
                if name is not None:
                    self.routine_of.setdefault(name, statement.routine)
                    self.priority_of.setdefault(name, _FIRST_PRIORITY + len(self.priority_of))

        for module in self.source.modules:
            for routine in module.routines:
                for body in bodies(routine):
                    each_statement(body, find)
        if not self.routine_of and not refused:
            return self.source
        program = edit_all(self.source, self.body)
        modules = []
        for module in program.modules:
            routines = tuple(
                replace(
                    routine,
                    declarations=_without_handles(routine.declarations),
                    kind="procedure" if routine.kind == "trap" else routine.kind,
                    scope="global" if routine.kind == "trap" else routine.scope,
                )
                for routine in module.routines
            )
            modules.append(replace(module, declarations=_without_handles(module.declarations), routines=routines))
        program = replace(program, modules=tuple(modules))
        if not self.made:
            return program
        first = modules[0]
        home = ir.Module(self.context.fresh("rpl_traps"), first.dialect, (), tuple(self.made), task=first.task)
        program = exposed(program, called_names(self.made))
        return replace(program, modules=(*program.modules, home))

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        return tuple(done)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.ConnectInterrupt(handle=handle) if base_name(handle) in self.priority_of:
                return [ir.Nothing(origin=statement.origin)] if statement.origin.comments else []
            case ir.OrderInterrupt(handle=handle, event="edge", condition=condition) if condition is not None:
                name = base_name(handle)
                if name is None or name not in self.priority_of:
                    return [statement]
                single = statement.once and InterruptRule.ONE_SHOT in self.context.capabilities.interrupts.rules
                action = self.action(name, statement.once and not single)
                priority = ir.IntLiteral(self.priority_of[name])
                later = replace(statement.origin, comments=())
                return [
                    ir.DeclareInterrupt(priority, condition, action, True, once=single, origin=statement.origin),
                    ir.ControlInterrupt("on", priority, origin=later),
                ]
            case ir.OrderInterrupt(handle=handle, event="timer", time=time) if time is not None:
                name = base_name(handle)
                if name is not None and name in self.priority_of and self.watching:
                    return self.watched(statement, name)
                if name is None or name not in self.priority_of or not self.context.capabilities.io.timers:
                    return [statement]
                return self.every(statement, name, time)
            case ir.ControlInterrupt(op=op, handle=handle) if handle is not None:
                name = base_name(handle)
                if name not in self.priority_of:
                    return [statement]
                op = "off" if op == "delete" else op
                done = replace(statement, op=op, handle=ir.IntLiteral(self.priority_of[name]))
                if op == "off" and name in self.timer_of:
                    stop = ir.Assign(self.timer(name, "timer_stopped"), ir.BoolLiteral(True))
                    return [done, replace(stop, origin=replace(statement.origin, comments=()))]
                return [done]
        return [rewrite_bodies(statement, self.body)]

    def every(self, statement: ir.OrderInterrupt, name: str, time: ir.Expression) -> list[ir.Statement]:
        """A timer that counts up to zero; its interrupt sets it back by the period, so that no time is lost. Periods
        that pass while it has to wait come once, and the next one at its own time."""
        if name not in self.timer_of:
            self.timer_of[name] = self.context.capabilities.io.timers - len(self.timer_of)
        timer, stopped = self.timer(name, "timer"), self.timer(name, "timer_stopped")
        priority, later = ir.IntLiteral(self.priority_of[name]), replace(statement.origin, comments=())
        off = ir.ControlInterrupt("off", priority)
        back = ir.Assign(timer, ir.Binary("-", timer, time))
        passed = ir.Binary("<=", timer, ir.IntLiteral(0))
        again = off if statement.once else ir.Repeat(passed, (back,))
        routine = self.context.fresh(f"{self.routine_of[name]}_timer")
        call = ir.CallRoutine(self.routine_of[name])
        self.made.append(ir.Routine(routine, body=(again, call), scope="global"))
        return [
            ir.Assign(timer, ir.Unary("-", time), origin=statement.origin),
            ir.Assign(stopped, ir.BoolLiteral(False), origin=later),
            ir.DeclareInterrupt(
                priority, self.timer(name, "timer_positive"), ir.CallRoutine(routine), True, origin=later
            ),
            ir.ControlInterrupt("on", priority, origin=later),
        ]

    @property
    def watching(self) -> bool:
        return (
            self.context.capabilities.interrupts.watched is Watched.ALL
            or self.context.capabilities.interrupts.watched is Watched.INTERRUPTS
        )

    def watched(self, statement: ir.OrderInterrupt, name: str) -> list[ir.Statement]:
        """A timer for a target whose interrupts are tasks: these know how to wait for a time by themselves."""
        priority, later = ir.IntLiteral(self.priority_of[name]), replace(statement.origin, comments=())
        call = ir.CallRoutine(self.routine_of[name])
        never = ir.BoolLiteral(False)
        return [
            ir.DeclareInterrupt(priority, never, call, True, once=statement.once, origin=statement.origin),
            replace(statement, handle=priority, origin=later),
        ]

    def timer(self, name: str, what: str) -> ir.System:
        return ir.System(what, (ir.IntLiteral(self.timer_of[name]),))

    def action(self, name: str, once: bool) -> ir.CallRoutine:
        trap = self.routine_of[name]
        if not once:
            return ir.CallRoutine(trap)
        if name not in self.once:
            wrapper = self.context.fresh(f"{trap}_once")
            self.once[name] = wrapper
            off = ir.ControlInterrupt("off", ir.IntLiteral(self.priority_of[name]))
            self.made.append(ir.Routine(wrapper, body=(off, ir.CallRoutine(trap)), scope="global"))
        return ir.CallRoutine(self.once[name])


def _without_handles(declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
    """Without the numbers of interrupts, which are written where they are used."""
    return tuple(d for d in declarations if not (isinstance(d, ir.Variable) and isinstance(d.type, ir.InterruptType)))
