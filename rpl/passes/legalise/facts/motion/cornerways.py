"""Where the robot may be when a step of the program is done, along all its ways: it stands, drives to a stop, or is at
a corner. Branches, loops, labels and calls are followed; how a call ends is kept for each routine as a whole.

Passes ask for the corners that steps of theirs put an end to, because the program waits for the robot there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.facts.effects import blocks, children
from rpl.passes.legalise.settings.explicit import EARLY_LOGIC
from rpl.passes.scope import Scope
from rpl.source import Origin

# Where the robot may be: it stands, it drives to a stop, or as at the start of the routine; else at a corner (origin).
STANDS, STOPPING, ENTRY = "stands", "stopping", "entry"
Where = frozenset[str | Origin]
State = Where | None  # None: no way leads here
_ROUNDS = 12
# Steps at which the robot of the source stands too.
RESTS = ("Wait", "WaitForMotion", "Halt", "Message", "Dialog", "ResumeLevel")
_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)
Waits = Callable[[ir.Statement, Scope], bool]


class Ways:
    """The ways of a program. `waits`: does the step wait for the robot; `may_run_on`: may it be marked so that it does
    not. `stopped`: corners that such a step puts an end to, and its line."""

    def __init__(self, program: ir.Program, context: Context, waits: Waits, may_run_on: Waits | None = None) -> None:
        self.program, self.context, self.waits, self.may_run_on = program, context, waits, may_run_on
        self.scopes = ProgramScope(program)
        self.ends: dict[str, Where] = {}  # where the robot is when a routine (folded name) ends
        self.stopped: dict[Origin, int] = {}
        self.begins: dict[str, int] = {}  # routines that wait for the robot before it moves, and where
        self.telling = False

    def followed(self) -> ir.Program | None:
        """The program with the marks; None where the ways of calls come to no end."""
        for _ in range(_ROUNDS):
            before = dict(self.ends)
            self.everywhere()
            if before == self.ends:
                self.telling = True
                return self.everywhere()
        return None

    def everywhere(self) -> ir.Program:
        modules = []
        for module in self.program.modules:
            routines = []
            for routine in module.routines:
                way = _Way(self, self.scopes.routine(module, routine), routine.name.lower())
                done = replace(routine, body=way.routine(routine.body))
                done = replace(done, handlers=tuple(map(way.handler, routine.handlers)))
                self.ends[routine.name.lower()] = way.end
                routines.append(done if self.telling else routine)
            modules.append(replace(module, routines=tuple(routines)))
        return replace(self.program, modules=tuple(modules))


class _Way:
    """One routine."""

    def __init__(self, ways: Ways, scope: Scope, name: str) -> None:
        self.ways, self.scope, self.name = ways, scope, name
        self.end: Where = frozenset()
        self.labels: dict[str, Where] = {}
        self.exits: list[State] = []
        self.final = False
        # What a loop (by identity, and where the robot is before it) comes to. Loops in loops are asked often.
        self.loops: dict[tuple[int, Where], tuple[Where, list[ir.Statement], State]] = {}

    def routine(self, body: ir.Body) -> ir.Body:
        state: State = None
        for _ in range(_ROUNDS):
            before = dict(self.labels)
            state = self.body(body, frozenset((ENTRY,)))[1]
            if before == self.labels:
                break
        self.final = self.ways.telling
        done, state = self.body(body, frozenset((ENTRY,)))
        self.end = (state or frozenset()) | self.end
        return done

    def handler(self, handler: ir.Handler) -> ir.Handler:
        """The handler, which begins wherever the error came; the routine may end behind it too."""
        done, state = self.body(handler.body, frozenset((STOPPING,)))
        self.end |= state or frozenset()
        return replace(handler, body=done)

    def body(self, body: ir.Body, state: State) -> tuple[ir.Body, State]:
        done: list[ir.Statement] = []
        for statement in body:
            allowed = bool(done) and isinstance(done[-1], ir.LookAhead)
            new, state = self.statement(statement, state, allowed)
            done.extend(new)
        return tuple(done), state

    def statement(self, statement: ir.Statement, state: State, allowed: bool) -> tuple[list[ir.Statement], State]:
        match statement:
            case ir.Nothing() | ir.LookAhead() | ir.Trigger():
                return [statement], state
            case ir.Label(name=name):
                state = _either(state, self.labels.get(name.lower()))
                return [statement], state
            case ir.Goto(label=name):
                before = self.labels.get(name.lower())
                now = _either(before, state) or frozenset()
                if now != before:
                    self.labels[name.lower()] = now
                    self.loops.clear()
                return [statement], None
            case ir.Return():
                self.end |= state or frozenset()
                return [statement], None
            case ir.ExitLoop() | ir.NextPass():
                if self.exits:
                    self.exits[-1] = _either(self.exits[-1], state)
                return [statement], None
        if state is None:
            return [statement], None
        match statement:
            case ir.Move(blend=blend, concurrent=concurrent):
                corner = blend not in (None, ir.BlendStop()) and not concurrent
                return [statement], frozenset((statement.origin if corner else STOPPING,))
            case ir.Spline() | ir.MoveExternal():
                return [statement], frozenset((STOPPING,))
            case ir.WaitForMotion():
                return [statement], frozenset((STANDS,))
            case ir.CallRoutine(name=name, dynamic=dynamic):
                state = self.passed(statement, state, allowed)
                left = self.ways.ends.get(name.lower()) if dynamic is None else None
                if dynamic is None and (line := self.ways.begins.get(name.lower())) is not None:
                    self.stands(state, line)
                return [statement], _through(left, state)
        if blocks(statement):
            return self.choice(statement, state, allowed)
        return self.step(statement, state, allowed)

    def step(self, statement: ir.Statement, state: Where, allowed: bool) -> tuple[list[ir.Statement], State]:
        """One that has no others in it."""
        kept = {STANDS} >= {where for where in state if isinstance(where, str)}
        cornered = any(isinstance(where, Origin) for where in state)
        may = self.ways.may_run_on
        if not allowed and kept and cornered and may is not None and may(statement, self.scope):
            if self.final:
                self.ways.context.diagnostics.report(EARLY_LOGIC, statement.origin)
            mark = ir.LookAhead(origin=replace(statement.origin, comments=()))
            return [mark, statement], state
        return [statement], self.passed(statement, state, allowed)

    def choice(self, statement: ir.Statement, state: Where, allowed: bool) -> tuple[list[ir.Statement], State]:
        """A choice or a loop."""
        first = not isinstance(statement, ir.Repeat)  # its condition is looked at behind the body
        after = self.passed(statement, state, allowed) if first else state
        if isinstance(statement, _LOOPS):
            return self.loop(statement, after)
        ends: State = None
        bodies = []
        for inner in blocks(statement):
            new, end = self.body(inner, after)
            bodies.append(new)
            ends = _either(ends, end)
        match statement:
            case ir.If(branches=branches):
                chosen = tuple((test, new) for (test, _), new in zip(branches, bodies, strict=False))
                done: ir.Statement = replace(statement, branches=chosen, otherwise=bodies[-1])
            case ir.Switch(cases=cases, default=default):
                cased = tuple(replace(case, body=new) for case, new in zip(cases, bodies, strict=False))
                done = replace(statement, cases=cased, default=None if default is None else bodies[-1])
            case _:
                done = statement
        return [done], ends

    def loop(
        self, statement: ir.For | ir.While | ir.Repeat | ir.Loop, state: Where
    ) -> tuple[list[ir.Statement], State]:
        key = (id(statement), state)
        known = self.loops.get(key)
        if known is not None and not self.final:
            return known[1], known[2]
        final, self.final = self.final, False
        begins = known[0] if known is not None else state
        for _ in range(_ROUNDS):
            body, end, left = self.turn(statement.body, begins)
            back = self.passed(statement, end, False) if end is not None else None
            if not (back or frozenset()) - begins:
                break
            begins |= back or frozenset()
        else:
            body, end, left = self.turn(statement.body, begins)
        self.final = final
        if final:
            body, end, left = self.turn(statement.body, begins)
        back = self.passed(statement, end, False) if end is not None else None
        behind = left if isinstance(statement, ir.Loop) else _either(left, back)
        behind = _either(behind, state) if isinstance(statement, ir.For | ir.While) else behind
        done: list[ir.Statement] = [replace(statement, body=body)]
        if not final:
            self.loops[key] = begins, done, behind
        return done, behind

    def turn(self, body: ir.Body, state: State) -> tuple[ir.Body, State, State]:
        self.exits.append(None)
        new, end = self.body(body, state)
        return new, end, self.exits.pop()

    # ---- what waits

    def passed(self, statement: ir.Statement, state: Where, allowed: bool) -> Where:
        """Where the robot is once the step itself, without those in it, is done."""
        for name in _called(statement):
            state = _through(self.ways.ends.get(name), state)
        if allowed or not self.ways.waits(statement, self.scope):
            return state
        self.stands(state, statement)
        return frozenset((STANDS,))

    def stands(self, state: Where, by: ir.Statement | int) -> None:
        """The robot stops where it may be, because of this step, or one in that line."""
        if isinstance(by, int):
            line = by
        elif by.__class__.__name__ in RESTS:
            return
        else:
            line = by.origin.line
        if ENTRY in state:
            self.ways.begins.setdefault(self.name, line)
        if self.final:
            for where in state:
                if isinstance(where, Origin):
                    self.ways.stopped.setdefault(where, line)


def _either(one: State, other: State) -> State:
    if one is None or other is None:
        return one if other is None else other
    return one | other


def _through(left: Where | None, state: Where) -> Where:
    """Where the robot is behind a call; None: one cannot tell."""
    if left is None:
        return frozenset((STOPPING,))
    return (left - {ENTRY}) | state if ENTRY in left else left


def _called(statement: ir.Statement) -> set[str]:
    """Functions in the expressions of a step."""
    return {node.name.lower() for node in walk(*children(statement)) if isinstance(node, ir.Call)}


__all__ = ["Ways"]
