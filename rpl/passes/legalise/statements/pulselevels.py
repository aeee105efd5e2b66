"""Pulses to low, and to the opposite of what the output is, for targets whose pulses are to high; pulses whose length
is computed, for targets where it is a number.

Such a pulse is set now, and a task of its own sets the output back after its time. Of an output that is known only in
the run (one that a routine is given) the pulse to high is written, and the one to low stays for the writer.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.capabilities import PulseRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import is_constant
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

_HIGH, _LOW = ir.BoolLiteral(True), ir.BoolLiteral(False)


@legalising(
    unless=lambda context: (
        (
            PulseRule.ANY_LEVEL in context.capabilities.io.pulses
            and PulseRule.COMPUTED_TIME in context.capabilities.io.pulses
        )
        or "start" not in context.capabilities.tasks.operations
        or "TaskControl" not in context.capabilities.statements
    ),
    sees=("Pulse",),
)
def pulse_levels(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that pulse to high, or for known times, and can begin a task."""
    worker = _Pulses(context)
    pulses = [one for one in walk_for({"Pulse"}, *program.modules) if isinstance(one, ir.Pulse)]
    if all(one.value == _HIGH and worker.measured(one) for one in pulses):
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, lambda one: worker.statement(one, editor.scope)))

    done = edit_routines(program, context, work)
    return with_support(done, context, worker.times, worker.routines, done.modules[0].task)


@dataclass(slots=True)
class _Pulses:
    """The tasks, one for each output, and the data that says for how long."""

    context: Context
    tasks: dict[tuple[ir.Expression, bool], tuple[str, str]] = field(default_factory=dict)
    times: list[ir.Variable] = field(default_factory=list)
    routines: list[ir.Routine] = field(default_factory=list)

    def statement(self, statement: ir.Statement, scope: Scope) -> ir.Body:
        match statement:
            case ir.Pulse(signal=signal, value=value) if value == _HIGH:
                if self.measured(statement) or not _is_one(signal, scope):
                    return (statement,)
                return expansion(statement.origin, self.set_back(signal, _HIGH, statement.duration))
            case ir.Pulse(signal=signal, value=value) if _is_one(signal, scope):
                low = self.set_back(signal, _LOW, statement.duration)
                high: ir.Body = (ir.Pulse(signal, _HIGH, statement.duration),)
                if not self.measured(statement):
                    high = self.set_back(signal, _HIGH, statement.duration)
                if value == _LOW:
                    return expansion(statement.origin, low)
                if value == ir.Unary("not", signal):
                    return expansion(statement.origin, (ir.If(((signal, low),), high),))
                return expansion(statement.origin, (ir.If(((value, high),), low),))
            case ir.Pulse(signal=signal, value=value) if value == ir.Unary("not", signal):
                high = (ir.Pulse(signal, _HIGH, statement.duration),)
                stays = (replace(statement, value=_LOW, origin=replace(statement.origin, comments=())),)
                return expansion(statement.origin, (ir.If(((ir.Unary("not", signal), high),), stays),))
        return (inside(statement, lambda inner: map_body(inner, lambda one: self.statement(one, scope))),)

    def measured(self, pulse: ir.Pulse) -> bool:
        """Can the target say how long the pulse is?"""
        return PulseRule.COMPUTED_TIME in self.context.capabilities.io.pulses or is_constant(pulse.duration)

    def set_back(self, signal: ir.Expression, level: ir.BoolLiteral, duration: ir.Expression) -> ir.Body:
        """The level now, and a task that gives the output the other one."""
        if (signal, level.value) not in self.tasks:
            task, time = self.context.fresh("rpl_pulse"), self.context.fresh("rpl_pulse_time")
            self.tasks[signal, level.value] = task, time
            self.times.append(ir.Variable(time, ir.RealType(), ir.RealLiteral(0.0), scope="global"))
            wait = ir.Wait(ir.Quantity(ir.Name(time), "s"))
            back = ir.Assign(signal, _LOW if level.value else _HIGH)
            self.routines.append(ir.Routine(task, body=(wait, back), scope="global"))
        task, time = self.tasks[signal, level.value]
        return (
            ir.Assign(signal, level),
            ir.Assign(ir.Name(time), duration),
            ir.TaskControl("start", task),
        )


def _is_one(signal: ir.Expression, scope: Scope) -> bool:
    """Is it always the same output, by its number or by a name of the program for it?"""
    if isinstance(signal, ir.Name):
        symbol = scope.value(signal.id)
        return symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration)
    return isinstance(signal, ir.Signal) and isinstance(signal.index, ir.IntLiteral | None)


__all__ = ["pulse_levels"]
