"""Stop watches that a task of its own counts, for controllers that have tasks and no clock.

A watch becomes a whole number of steps and a flag that says whether it runs. The task waits for a step, adds one to
each watch that runs, and ends with the program that started it, so that this can be started again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.startdata import entries_of
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

from .. import tables

COUNTED = code(
    "stop-watch-counted",
    Severity.WARNING,
    "the target has no stop watches; a task beside the program counts them in steps of {step:g} s",
    "the controller has to be able to run jobs beside each other",
)
_TASK, _RUNS = "rpl_watch", "rpl_watch_runs"


@legalising()
def counted_watches(program: ir.Program, context: Context) -> ir.Program:
    """A controller without stop watches: a task counts them."""
    if not program.modules:
        return program
    worker = _Watches(context, ProgramScope(program))
    modules = tuple(worker.module(module) for module in program.modules)
    if not worker.watches:
        return program
    context.diagnostics.report(COUNTED, worker.first.origin, step=tables.WATCH_STEP_S)
    program = replace(program, modules=(*modules, worker.home(modules[0])))
    return worker.started(program)


@dataclass(frozen=True, slots=True)
class _Watch:
    count: str
    running: str


class _Watches:
    def __init__(self, context: Context, scopes: ProgramScope) -> None:
        self.context, self.scopes = context, scopes
        self.step = tables.WATCH_STEP_S
        self.watches: dict[int, _Watch] = {}
        self.first: ir.Variable
        self.task, self.runs = _TASK, _RUNS

    # ---- declarations

    def module(self, module: ir.Module) -> ir.Module:
        scope = self.scopes.module(module)
        kept = self.without_watches(module.declarations, scope)
        routines = tuple(self.routine(routine, self.scopes.routine(module, routine)) for routine in module.routines)
        return replace(module, declarations=kept, routines=routines)

    def without_watches(self, declarations: tuple[ir.Declaration, ...], scope: Scope) -> tuple[ir.Declaration, ...]:
        return tuple(one for one in declarations if not self.is_watch(one, scope))

    def is_watch(self, declaration: ir.Declaration | None, scope: Scope) -> bool:
        return isinstance(declaration, ir.Variable) and isinstance(scope.resolve(declaration.type), ir.ClockType)

    def routine(self, routine: ir.Routine, scope: Scope) -> ir.Routine:
        routine = replace(routine, declarations=self.without_watches(routine.declarations, scope))
        return edit_bodies(routine, lambda body: _Body(self, scope).body(body))

    def watch(self, place: ir.Expression, scope: Scope) -> _Watch | None:
        if not isinstance(place, ir.Name):
            return None
        symbol = scope.value(place.id)
        declaration = symbol.declaration if symbol is not None else None
        if not isinstance(declaration, ir.Variable) or not self.is_watch(declaration, scope):
            return None
        if id(declaration) not in self.watches:
            if not self.watches:
                self.first = declaration
                self.task, self.runs = self.context.fresh(_TASK), self.context.fresh(_RUNS)
            names = (declaration.name, f"{declaration.name}_on")
            self.watches[id(declaration)] = _Watch(*map(self.context.fresh, names))
        return self.watches[id(declaration)]

    # ---- the task

    def home(self, beside: ir.Module) -> ir.Module:
        """The watches' data and the routine that counts them."""
        declarations: list[ir.Declaration] = [
            ir.Variable(self.runs, ir.BoolType(), ir.BoolLiteral(False), scope="global")
        ]
        counting: list[ir.Statement] = [ir.Wait(ir.RealLiteral(self.step))]
        for watch in self.watches.values():
            declarations.append(ir.Variable(watch.count, ir.IntType(), ir.IntLiteral(0), scope="global"))
            declarations.append(ir.Variable(watch.running, ir.BoolType(), ir.BoolLiteral(False), scope="global"))
            count = ir.Name(watch.count)
            more: ir.Body = (ir.Assign(count, ir.Binary("+", count, ir.IntLiteral(1))),)
            counting.append(ir.If(((ir.Name(watch.running), more),)))
        loop = ir.While(ir.Name(self.runs), tuple(counting))
        routine = ir.Routine(self.task, body=(loop,), scope="global")
        name = self.context.fresh("rpl_watches")
        return ir.Module(name, beside.dialect, tuple(declarations), (routine,), task=beside.task, public=True)

    def started(self, program: ir.Program) -> ir.Program:
        """The program whose entry starts the task and ends it."""
        entries = entries_of(program) - {self.task.lower()}
        begin: ir.Body = (self.flag(True), ir.TaskControl("start", self.task))

        def routine(one: ir.Routine) -> ir.Routine:
            if one.name.lower() not in entries:
                return one
            body = self.ending(one.body)
            last = () if body and isinstance(body[-1], ir.Return | ir.Halt) else (self.flag(False),)
            return replace(one, body=(*begin, *body, *last))

        modules = tuple(
            replace(module, routines=tuple(routine(one) for one in module.routines)) for module in program.modules
        )
        return replace(program, modules=modules)

    def flag(self, value: bool) -> ir.Statement:
        return ir.Assign(ir.Name(self.runs), ir.BoolLiteral(value))

    def ending(self, body: ir.Body) -> ir.Body:
        """Each return of the entry lets the task end before."""
        done: list[ir.Statement] = []
        for statement in body:
            if isinstance(statement, ir.Return):
                done.extend((replace(self.flag(False), origin=statement.origin), statement))
            else:
                done.append(rewrite_bodies(statement, self.ending))
        return tuple(done)


@dataclass(slots=True)
class _Body:
    """The statements of one routine."""

    owner: _Watches
    scope: Scope

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            match statement:
                case ir.Clock(op=op, clock=clock) if (watch := self.owner.watch(clock, self.scope)) is not None:
                    running = ir.Assign(ir.Name(watch.running), ir.BoolLiteral(op == "start"), origin=statement.origin)
                    done.append(running)
                    if op == "reset":
                        later = replace(statement.origin, comments=())
                        done.append(ir.Assign(ir.Name(watch.count), ir.IntLiteral(0), origin=later))
                case _:
                    done.append(rewrite_parts(statement, self.expression, self.body))
        return tuple(done)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function="clock_seconds", arguments=(clock,)):
                watch = self.owner.watch(clock, self.scope)
                if watch is not None:
                    steps = ir.Convert("real", ir.Name(watch.count))
                    return ir.Binary("*", steps, ir.RealLiteral(self.owner.step), origin=expression.origin)
        return rewrite_parts(expression, self.expression)
