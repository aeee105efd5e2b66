"""Numbered timers that can be set and stopped (KRL) as stop watches (RAPID), for targets that have only these.

A timer shows an offset plus its watch: setting it resets the watch and keeps the value as the offset.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.source import Origin

_TIMERS = ("timer", "timer_stopped", "timer_positive")


_ACTS_ON = frozenset(f"system {one}" for one in _TIMERS)


@legalising(sees=_ACTS_ON)
def timers_to_clocks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without numbered timers that have stop watches. Computed timer numbers stay for the writer.
    Where timers have no flag that tells whether they are past zero, they are compared."""
    capabilities = context.capabilities
    if capabilities.io.timers and "timer_positive" not in capabilities.system_variables:
        return _Compared(program, context).program()
    if capabilities.io.timers or "Clock" not in capabilities.statements:
        return program
    worker = _Clocks(context)
    for module in program.modules:  # which timers are asked whether they run
        for routine in module.routines:
            for body in bodies(routine):
                worker.body(body)
    worker.kept = worker.asked
    done = edit_all(program, worker.body)
    if not worker.watches:
        return program
    first = done.modules[0]
    declarations = tuple(
        one
        for watch in worker.watches.values()
        for one in watch.declarations()
        if one.name != watch.running or watch.running in worker.asked
    )
    home = ir.Module(context.fresh("rpl_timers"), first.dialect, declarations, task=first.task, public=True)
    return replace(program, modules=(*done.modules, home))


def _switched(setting: ir.Assign, beside: ir.Body) -> bool | None:
    """Whether the statement beside this setting of a timer starts (TRUE) or stops the same one; None: neither."""
    match setting.target, beside:
        case (
            ir.System(name="timer", indices=here),
            (ir.Assign(target=ir.System(name="timer_stopped", indices=there), value=ir.BoolLiteral(value=stopped)),),
        ) if here == there:
            return not stopped
    return None


def _in_seconds(value: ir.Expression) -> ir.Expression:
    """A time as a plain number."""
    match value:
        case ir.Quantity(value=ir.Unary(op="-", operand=ir.IntLiteral(value=number) | ir.RealLiteral(value=number))):
            return ir.RealLiteral(-round(number * ir.UNITS[value.unit], 9), origin=value.origin)
        case ir.Quantity(value=inner, unit=unit) if not _written(inner):
            return ir.Binary("*", inner, ir.RealLiteral(ir.UNITS[unit]), origin=value.origin)
    return value


def _written(value: ir.Expression) -> bool:
    """Is it a number, perhaps with a sign?"""
    value = value.operand if isinstance(value, ir.Unary) else value
    return isinstance(value, ir.IntLiteral | ir.RealLiteral)


class _Compared(Rewriter):
    """The flag of a timer is whether the timer is above zero; a choice starts or stops one by a condition."""

    acts_on = _ACTS_ON

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        done = super().statement(statement)
        match done:
            case [ir.Assign(target=ir.System(name="timer"), value=value) as only]:
                return [replace(only, value=_in_seconds(value))]
            case [ir.Assign(target=ir.System(name="timer_stopped"), value=value) as only] if not isinstance(
                value, ir.BoolLiteral
            ):
                later = replace(only.origin, comments=())
                stop, start = (replace(only, value=ir.BoolLiteral(stopped), origin=later) for stopped in (True, False))
                return [ir.If(((value, (stop,)),), (start,), origin=only.origin)]
        return done

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if isinstance(done, ir.System) and done.name == "timer_positive":
            return ir.Binary(">", replace(done, name="timer"), ir.IntLiteral(0), origin=done.origin)
        return done


@dataclass(frozen=True, slots=True)
class _Watch:
    clock: str
    offset: str
    running: str

    def declarations(self) -> tuple[ir.Variable, ...]:
        return (
            ir.Variable(self.clock, ir.ClockType(), scope="global"),
            ir.Variable(self.offset, ir.RealType(), ir.RealLiteral(0.0), scope="global"),
            ir.Variable(self.running, ir.BoolType(), ir.BoolLiteral(False), scope="global"),
        )


@dataclass(slots=True)
class _Clocks:
    """`asked`: the variables that something asks whether a timer runs; `kept`: those that are set (None: all)."""

    context: Context
    watches: dict[int, _Watch] = field(default_factory=dict)
    asked: set[str] = field(default_factory=set)
    kept: set[str] | None = None

    def watch(self, place: ir.Expression) -> _Watch | None:
        match place:
            case ir.System(name=name, indices=(ir.IntLiteral(value=number),)) if name in _TIMERS:
                if number not in self.watches:
                    names = (f"rpl_timer_{number}", f"rpl_timer_{number}_offset", f"rpl_timer_{number}_on")
                    self.watches[number] = _Watch(*map(self.context.fresh, names))
                return self.watches[number]
        return None

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for at, statement in enumerate(body):
            watch = self.watch(statement.target) if isinstance(statement, ir.Assign) else None
            if watch is None or not isinstance(statement, ir.Assign):
                done.append(rewrite_parts(statement, self.expression, self.body))
            else:
                behind, before = body[at + 1 : at + 2], body[max(at - 1, 0) : at]
                done.extend(self.setting(statement, watch, _switched(statement, behind), _switched(statement, before)))
        return tuple(done)

    def setting(
        self, statement: ir.Assign, watch: _Watch, then: bool | None, before: bool | None
    ) -> list[ir.Statement]:
        """`then`, `before`: whether the statement behind or in front starts (TRUE) or stops this timer."""
        assert isinstance(statement.target, ir.System)
        value = _in_seconds(self.expression(statement.value))
        clock, later = ir.Name(watch.clock), replace(statement.origin, comments=())
        start: ir.Body = (ir.Clock("start", clock, origin=later),)
        if statement.target.name == "timer":
            again: ir.Body = start if before else ()
            if then is None and before is None:
                again = (ir.If(((self.running(watch), start),), origin=later),)
            reset, kept = ir.Clock("reset", clock), ir.Assign(ir.Name(watch.offset), value)
            reads = any(node == clock for node in walk(value))  # what the timer shows goes into what it gets
            first, second = (kept, reset) if reads else (reset, kept)
            return [replace(first, origin=statement.origin), replace(second, origin=later), *again]
        stop: ir.Body = (ir.Clock("stop", clock, origin=later), *self.noted(watch, False, later))
        start = (*start, *self.noted(watch, True, later))
        match value:
            case ir.BoolLiteral(value=stopped):
                now, *others = stop if stopped else start
                return [replace(now, origin=statement.origin), *others]
        return [ir.If(((value, stop),), start, origin=statement.origin)]

    def running(self, watch: _Watch) -> ir.Name:
        """Whether the timer runs."""
        self.asked.add(watch.running)
        return ir.Name(watch.running)

    def noted(self, watch: _Watch, runs: bool, origin: Origin) -> ir.Body:
        if self.kept is not None and watch.running not in self.kept:
            return ()
        return (ir.Assign(ir.Name(watch.running), ir.BoolLiteral(runs), origin=origin),)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        watch = self.watch(expression)
        if watch is None or not isinstance(expression, ir.System):
            return rewrite_parts(expression, self.expression)
        if expression.name == "timer_stopped":
            return ir.Unary("not", self.running(watch), origin=expression.origin)
        elapsed = ir.Builtin("clock_seconds", (ir.Name(watch.clock),))
        shown = ir.Binary("+", ir.Name(watch.offset), elapsed, origin=expression.origin)
        if expression.name == "timer":
            return shown
        return ir.Binary(">", shown, ir.RealLiteral(0.0), origin=expression.origin)
