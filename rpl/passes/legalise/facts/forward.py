"""The one forward analysis: what holds in front of each statement, on every way that leads there.

A question is a subclass that says what a leaf statement changes (`transfer`) and what two ways have in common (`join`).
The ways are followed here: branches, loops with the jumps out of them, labels, calls of the whole program, handlers
that repeat the failed statement or go on behind it, undo and backward parts, and routines that something else than a
call runs (interrupts, triggers, other tasks, error routines), which begin with what holds anywhere.

Each routine is followed once for all its calls: it is entered with what they have in common and leaves with what it
sets. A routine is looked at again while what it is entered with or what one that it calls leaves behind changes; a
chain of changes that does not end soon is cut off by what is always true.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from rpl import ir
from rpl.ir.walk import bodies, is_expression, walk
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.legalise.facts.reach import armed_statements, with_calls
from rpl.passes.legalise.facts.usage import doing
from rpl.passes.legalise.kinds import kinds_in, kinds_within, walk_for
from rpl.passes.scope import ProgramScope, Scope

S = TypeVar("S")
_MOST_CHANGES = 200  # of what is known of one routine, one loop or one label, before nothing counts as known
_SURE = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral, ir.Name, ir.System, ir.Field,
         ir.Quantity, ir.Unary, ir.Aggregate)  # fmt: skip

# Kinds of nodes that decide which way a program goes.
_CALLS = frozenset(("Call", "CallRoutine"))
_WAYS = _CALLS | {
    "Loop",
    "ExitLoop",
    "NextPass",
    "Goto",
    "Label",
    "Return",
    "Retry",
    "TryNext",
    "Raise",
    "ResumeLevel",
    "Halt",
}
_DECLARING = frozenset(("DeclareInterrupt",))
_TASKS = frozenset(("TaskControl",))
_REACTING = frozenset(("DeclareInterrupt", "Trigger", "ConnectInterrupt", "OnError"))


@dataclass(slots=True)
class _Loop(Generic[S]):
    breaks: list[S] = field(default_factory=list)
    passes: list[S] = field(default_factory=list)


@dataclass(slots=True)
class _Summary(Generic[S]):
    """A routine in all its runs: what it is entered with and leaves behind (None: never), and what holds at some time
    in it or in what it calls. `callers`: routines to look at again when one of the last two changes."""

    module: ir.Module
    routine: ir.Routine
    scope: Scope
    entry: S | None = None
    exit: S | None = None
    inside: S | None = None
    changes: int = 0
    followed: bool = False  # just now
    callers: dict[int, None] = field(default_factory=dict)


@dataclass(slots=True)
class _Run(Generic[S]):
    """One way through a routine. `handled`: by the identity of a state, what handlers make of it. `abandoned`: an
    interrupt may come back here from what it calls. `jumps`: what holds where a label (folded) is jumped to."""

    of: _Summary[S]
    abandoned: bool
    inside: S | None
    jumps: dict[str, S] = field(default_factory=dict)
    handlers: tuple[ir.Handler, ...] = ()
    handled: dict[int, tuple[S, S | None, S | None]] = field(default_factory=dict)
    loops: list[_Loop[S]] = field(default_factory=list)
    returns: list[S] = field(default_factory=list)
    retried: list[S] = field(default_factory=list)
    skipped: list[S] = field(default_factory=list)

    def begin(self) -> None:
        self.handlers, self.handled = self.of.routine.handlers, {}
        self.loops, self.returns, self.retried, self.skipped = [], [], [], []


class Forward(ABC, Generic[S]):
    """`start`: where a run begins. `unknown`: true at any time. States are never changed in place; None: nothing leads
    there. `heeds`: kinds of nodes (rpl.passes.legalise.kinds) outside of which `transfer` changes and `note` takes
    nothing; None: it looks at all. `beyond_stops`: what stands behind a stop that ends the program is told of as if the
    program went on there (translations end such with a guarded stop, which is to be taken away)."""

    heeds: frozenset[str] | None = None
    beyond_stops = False

    def __init__(self, program: ir.Program, start: S, unknown: S) -> None:
        self.program, self.start, self.unknown = program, start, unknown
        self.scopes = ProgramScope(program)
        self.summaries: dict[int, _Summary[S]] = {}
        self.by_name: dict[str, list[_Summary[S]]] = {}
        for module, routine in self.scopes.routines():
            made: _Summary[S] = _Summary(module, routine, self.scopes.routine(module, routine))
            self.summaries[id(routine)] = made
            self.by_name.setdefault(routine.name.lower(), []).append(made)
        kinds = kinds_in(program)
        self.abandoned = _abandoned(program) if "ResumeLevel" in kinds else None
        self.skipping = "OnError" in kinds  # failed statements may be passed over
        self.failures = self.abandoned is not None or "Handler" in kinds
        self.idle: dict[frozenset[str], bool] = {}  # statements of these kinds: does nothing look at them?
        self.waiting: dict[int, None] = {}
        self.called_in: dict[int, tuple[ir.CallRoutine | ir.Call, ...]] = {}
        self.noting = self.settled = False
        self.reaching = True  # does a run come to the routine at hand, as far as the program says?
        self.runs: list[_Run[S]] = []

    # ---- what a question says

    @abstractmethod
    def transfer(self, statement: ir.Statement, before: S) -> S | None:
        """What holds behind a statement, its calls and the bodies in it left aside; None: nothing comes behind it."""

    @abstractmethod
    def join(self, one: S, other: S) -> S:
        """What both have in common; `one` itself when the other has all of it."""

    def note(self, statement: ir.Statement, before: S) -> None:
        """Told in the end of each statement and what holds in front of it, perhaps in several parts (to be joined)."""

    def told(self, condition: ir.Expression, state: S) -> bool | None:
        """Which way a condition surely goes."""
        return None

    def entered(self, state: S, here: Scope, there: Scope) -> S:
        """What a called routine sees of it."""
        return state

    def left(self, before: S, end: S, routine: ir.Routine, there: Scope, here: Scope) -> S:
        """What holds behind a call, by what held before and by what the routine ends with."""
        return end

    def passed(self, call: ir.CallRoutine | ir.Call, state: S) -> S:
        """What holds behind a call when its arguments may be changed."""
        return state

    @property
    def run(self) -> _Run[S]:
        return self.runs[-1]

    @property
    def scope(self) -> Scope:
        """Where the statement at hand stands."""
        return self.run.of.scope

    # ---- the whole program

    def solve(self, started: Iterable[str], beside: Iterable[str]) -> None:
        """Follow the program from the routines (folded names) that a run may begin with; those `beside` are entered at
        any time."""
        self.begun = [one for name in started for one in self.by_name.get(name, ())]
        for one in self.begun:
            self.enter(one, self.start)
        for name in beside:
            for one in self.by_name.get(name, ()):
                self.enter(one, self.unknown)
        while self.waiting:
            self.follow(self.summaries[next(iter(self.waiting))])
        self.noting = self.settled = True
        for one in self.summaries.values():
            self.reaching = one.entry is not None
            self.routine(one, self.unknown if one.entry is None else one.entry)

    def enter(self, one: _Summary[S], state: S) -> None:
        joined = one.entry if self.settled else self.joined(one.entry, state)
        if joined is not one.entry and joined != one.entry:
            one.entry = self.bounded(one, joined)
            self.waiting[id(one.routine)] = None

    def bounded(self, one: _Summary[S], state: S | None) -> S | None:
        one.changes += 1
        return state if one.changes <= _MOST_CHANGES else self.unknown

    def follow(self, one: _Summary[S]) -> None:
        self.waiting.pop(id(one.routine), None)
        if one.entry is None:
            return
        one.followed = True
        end, inside = self.routine(one, one.entry)
        one.followed = False
        if end != one.exit or inside != one.inside:
            one.exit, one.inside = self.bounded(one, end), self.bounded(one, inside) if self.failures else None
            self.waiting |= one.callers

    def joined(self, *states: S | None) -> S | None:
        """What is known on every way that there is."""
        found: S | None = None
        for state in states:
            if state is not None and state is not found:
                found = state if found is None else self.join(found, state)
        return found

    # ---- one routine

    def routine(self, one: _Summary[S], entry: S) -> tuple[S | None, S | None]:
        """What it leaves behind, and what holds at some time in it."""
        routine = one.routine
        declares = self.abandoned is not None and any(
            isinstance(node, ir.DeclareInterrupt) for node in walk_for(_DECLARING, *routine.body)
        )
        run: _Run[S] = _Run(one, declares, entry if self.failures else None)
        self.runs.append(run)
        noting, self.noting = self.noting, False
        for visit in range(_MOST_CHANGES + 1):
            before = dict(run.jumps)
            end = self.anew(run, entry)
            if before == run.jumps:
                break
            if visit == _MOST_CHANGES - 1:
                run.jumps = dict.fromkeys(run.jumps, self.unknown)
        self.noting = noting
        if noting:
            end = self.anew(run, entry)
        for other in (routine.undo, routine.backward):
            self.body(other, self.unknown)
        if routine.undo and self.failures:
            run.inside = self.unknown  # an error goes on to the caller behind it
        self.runs.pop()
        return end, run.inside

    def anew(self, run: _Run[S], entry: S) -> S | None:
        """What the routine leaves behind, by what is known of its labels."""
        run.begin()
        end = self.body(run.of.routine.body, entry)
        run.handlers = ()
        return self.joined(end, *run.returns)

    def body(self, body: ir.Body, state: S | None) -> S | None:
        stopped: S | None = None
        for statement in body:
            if isinstance(statement, ir.Label):
                state = self.joined(state, self.run.jumps.get(statement.name.lower()))
            if self.beyond_stops and state is None and stopped is not None:
                stopped = self.beyond(statement, stopped)
            elif state is not None:
                stopped = state if _is_stop(statement) else None
                state = state if self.is_idle(statement) else self.statement(statement, state)
                if self.failures and state is not None and state is not self.run.inside:
                    self.run.inside = self.joined(self.run.inside, state)
            elif self.run.jumps:
                state = self.inner(statement, None)  # a jump may lead into it
        return state

    def beyond(self, statement: ir.Statement, state: S) -> S | None:
        """What a statement that only stands behind a stop would leave: nothing comes to it before somebody takes the
        stop away, and then the program goes on with what held there."""
        returns, reaching = [*self.run.returns], self.reaching
        self.reaching = False
        behind = self.statement(statement, state)
        self.run.returns, self.reaching = returns, reaching
        return state if behind is None and _is_stop(statement) else behind

    def is_idle(self, statement: ir.Statement) -> bool:
        """Does it, with all in it, leave what holds as it is, and does nobody ask what holds there?"""
        if self.heeds is None or self.run.handlers:
            return False
        kinds = kinds_within(statement)
        idle = self.idle.get(kinds)
        if idle is None:
            self.idle[kinds] = idle = kinds.isdisjoint(self.heeds) and kinds.isdisjoint(_WAYS)
        return idle

    def statement(self, statement: ir.Statement, state: S) -> S | None:
        skipped: S | None = None
        if self.run.handlers:
            state, skipped = self.failing(statement, state)
        return self.joined(self.inner(statement, state), skipped)

    def failing(self, statement: ir.Statement, state: S) -> tuple[S, S | None]:
        """What holds in front of a statement that handlers may repeat, and behind it where they pass it over."""
        if _cannot_fail(statement):
            return state, None
        skipped: S | None = None
        for _ in range(_MOST_CHANGES):
            found = [state]
            for call in self.calls_in(statement):
                found += [
                    self.left(state, one.inside, one.routine, one.scope, self.scope)
                    for one in self.meant(call)
                    if one.inside is not None
                ]
            again: S | None = state
            for one in found:
                _, retried, behind = self.handled(one)
                again, skipped = self.joined(again, retried), self.joined(skipped, behind)
            if again is None or again == state:
                return state, skipped
            state = again
        return self.unknown, self.unknown

    def handled(self, state: S) -> tuple[S, S | None, S | None]:
        """What the handlers repeat a statement with that fails in this state, and what they go on with behind it."""
        run = self.run
        known = run.handled.get(id(state))
        if known is not None:
            return known
        handlers, run.handlers = run.handlers, ()
        outside = run.loops, run.retried, run.skipped
        run.loops, run.retried, run.skipped = [], [], []
        for handler in handlers:
            end = self.body(handler.body, state)
            run.returns += [] if end is None else [end]
        found = state, self.joined(*run.retried), self.joined(*run.skipped)
        run.loops, run.retried, run.skipped = outside
        run.handlers, run.handled[id(state)] = handlers, found
        return found

    # ---- statements

    def inner(self, statement: ir.Statement, state: S | None) -> S | None:
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                self.noted(statement, state)
                return self.choice(branches, otherwise, state)
            case ir.Switch(selector=selector, cases=cases, default=default):
                self.noted(statement, state)
                chosen = self.called(selector, state)
                ends = [self.body(case.body, chosen) for case in cases]
                return self.joined(*ends, self.body(default or (), chosen))
            case ir.While() | ir.For() | ir.Repeat() | ir.Loop():
                return self.loop(statement, state)
            case ir.Spline(body=body):
                return self.body(body, self.simple(statement, state))
        return self.simple(statement, state)

    def noted(self, statement: ir.Statement, state: S | None) -> None:
        if self.noting and state is not None:
            self.note(statement, state)

    def choice(
        self, branches: tuple[tuple[ir.Expression, ir.Body], ...], otherwise: ir.Body, state: S | None
    ) -> S | None:
        ends: list[S | None] = []
        for condition, body in branches:
            state = self.called(condition, state)
            known = None if state is None else self.told(condition, state)
            ends.append(self.body(body, None if known is False else state))
            state = None if known is True else state
        return self.joined(*ends, self.body(otherwise, state))

    def loop(self, loop: ir.While | ir.For | ir.Repeat | ir.Loop, state: S | None) -> S | None:
        start = state if isinstance(loop, ir.Repeat) else self.called(loop, state)
        start = None if start is None else self.transfer(loop, start)
        skipped: S | None = None
        for _ in range(_MOST_CHANGES):
            if self.run.handlers and start is not None:
                start, skipped = self.failing(loop, start)
            self.noted(loop, start)
            jumps: _Loop[S] = _Loop()
            self.run.loops.append(jumps)
            end = self.body(loop.body, start)
            self.run.loops.pop()
            end = self.joined(end, *jumps.passes)
            match loop:
                case ir.Repeat(until=condition) | ir.While(condition=condition):
                    end = self.called(condition, end)
            again = self.joined(start, end)
            if again == start:
                left = {ir.Loop: None, ir.Repeat: end}.get(loop.__class__, start)
                if _has_a_pass(loop) and start is not None:
                    left = None if end is None else self.transfer(loop, end)
                return self.joined(left, skipped, *jumps.breaks)
            start = again
        return self.unknown

    def simple(self, statement: ir.Statement, state: S | None) -> S | None:
        if state is None:
            return None
        match statement:
            case ir.ExitLoop() | ir.NextPass() if self.run.loops:
                kept = self.run.loops[-1].breaks if isinstance(statement, ir.ExitLoop) else self.run.loops[-1].passes
                kept.append(state)
                return None
            case ir.Goto(label=label):
                joined = self.joined(self.run.jumps.get(label.lower()), state)
                if joined is not None:
                    self.run.jumps[label.lower()] = joined
                return None
        behind = self.called(statement, state)
        if behind is None:
            return None
        self.noted(statement, behind)
        match statement:
            case ir.Return():
                self.run.returns.append(behind)
                return None
            case ir.Retry() | ir.TryNext():
                (self.run.retried if isinstance(statement, ir.Retry) else self.run.skipped).append(behind)
                return None
            case ir.Raise() if self.skipping:
                return behind
            case ir.Raise() | ir.ResumeLevel() | ir.Halt(kind="exit"):
                return None
            case ir.Halt(kind="cycle"):
                for one in self.begun:
                    self.enter(one, behind)
                return None
        after = self.transfer(statement, behind)
        if self.skipping and after is not behind and not _cannot_fail(statement):
            after = self.joined(after, behind)
        return after

    # ---- calls

    def calls_in(self, node: ir.Statement | ir.Expression) -> tuple[ir.CallRoutine | ir.Call, ...]:
        """The calls of a statement itself, or of an expression, in their order."""
        if not is_expression(node) and _CALLS.isdisjoint(kinds_within(node)):
            return ()
        found = self.called_in.get(id(node))
        if found is None:
            own = (node,) if isinstance(node, ir.CallRoutine | ir.Call) else ()
            inner = [call for part in children(node) for call in self.calls_in(part)]
            found = (*inner, *own)
            if not is_expression(node) or found:
                self.called_in[id(node)] = found
        return found

    def called(self, node: ir.Statement | ir.Expression, state: S | None) -> S | None:
        """The state behind the calls of a statement itself, or of an expression."""
        for call in self.calls_in(node) if state is not None else ():
            state = None if state is None else self.behind(call, state)
        return state

    def meant(self, call: ir.CallRoutine | ir.Call) -> list[_Summary[S]]:
        """Routines of the program that a call may run."""
        if isinstance(call, ir.CallRoutine) and call.dynamic is not None:
            return [one for one in self.summaries.values() if _may_take(one.routine, call)]
        routine = self.scope.routine(call.name)
        found = None if routine is None else self.summaries.get(id(routine))
        return [found] if found is not None else self.by_name.get(call.name.lower(), [])[:1]

    def may_leave(self, call: ir.CallRoutine | ir.Call) -> bool:
        """May an interrupt end the called routine at any place and come back here?"""
        known = isinstance(call, ir.CallRoutine) and self.abandoned is not None
        return self.run.abandoned and (not known or id(call) in (self.abandoned or ()))

    def behind(self, call: ir.CallRoutine | ir.Call, state: S) -> S | None:
        dynamic = isinstance(call, ir.CallRoutine) and call.dynamic is not None
        found = self.meant(call)
        ends: list[S | None] = [self.unknown] if dynamic else [] if found else [state]
        here = self.run.of
        for one in found:
            self.enter(one, self.entered(state, here.scope, one.scope))
            one.callers[id(here.routine)] = None
            if id(one.routine) in self.waiting and not one.followed:
                self.follow(one)
            ends.append(None if one.exit is None else self.left(state, one.exit, one.routine, one.scope, here.scope))
            if one.inside is not None and self.failures:
                within = self.left(state, one.inside, one.routine, one.scope, here.scope)
                self.run.inside = self.joined(self.run.inside, within)
                ends.append(within if self.may_leave(call) else None)
        after = self.joined(*ends)
        return None if after is None else self.passed(call, after)


def _abandoned(program: ir.Program) -> frozenset[int]:
    """Identities of the calls that interrupts may abandon with what they call."""
    leaving = doing(program, lambda node: isinstance(node, ir.ResumeLevel))
    declaring: set[str] = set()
    marked: frozenset[int] = frozenset()
    for module in program.modules:
        for routine in module.routines:
            for node in walk(*bodies(routine)):
                match node:
                    case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) if name.lower() in leaving:
                        declaring.add(routine.name.lower())
                        marked |= armed_statements(program, _Leaving(node.identity or node.priority))
    return with_calls(program, marked, frozenset(declaring))


@dataclass(frozen=True, slots=True)
class _Leaving:
    """An interrupt by its number or the value that names it."""

    key: ir.Expression

    def arms(self, statement: ir.ControlInterrupt) -> bool | None:
        handle, key = statement.handle, self.key
        if statement.op not in ("on", "off", "delete"):
            return None
        if isinstance(handle, ir.IntLiteral) and isinstance(key, ir.IntLiteral):
            return statement.op == "on" if handle.value == key.value else None
        sure = handle is None or handle == key
        return True if statement.op == "on" else False if sure else None


def _may_take(routine: ir.Routine, call: ir.CallRoutine) -> bool:
    """Could a call by a text mean it?"""
    needed = sum(1 for one in routine.parameters if not one.optional)
    return routine.kind == "procedure" and needed <= len(call.arguments) <= len(routine.parameters)


def _cannot_fail(statement: ir.Statement) -> bool:
    """Does it surely run to its end?"""
    match statement:
        case ir.Assign(target=ir.System(indices=()), value=value):
            return all(isinstance(one, _SURE) for one in walk(value))
    return isinstance(statement, ir.Nothing | ir.Label | ir.Goto | ir.ExitLoop | ir.NextPass)


def _has_a_pass(loop: ir.Statement) -> bool:
    """Does the body of a counting loop surely run?"""
    match loop:
        case ir.For(start=ir.IntLiteral(value=start), stop=ir.IntLiteral(value=stop), step=None):
            return start <= stop
    return False


def _is_stop(statement: ir.Statement) -> bool:
    """Does it end the program?"""
    return isinstance(statement, ir.Halt) and statement.kind == "exit"


# ---- where a program is entered


def started(program: ir.Program) -> list[str]:
    """Routines that a run may begin with."""
    begins = {program.entry.lower(), *(task.entry.lower() for task in program.tasks if task.kind == "motion")} - {""}
    beside = {task.entry.lower() for task in program.tasks}
    return sorted((begins or never_called(program)) | beside)


def beside(program: ir.Program) -> list[str]:
    """Routines that something else than a call may run."""
    nodes = walk_for(_TASKS, *program.modules)
    tasks = {node.task for node in nodes if isinstance(node, ir.TaskControl)}
    return sorted({name.lower() for name in (*tasks, *reactions(program))})


def reactions(program: ir.Program) -> Iterator[str]:
    for node in walk_for(_REACTING, *program.modules):
        match node:
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
                yield name
            case ir.ConnectInterrupt(routine=name) | ir.OnError(routine=str() as name):
                yield name
    for module in program.modules:
        yield from (one.name for one in module.routines if one.kind == "trap")


__all__ = ["Forward", "beside", "reactions", "started"]
