"""Steps behind a corner that ask for signals, times or the robot's place, where the source's program comes to them when
the corner begins and the target's program comes there at another time: the robot stops at that corner.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.advance import looks, touches
from rpl.passes.legalise.facts.usage import doing, usage_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.settings.explicit import Modal
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

__all__ = ["STOPS_BEHIND", "corner_steps"]

STOPS_BEHIND = code(
    "corner-stops-behind",
    Severity.WARNING,
    "the robot stops at this corner: the target's program waits for it in line {line}",
    "where the corner matters, do this in front of the move",
)
_DRIVING = (ir.Move, ir.MoveExternal, ir.Spline)
_UNKNOWN = (*_DRIVING, ir.WaitForMotion, ir.Label, ir.Goto, ir.Halt, ir.Raise)
_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)
_TIMES = frozenset(("timer", "timer_stopped", "timer_positive", "time"))


@legalising()
def corner_steps(program: ir.Program, context: Context) -> ir.Program:
    """Only where the source's program goes on at a corner, and the target's at another time."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    if source.runs_ahead_of != "fly_by" or source.signals_stop:
        return program
    ahead = target.runs_ahead_of == "all" and "LookAhead" in context.capabilities.statements
    if not ahead and target.runs_ahead_of != "begun":
        return program
    busy, assigned = doing(program, _is_busy), usage_of(program).assigned

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        modal = Modal(context, editor.scope, assigned, set())
        return edit_bodies(routine, _Corners(context, editor.scope, modal, busy).body)

    return edit_routines(program, context, work)


class _Corners:
    """Rewrites one routine. `busy`: routines (folded) that drive the robot, wait, or ask for what is now."""

    def __init__(self, context: Context, scope: Scope, modal: Modal, busy: frozenset[str]) -> None:
        self.context, self.scope, self.modal, self.busy = context, scope, modal, busy

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for at, statement in enumerate(body):
            if isinstance(statement, ir.Move) and self.goes_over(statement):
                asking = self.of_now(self.behind(body[at + 1 :]))
                if asking is not None:
                    self.context.diagnostics.report(STOPS_BEHIND, statement.origin, line=asking.origin.line)
                    statement = replace(statement, blend=ir.BlendStop())
                done.append(statement)
            else:
                done.append(inside(statement, self.body))
        same = all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def goes_over(self, move: ir.Move) -> bool:
        """Does the robot certainly drive through a corner into the next move?"""
        if move.concurrent or move.search is not None or move.motion_class != "classic":
            return False
        match move.blend:
            case None | ir.BlendStop():
                return False
            case ir.BlendZone(zone=zone, distance=None):
                return self.modal.component(zone, "stop") == ir.BoolLiteral(False)
        return True

    def behind(self, rest: ir.Body) -> ir.Body:
        """The steps before the next one that drives the robot, waits for it, leaves the list, or calls what may."""
        found: list[ir.Statement] = []
        for step in rest:
            if isinstance(step, ir.LookAhead | ir.Trigger) or any(map(self.unknown, walk(step))):
                break
            if isinstance(step, _LOOPS) and self.asks(step):  # it asks again and again: the robot comes to rest
                break
            found.append(step)
        return tuple(found)

    def unknown(self, node: object) -> bool:
        match node:
            case ir.CallRoutine(name=name, dynamic=dynamic):
                return dynamic is not None or name.lower() in self.busy
            case ir.Call(name=name):
                return name.lower() in self.busy
        return isinstance(node, _UNKNOWN)

    def of_now(self, steps: ir.Body) -> ir.Statement | None:
        """The first step for which it matters when it is done, more than for outputs alone. None where the robot stands
        first."""
        for step in steps:
            match step:
                case ir.WaitUntil(in_position=True) | ir.Wait() | ir.Message() | ir.Dialog():
                    return None
                case ir.Assign(target=ir.Name() | ir.Signal(kind="digital_out"), value=ir.BoolLiteral()):
                    continue  # an action on the path, where it is an output
            if self.asks(step):
                return step
        return None

    def asks(self, step: ir.Statement) -> bool:
        return any(_asks(node) or _touches(node, self.scope) for node in walk(step))


def _is_busy(node: object) -> bool:
    """Does it drive the robot, wait, or ask for what is now?"""
    return isinstance(
        node, (*_DRIVING, ir.WaitForMotion, ir.Halt, ir.Raise, ir.Wait, ir.Message, ir.Dialog, ir.TaskControl)
    ) or _asks(node)


def _asks(node: object) -> bool:
    """Does it ask for a signal, the time or the place, or begin or end a measurement of time?"""
    match node:
        case ir.Signal() | ir.Clock() | ir.WaitUntil():
            return True
        case ir.System(name=name):
            return name in _TIMES or looks(node)
    return looks(node)


def _touches(node: object, scope: Scope) -> bool:
    """Does the step use a signal that has a name?"""
    return isinstance(node, ir.Statement) and touches(node, scope)
