"""Waits that only hold the robot (V+ DELAY), for targets whose waits hold the program.

What the program does beside such a wait, up to the next step that drives or waits for the robot, is done in front of
it, when the robot stands. That is the same where those steps take no time; in front of one that does (a wait for a
signal, a routine with such waits), and where the end of a routine or a label does not tell what comes next, the
target's program waits first, and that is told.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import assigned_in, doing
from rpl.passes.legalise.rewriting.beside import tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import LOOPS, inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising

PAUSED_FIRST = code(
    "pause-first",
    Severity.WARNING,
    "the source's robot pauses here while its program goes on with line {line}; the target's program does that when "
    "the pause has ended",
    "write the step in front of the pause where the time matters",
)
PAUSED_AT_END = code(
    "pause-at-end",
    Severity.WARNING,
    "the source's robot pauses here while its program goes on behind this part of it; the target's program goes on "
    "when the pause has ended",
)
PAUSED_TIMED = code(
    "pause-timed",
    Severity.LOSS,
    "the source's robot pauses here while its program goes on and takes a time; the target's program would take that "
    "when the pause has ended",
    "take the time in front of the pause, or wait for the robot in front of it",
    stops=True,
)
_DRIVES = (ir.Move, ir.MoveExternal, ir.Spline)
_SLOW = (
    *(*_DRIVES, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Dialog, ir.Halt, ir.Loop, ir.Vendor, ir.Opaque),
    *(ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.StoreMotion, ir.ResumeLevel, ir.Critical, ir.Meet),
)
_LEAVES = (ir.Label, ir.Goto, ir.Return, ir.ExitLoop, ir.NextPass, ir.Raise, ir.Retry, ir.TryNext)
_DEEPEST = 8  # calls in calls that are looked into


@legalising(sees=("Wait",))
def queued_waits(program: ir.Program, context: Context) -> ir.Program:
    """Only from controllers whose waits at rest are moves to others."""
    source, target = (rules_of(one).advance.waits_queue for one in (context.source, context.target))
    if not source or target or not any(_queues(node) for node in walk(*program.modules)):
        return program
    facts = _Facts(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker = _Queued(context, editor, facts)
        behind = facts.ends.get(routine.name.lower(), True)
        return edit_bodies(routine, lambda body: worker.body(body, behind))

    return edit_routines(program, context, work)


class _Facts:
    """slow: routines whose steps take time or move the robot; timed: those that ask for a time or begin one; ends:
    does each way on from the end of a routine begin with a step that waits for the robot? Names in lower case."""

    def __init__(self, program: ir.Program) -> None:
        self.slow, self.timed = doing(program, _takes_time), doing(program, _takes_a_time)
        self.routines = {one.name.lower(): one for module in program.modules for one in module.routines}
        self.ends = dict.fromkeys(self.routines, True)
        for node in walk(*program.modules):
            match node:
                case ir.Call(name=name) | ir.ConnectInterrupt(routine=name) | ir.OnError(routine=str(name)):
                    self.ends[name.lower()] = False
                case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)):
                    self.ends[name.lower()] = False
        while True:
            before = dict(self.ends)
            for name, routine in self.routines.items():
                for body in bodies(routine):
                    self.note(body, self.ends[name])
            if before == self.ends:
                break

    def note(self, body: ir.Body, behind: bool) -> None:
        """What stands behind the calls."""
        for at, statement in enumerate(body):
            if isinstance(statement, ir.CallRoutine) and not self.wait(body[at + 1 :], behind):
                self.ends[statement.name.lower()] = False
            for inner in blocks(statement):
                self.note(inner, self.after(statement, body[at + 1 :], behind))

    def after(self, statement: ir.Statement, rest: ir.Body, behind: bool) -> bool:
        """Does what comes behind a body of the statement wait for the robot?"""
        behind = self.wait(rest, behind)
        return all(self.wait(inner, behind) for inner in blocks(statement)) and behind if _loops(statement) else behind

    def wait(self, rest: ir.Body, behind: bool, depth: int = 0) -> bool:
        """Does the next step wait for the robot?"""
        for at, statement in enumerate(rest):
            if isinstance(statement, ir.Nothing):
                continue
            if any(isinstance(node, ir.Call) for node in walk(statement)):
                return False
            match statement:
                case ir.If() | ir.Switch() | ir.For() | ir.While():
                    behind = self.wait(rest[at + 1 :], behind, depth)
                    within = all(self.wait(inner, behind, depth) for inner in blocks(statement))
                    return within and behind if _loops(statement) else within
                case ir.CallRoutine(name=name, dynamic=None) if depth < _DEEPEST and name.lower() in self.routines:
                    after = self.wait(rest[at + 1 :], behind, depth + 1)
                    return self.wait(self.routines[name.lower()].body, after, depth + 1)
            return _queues(statement) or isinstance(statement, (*_DRIVES, ir.WaitForMotion, ir.Halt))
        return behind

    def asks_time(self, rest: ir.Body) -> bool:
        """Do the steps behind a pause take a time, here or where the routine comes back to?"""
        if not any(_queues(node) or isinstance(node, (*_DRIVES, ir.WaitForMotion, ir.Halt)) for node in rest):
            return bool(self.timed)
        return any(_takes_a_time(node) or _calls(node, self.timed) for node in walk(*rest))

    def quick(self, statement: ir.Statement) -> bool:
        """Does the step take no time, leave the robot alone, and go on behind itself?"""
        for node in walk(statement):
            if isinstance(node, _LEAVES) or _takes_time(node):
                return False
            match node:
                case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                    return False
                case ir.CallRoutine(name=name) | ir.Call(name=name) if name.lower() in self.slow:
                    return False
        return True


class _Queued:
    def __init__(self, context: Context, editor: Editor, facts: _Facts) -> None:
        self.context, self.editor, self.facts = context, editor, facts

    def body(self, body: ir.Body, behind: bool) -> ir.Body:
        """`behind`: what comes behind the body waits for the robot."""
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement, at = body[at], at + 1
            if isinstance(statement, ir.Wait) and _queues(statement):
                end = next((i for i in range(at, len(body)) if not self.facts.quick(body[i])), len(body))
                done.extend(self.pause(statement, body[at:end], body[end:], behind))
                at = end
            elif blocks(statement):
                after = self.facts.after(statement, body[at:], behind)
                done.append(inside(statement, partial(self.body, behind=after)))
            else:
                done.append(statement)
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def pause(self, wait: ir.Wait, steps: ir.Body, rest: ir.Body, behind: bool) -> Sequence[ir.Statement]:
        """The wait, behind the steps that the program does beside it."""
        if not self.facts.wait(rest, behind):
            if self.facts.asks_time(rest):
                return (stopped(wait, PAUSED_TIMED, self.context), *steps)
            following = next((one for one in rest if not isinstance(one, ir.Nothing)), None)
            if following is None:
                self.context.diagnostics.report(PAUSED_AT_END, wait.origin)
            else:
                self.context.diagnostics.report(PAUSED_FIRST, wait.origin, line=following.origin.line)
        if all(isinstance(one, ir.Nothing) for one in steps):
            return (wait, *steps)
        stands = ir.WaitForMotion(origin=wait.origin)
        last = replace(wait, origin=tidy(wait.origin))
        if not _may_change(wait.time, steps):
            return (stands, *steps, last)
        kept = self.editor.temporary("pause", ir.RealType())
        keep = ir.Assign(kept, wait.time, origin=tidy(wait.origin))
        return (stands, keep, *steps, replace(last, time=kept))


def _queues(node: object) -> bool:
    return isinstance(node, ir.Wait) and node.in_position


def _loops(statement: ir.Statement) -> bool:
    return isinstance(statement, LOOPS)


def _takes_time(node: object) -> bool:
    match node:
        case ir.Message(kind="quit") | ir.TaskControl(op="join"):
            return True
        case ir.While(condition=condition) | ir.Repeat(until=condition):
            return any(isinstance(one, ir.Signal | ir.System | ir.Call) for one in walk(condition))
    return isinstance(node, _SLOW)


def _takes_a_time(node: object) -> bool:
    """Does it ask for a time, or begin one?"""
    match node:
        case ir.System(name="timer" | "timer_stopped" | "timer_positive" | "time") | ir.Clock():
            return True
        case ir.Builtin(function="clock_seconds") | ir.OrderInterrupt(event="timer"):
            return True
    return False


def _calls(node: object, routines: Collection[str]) -> bool:
    match node:
        case ir.CallRoutine(name=name) | ir.Call(name=name):
            return name.lower() in routines
    return False


def _may_change(time: ir.Expression, steps: ir.Body) -> bool:
    """May the steps change how long the wait is?"""
    names = {node.id.lower() for node in walk(time) if isinstance(node, ir.Name)}
    if any(isinstance(node, ir.System | ir.Signal | ir.Call) for node in walk(time)):
        return True
    calls = any(isinstance(node, ir.CallRoutine | ir.Call | ir.Do) for node in walk(*steps))
    return bool(names) and (calls or any(name.lower() in names for name in assigned_in(steps)))


__all__ = ["queued_waits"]
