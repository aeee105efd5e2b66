"""Waits that only hold the robot (V+ DELAY), for targets whose waits hold the program.

Assignments behind such a wait, outputs and timers among them, also in branches, are done in front of it, when the robot
stands. That is the same where the next step drives or waits for the robot. In front of any other step, and where the
end of a routine does not tell what comes next, the target's program waits first, and that is told.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import called_names
from rpl.passes.legalise.kinds import walk_for
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
_WAITING = (ir.Move, ir.MoveExternal, ir.Spline, ir.WaitForMotion, ir.Halt)


@legalising(sees=("Wait",))
def queued_waits(program: ir.Program, context: Context) -> ir.Program:
    """Only from controllers whose waits at rest are moves to others."""
    source, target = (rules_of(one).advance.waits_queue for one in (context.source, context.target))
    if not source or target or not any(_queues(node) for node in walk_for({"Wait"}, *program.modules)):
        return program
    called = called_names(routine for module in program.modules for routine in module.routines)
    timed = any(map(_takes_a_time, walk_for({"System", "Clock", "Builtin", "OrderInterrupt"}, *program.modules)))

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker = _Queued(context, editor, timed)
        return edit_bodies(routine, partial(worker.body, behind=routine.name.lower() not in called))

    return edit_routines(program, context, work)


class _Queued:
    """timed: does the program take a time anywhere, so that a pause in another place would be seen?"""

    def __init__(self, context: Context, editor: Editor, timed: bool) -> None:
        self.context, self.editor, self.timed = context, editor, timed

    def body(self, body: ir.Body, behind: bool) -> ir.Body:
        """`behind`: what comes behind the body waits for the robot."""
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement, at = body[at], at + 1
            if isinstance(statement, ir.Wait) and statement.in_position:
                end = next((i for i in range(at, len(body)) if not _quick(body[i])), len(body))
                done.extend(self.pause(statement, body[at:end], body[end:], behind))
                at = end
            elif blocks(statement):
                after = _waits(body[at:], behind)
                if isinstance(statement, LOOPS):
                    after = after and _waits(statement.body, after)
                done.append(inside(statement, partial(self.body, behind=after)))
            else:
                done.append(statement)
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def pause(self, wait: ir.Wait, steps: ir.Body, rest: ir.Body, behind: bool) -> Sequence[ir.Statement]:
        """The wait, behind the steps that the program does beside it."""
        if not _waits(rest, behind):
            if self.timed and not any(isinstance(one, _WAITING) for one in rest):
                return (stopped(wait, PAUSED_TIMED, self.context), *steps)
            if any(_takes_a_time(node) or (self.timed and _calls(node)) for node in walk(*rest)):
                return (stopped(wait, PAUSED_TIMED, self.context), *steps)
            if rest:
                self.context.diagnostics.report(PAUSED_FIRST, wait.origin, line=rest[0].origin.line)
            else:
                self.context.diagnostics.report(PAUSED_AT_END, wait.origin)
        if all(isinstance(one, ir.Nothing) for one in steps):
            return (wait, *steps)
        stands, last = ir.WaitForMotion(origin=wait.origin), replace(wait, origin=tidy(wait.origin))
        if isinstance(wait.time, ir.IntLiteral | ir.RealLiteral):
            return (stands, *steps, last)
        kept = self.editor.temporary("pause", ir.RealType())
        return (stands, ir.Assign(kept, wait.time, origin=tidy(wait.origin)), *steps, replace(last, time=kept))


def _calls(node: object) -> bool:
    return isinstance(node, ir.CallRoutine | ir.Call)


def _queues(node: object) -> bool:
    return isinstance(node, ir.Wait) and node.in_position


def _quick(statement: ir.Statement) -> bool:
    """Does the step take no time and leave the robot alone? Functions of the source's own only calculate."""
    if isinstance(statement, ir.If):
        return all(_quick(one) for body in blocks(statement) for one in body)
    return isinstance(statement, ir.Nothing | ir.Assign)


def _waits(rest: ir.Body, behind: bool) -> bool:
    """Does the next step wait for the robot?"""
    following = next((one for one in rest if not isinstance(one, ir.Nothing)), None)
    return behind if following is None else _queues(following) or isinstance(following, _WAITING)


def _takes_a_time(node: object) -> bool:
    """Does it ask for a time, or begin one?"""
    match node:
        case ir.System(name="timer" | "timer_stopped" | "timer_positive" | "time") | ir.Clock():
            return True
        case ir.Builtin(function="clock_seconds") | ir.OrderInterrupt(event="timer"):
            return True
    return False


__all__ = ["queued_waits"]
