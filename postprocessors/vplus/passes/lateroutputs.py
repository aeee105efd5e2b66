"""Outputs that change later while the program goes on: a small program in a task of its own waits and switches them.

V+ has no word for either. The program of an output whose number is known and a time that is written out comes along for
that one change; a computed one is given to `rpl.later` of the library (`actions.Actions.later`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import lasting_number
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.scope import ProgramScope, Scope
from rpl.writing.target import WriteContext

from .. import tables
from ..facts.tasks import beside_main
from ..units import in_unit

_ACTS_ON = frozenset(("Pulse", "SetAfter"))


def later_outputs(program: ir.Program, context: WriteContext) -> ir.Program:
    """Of one signal all such programs run in the same task, so that the next one begins when the last has ended."""
    if next(iter(walk_for(_ACTS_ON, *program.modules)), None) is None:
        return program
    scopes = ProgramScope(program)
    later = _Later(tables.TASKS - len(beside_main(program)))

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = scopes.routine(module, routine)

        def body(statements: ir.Body) -> ir.Body:
            return map_body(statements, change, _ACTS_ON)

        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Pulse | ir.SetAfter):
                return later.changed(statement, scope)
            return (inside(statement, body),)

        return edit_bodies(routine, body)

    done = edit_each(program, work, _ACTS_ON)
    if not later.routines:
        return done
    first, *others = done.modules
    first = replace(first, routines=(*first.routines, *later.routines.values()))
    return replace(done, modules=(first, *others))


@dataclass(slots=True)
class _Later:
    """`tasks`: how many are free; `signals`: those that have one, in order; `routines`: by signal, level and time."""

    tasks: int
    signals: list[ir.Signal] = field(default_factory=list)
    routines: dict[tuple[ir.Signal, bool, float], ir.Routine] = field(default_factory=dict)

    def changed(self, statement: ir.Pulse | ir.SetAfter, scope: Scope) -> ir.Body:
        """The steps of one, or the statement itself where something is computed or cannot be said."""
        value, bare = statement.value, replace(statement.origin, comments=())
        if not isinstance(value, ir.BoolLiteral):
            on, off = (replace(statement, value=ir.BoolLiteral(level), origin=bare) for level in (True, False))
            choice = ((value, self.changed(on, scope)),)
            return (ir.If(choice, self.changed(off, scope), origin=statement.origin),)
        pulse = isinstance(statement, ir.Pulse)
        signal = _single(statement.signal, scope)
        seconds = in_unit(statement.duration if isinstance(statement, ir.Pulse) else statement.delay, "s")
        while isinstance(seconds, ir.Convert) and seconds.how == "real":
            seconds = seconds.operand
        if signal is None or not isinstance(seconds, ir.IntLiteral | ir.RealLiteral):
            return (statement,)
        name = self.program(signal, value.value != pulse, seconds)
        if name is None:
            return (statement,)
        if not pulse:
            return (ir.TaskControl("start", name, origin=statement.origin),)
        now = ir.Assign(signal, value, origin=statement.origin)
        return now, ir.TaskControl("start", name, origin=bare)

    def program(self, signal: ir.Signal, level: bool, seconds: ir.IntLiteral | ir.RealLiteral) -> str | None:
        """The name of the program that switches a signal after a time; None where no task is left for it."""
        if signal not in self.signals:
            if len(self.signals) >= self.tasks:
                return None
            self.signals.append(signal)
        key = signal, level, float(seconds.value)
        if key not in self.routines:
            steps = (ir.Wait(seconds), ir.Assign(signal, ir.BoolLiteral(level)))
            self.routines[key] = ir.Routine(f"{tables.LATER}{len(self.routines) + 1}", body=steps)
        return self.routines[key].name


def _single(signal: ir.Expression, scope: Scope) -> ir.Signal | None:
    """A digital output whose number is written out, or named by constants of all programs."""
    name = signal.id if isinstance(signal, ir.Name) else signal.name if isinstance(signal, ir.Signal) else None
    if name is not None and not (isinstance(signal, ir.Signal) and signal.index is not None):
        symbol = scope.value(name)
        declared = symbol.declaration if symbol is not None else None
        signal = declared.signal if isinstance(declared, ir.SignalDeclaration) else signal
    if not isinstance(signal, ir.Signal) or signal.last is not None or signal.kind not in tables.SINGLE_OUTPUTS:
        return None
    number = None if signal.index is None else lasting_number(signal.index, scope)
    if number is None or not tables.is_signal(signal.kind, number):
        return None
    names = [scope.value(one.id) for one in walk(signal.index) if isinstance(one, ir.Name)]
    if not names:
        return replace(signal, index=ir.IntLiteral(int(number)))
    everywhere = all(one is not None and one.routine is None for one in names)
    return signal if everywhere else None


__all__ = ["later_outputs"]
