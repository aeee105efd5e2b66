"""Waits with a time limit, delayed outputs and stop watches for targets that have timers only.

A wait with a limit becomes a wait for the condition or a timer that was set to minus the limit. A stop watch becomes a
timer of its own. Timers are taken from the highest number down, apart from those that the program itself uses.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks, children, expressions_in, is_constant, root, statements_in
from rpl.passes.legalise.interrupts.clocks.heldtimers import held_timers, of_held_timers
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

NO_TIMER = code(
    "no-timer-left",
    Severity.LOSS,
    "{what} needs a timer of its own, and the {count} timers of the target are in use",
)

LATER_AS_PULSE = code(
    "later-as-pulse",
    Severity.WARNING,
    "this output changes later as the end of a pulse: only where it has another level now, and other statements of the"
    " program that switch it must not do so until then",
)


@legalising()
def fit_waits(program: ir.Program, context: Context) -> ir.Program:
    """The program with only the waits, delayed outputs and stop watches of the target."""
    timers = _Timers(program, context)
    if "ClockType" not in context.capabilities.types and "timer" in context.capabilities.system_variables:
        taken = frozenset(timers.used)
        program = _without_clocks(program, context, timers)
        if held_timers.needed(context):
            program = of_held_timers(program, context, frozenset(timers.used) - taken)
    trapped = _reached_from_interrupts(program)
    delayed = "SetAfter" not in context.capabilities.statements
    switched = _switched(program) if delayed else Counter()

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        key = "interrupt" if routine.name.lower() in trapped else "program"
        return edit_bodies(routine, _Waits(editor, timers, f"{editor.scope.module.task}/{key}", switched).body)

    return edit_routines(program, context, work)


# ---- timers


@dataclass(slots=True)
class _Timers:
    """Free system timers, by what they are for."""

    program: ir.Program
    context: Context
    given: dict[str, int | None] = field(default_factory=dict)
    used: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        for module in self.program.modules:
            for routine in module.routines:
                for body in bodies(routine):
                    for statement in statements_in(body):
                        self._note(statement)

    def _note(self, statement: ir.Statement) -> None:
        for one in expressions_in(statement, {"System"}):
            if isinstance(one, ir.System) and one.name.startswith("timer") and one.indices:
                index = one.indices[0]
                numbers = [index.value] if isinstance(index, ir.IntLiteral) else []
                # a computed number may mean any timer: none is free then
                self.used.update(numbers or range(1, self.context.capabilities.io.timers + 1))

    def take(self, purpose: str, count: int = 1) -> int | None:
        """The first of `count` timers that nothing else uses; None when there are not as many."""
        if purpose not in self.given:
            self.given[purpose] = None
            for first in range(self.context.capabilities.io.timers - count + 1, 0, -1):
                wanted = set(range(first, first + count))
                if not wanted & self.used:
                    self.used |= wanted
                    self.given[purpose] = first
                    break
        return self.given[purpose]


def _timer(index: ir.Expression) -> ir.System:
    return ir.System("timer", (index,))


def _stopped(index: ir.Expression, value: bool) -> ir.Assign:
    return ir.Assign(ir.System("timer_stopped", (index,)), ir.BoolLiteral(value))


def _reached_from_interrupts(program: ir.Program) -> set[str]:
    """Routines that may run while another one waits."""
    calls: dict[str, set[str]] = {}
    reached: set[str] = set()
    for module in program.modules:
        for routine in module.routines:
            called = calls.setdefault(routine.name.lower(), set())
            for body in bodies(routine):
                for statement in statements_in(body):
                    match statement:
                        case ir.CallRoutine(name=name):
                            called.add(name.lower())
                        case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)):
                            reached.add(name.lower())
                        case ir.ConnectInterrupt(routine=name) | ir.Trigger(action=ir.CallRoutine(name=name)):
                            reached.add(name.lower())
                    calls_in = (one for one in expressions_in(statement, {"Call"}) if isinstance(one, ir.Call))
                    called |= {one.name.lower() for one in calls_in}
    size = -1
    while size != len(reached):
        size = len(reached)
        reached |= {callee for name in reached for callee in calls.get(name, ())}
    return reached


# ---- waits and delayed outputs


_ACTS_ON = frozenset(("WaitUntil", "SetAfter", "Pulse"))


class _Waits:
    def __init__(self, editor: Editor, timers: _Timers, purpose: str, switched: Counter[str | int | None]) -> None:
        self.editor = editor
        self.switched = switched
        self.timers = timers
        self.purpose = purpose
        self.capabilities = editor.capabilities

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement, _ACTS_ON)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.WaitUntil(timeout=timeout) if timeout is not None and not self.capabilities.io.wait_timeout:
                return self.limited(statement, timeout)
            case ir.SetAfter() if "SetAfter" not in self.capabilities.statements:
                return self.set_after(statement)
            case ir.Pulse() if "Pulse" not in self.capabilities.statements:
                return self.pulse(statement)
        if blocks(statement):
            return (rewrite_bodies(statement, self.body),)
        return (statement,)

    def limited(self, statement: ir.WaitUntil, timeout: ir.Expression) -> ir.Body:
        """`timer > 0` ends the wait; the condition then says whether it was in time."""
        if statement.timed_out is None or "timer" not in self.capabilities.system_variables:
            return (statement,)
        number = self.timers.take(f"wait {self.purpose}")
        if number is None:
            self._none_left(statement, "this wait")
            return (statement,)
        index = ir.IntLiteral(number)
        late: ir.Expression = ir.Binary(">", _timer(index), ir.IntLiteral(0))
        if "timer_positive" in self.capabilities.system_variables:
            late = ir.System("timer_positive", (index,))
        condition = statement.condition
        wait = replace(statement, condition=ir.Binary("or", condition, late), timeout=None, timed_out=None, error=None)
        return expansion(
            statement.origin,
            (
                ir.Assign(_timer(index), _negative(timeout)),
                _stopped(index, False),
                wait,
                ir.Assign(statement.timed_out, negation(condition)),
            ),
        )

    def _none_left(self, statement: ir.Statement, what: str) -> None:
        self.editor.context.diagnostics.report(NO_TIMER, statement.origin, what=what, count=self.capabilities.io.timers)

    def set_after(self, statement: ir.SetAfter) -> ir.Body:
        """An output that changes later is a pulse of the opposite level, unless it has its level already."""
        if not self._digital(statement.signal) or "Pulse" not in self.capabilities.statements:
            return (statement,)
        if not self._plain(statement.signal) or not self.editor.effects.safe(statement.value):
            return (statement,)
        own = _output(statement.signal)
        if own is None or self.switched[own] > 1 or self.switched[None] or not is_constant(statement.value):
            self.editor.context.diagnostics.report(LATER_AS_PULSE, statement.origin)
        differs = _differs(statement.signal, statement.value)
        pulse = ir.Pulse(statement.signal, negation(statement.value), statement.delay)
        return expansion(statement.origin, (ir.If(((differs, (pulse,)),)),))

    def pulse(self, statement: ir.Pulse) -> ir.Body:
        """Without pulses: set now, set back later, where the target can do that."""
        if "SetAfter" not in self.capabilities.statements or not self.editor.effects.safe(statement.value):
            return (statement,)
        later = ir.SetAfter(statement.signal, negation(statement.value), statement.duration)
        value = statement.value
        if not is_constant(value):
            kept = self.editor.temporary("level", ir.BoolType())
            later = replace(later, value=ir.Unary("not", kept))
            start = (ir.Assign(kept, value), ir.Assign(statement.signal, kept))
            return expansion(statement.origin, (*start, later))
        return expansion(statement.origin, (ir.Assign(statement.signal, value), later))

    def _digital(self, signal: ir.Expression) -> bool:
        return isinstance(self.editor.type_of(signal), ir.BoolType)

    def _plain(self, signal: ir.Expression) -> bool:
        return all(map(self.editor.effects.safe, children(signal)))


def _switched(program: ir.Program) -> Counter[str | int | None]:
    """How many statements switch each output, by its name or number; None: outputs that the run chooses, and groups."""
    found: Counter[str | int | None] = Counter()
    for node in walk_for({"Assign", "Pulse", "SetAfter"}, *program.modules):
        match node:
            case ir.Assign(target=ir.Signal() | ir.Name() as signal):
                found[_output(signal)] += 1
            case ir.Pulse(signal=signal) | ir.SetAfter(signal=signal):
                found[_output(signal)] += 1
    return found


def _output(signal: ir.Expression) -> str | int | None:
    match signal:
        case ir.Name(id=name) | ir.Signal(name=str(name)):
            return name.lower()
        case ir.Signal(index=ir.IntLiteral(value=number), last=None):
            return number
    return None


def _negative(timeout: ir.Expression) -> ir.Expression:
    match timeout:
        case ir.Quantity(value=value):
            return replace(timeout, value=ir.Unary("-", value))
    return ir.Unary("-", timeout)


def _differs(signal: ir.Expression, value: ir.Expression) -> ir.Expression:
    match value:
        case ir.BoolLiteral(value=True):
            return ir.Unary("not", signal)
        case ir.BoolLiteral(value=False):
            return signal
    return ir.Binary("<>", signal, value)


# ---- stop watches


def _without_clocks(program: ir.Program, context: Context, timers: _Timers) -> ir.Program:
    """Each stop watch is a timer, and its name stands for the timer's number. A parameter is passed the number."""
    scopes = ProgramScope(program)
    numbers: dict[int, int] = {}
    for module in program.modules:
        lists = [(module.declarations, scopes.module(module))]
        lists += [(routine.declarations, scopes.routine(module, routine)) for routine in module.routines]
        for declarations, scope in lists:
            for declaration in declarations:
                if isinstance(declaration, ir.Variable) and _is_clock(declaration.type, scope):
                    _number(declaration, numbers, timers, context)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            inner = scopes.routine(module, routine)
            changed = edit_bodies(routine, _Clocks(inner, numbers).body)
            parameters = tuple(_as_number(parameter, inner) for parameter in routine.parameters)
            own = _without(routine.declarations, numbers)
            routines.append(replace(changed, declarations=own, parameters=parameters))
        declarations = _without(module.declarations, numbers)
        modules.append(replace(module, declarations=declarations, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


def _is_clock(type: ir.Type, scope: Scope) -> bool:
    if isinstance(type, ir.ArrayType):
        return _is_clock(type.element, scope)
    return isinstance(scope.resolve(type), ir.ClockType)


def _number(clock: ir.Variable, numbers: dict[int, int], timers: _Timers, context: Context) -> None:
    count = 1
    if isinstance(clock.type, ir.ArrayType):
        match clock.type.dimensions:
            case (ir.IntLiteral(value=count),):
                pass
            case _:
                return
    number = timers.take(f"clock {id(clock)}", count)
    if number is None:
        context.diagnostics.report(
            NO_TIMER, clock.origin, what=f"the clock {clock.name}", count=context.capabilities.io.timers
        )
        return
    numbers[id(clock)] = number


def _without(declarations: tuple[ir.Declaration, ...], numbers: dict[int, int]) -> tuple[ir.Declaration, ...]:
    """The declarations without the numbered clocks; their comments stay."""
    kept: list[ir.Declaration] = []
    for declaration in declarations:
        if id(declaration) not in numbers:
            kept.append(declaration)
        elif declaration.origin.comments:
            kept.append(ir.Unread("", origin=declaration.origin))
    return tuple(kept)


def _as_number(parameter: ir.Parameter, scope: Scope) -> ir.Parameter:
    if isinstance(parameter.type, ir.ArrayType) or not _is_clock(parameter.type, scope):
        return parameter
    return replace(parameter, type=ir.IntType(), mode="value")


class _Clocks:
    """Statements and readings of stop watches as those of timers."""

    def __init__(self, scope: Scope, numbers: dict[int, int]) -> None:
        self.scope = scope
        self.numbers = numbers

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Clock(op=op, clock=clock) if self.known(clock):
                clock = self.expression(clock)
                if op == "start":
                    return (replace(_stopped(clock, False), origin=statement.origin),)
                stop = _stopped(clock, True)
                if op == "stop":
                    return (replace(stop, origin=statement.origin),)
                return expansion(statement.origin, (stop, ir.Assign(_timer(clock), ir.IntLiteral(0))))
        return (rewrite_parts(statement, self.expression, self.body),)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name(id=name):
                number = self.number(name)
                return expression if number is None else ir.IntLiteral(number, origin=expression.origin)
            case ir.Index(base=ir.Name(id=name), indices=(index,)):
                number = self.number(name)
                if number is not None:
                    return _shifted(self.expression(index), number - 1)
            case ir.Builtin(function="clock_seconds", arguments=(clock,)) if self.known(clock):
                return _timer(self.expression(clock))
        return rewrite_parts(expression, self.expression)

    def known(self, clock: ir.Expression) -> bool:
        """Has this stop watch got a timer?"""
        variable = root(clock)
        symbol = self.scope.value(variable.id) if isinstance(variable, ir.Name) else None
        if symbol is None:
            return False
        return id(symbol.declaration) in self.numbers or isinstance(symbol.declaration, ir.Parameter)

    def number(self, name: str) -> int | None:
        symbol = self.scope.value(name)
        return None if symbol is None else self.numbers.get(id(symbol.declaration))


def _shifted(index: ir.Expression, by: int) -> ir.Expression:
    if isinstance(index, ir.IntLiteral):
        return ir.IntLiteral(index.value + by)
    return ir.Binary("+", index, ir.IntLiteral(by))
