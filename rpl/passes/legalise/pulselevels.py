"""Pulses to low, and to the opposite of what the output is, for targets whose pulses are to high.

A pulse to low is set now, and a task of its own sets the output back after its time.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.jumps import inside
from rpl.passes.legalise.support import with_support

_HIGH, _LOW = ir.BoolLiteral(True), ir.BoolLiteral(False)


def pulse_levels(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that pulse to high and can begin a task."""
    can = context.capabilities
    if can.pulse_levels or "start" not in can.task_operations or "TaskControl" not in can.statements:
        return program
    if not any(isinstance(one, ir.Pulse) and one.value != _HIGH for one in walk(*program.modules)):
        return program
    worker = _Pulses(context)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, worker.statement))

    done = edit_routines(program, context, work)
    return with_support(done, context, worker.times, worker.routines, done.modules[0].task)


@dataclass(slots=True)
class _Pulses:
    """The tasks, one for each output, and the data that says for how long."""

    context: Context
    tasks: dict[ir.Expression, tuple[str, str]] = field(default_factory=dict)
    times: list[ir.Variable] = field(default_factory=list)
    routines: list[ir.Routine] = field(default_factory=list)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Pulse(signal=ir.Signal(index=ir.IntLiteral() | None) as signal, value=value) if value != _HIGH:
                low = self.low(signal, statement.duration)
                high = (ir.Pulse(signal, _HIGH, statement.duration),)
                if value == _LOW:
                    return expansion(statement.origin, low)
                if value == ir.Unary("not", signal):
                    return expansion(statement.origin, (ir.If(((signal, low),), high),))
                return expansion(statement.origin, (ir.If(((value, high),), low),))
        return (inside(statement, lambda inner: map_body(inner, self.statement)),)

    def low(self, signal: ir.Signal, duration: ir.Expression) -> ir.Body:
        if signal not in self.tasks:
            task, time = self.context.fresh("rpl_pulse"), self.context.fresh("rpl_pulse_time")
            self.tasks[signal] = task, time
            self.times.append(ir.Variable(time, ir.RealType(), ir.RealLiteral(0.0), scope="global"))
            wait = ir.Wait(ir.Quantity(ir.Name(time), "s"))
            self.routines.append(ir.Routine(task, body=(wait, ir.Assign(signal, _HIGH)), scope="global"))
        task, time = self.tasks[signal]
        return (
            ir.Assign(signal, _LOW),
            ir.Assign(ir.Name(time), duration),
            ir.TaskControl("start", task),
        )


__all__ = ["pulse_levels"]
