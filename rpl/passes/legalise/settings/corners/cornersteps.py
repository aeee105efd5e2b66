"""Steps behind a corner that ask for signals, times or the robot's place, where the source's program comes to them when
the corner begins and the target's program comes there at another time.

A target that runs ahead over all moves (KRL) is told by an action on the path that the robot has come to the corner;
the program waits for that and is then allowed to go on while the robot drives. A target whose program goes on when a
move has begun (V+) waits until as much of the way is left. In both the corner stays, because the next move is commanded
before the robot comes to rest.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite, walk
from rpl.passes.capabilities import Concurrent
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.usage import doing, usage_of
from rpl.passes.legalise.paths.begunmoves import looks
from rpl.passes.legalise.paths.lookahead import touches
from rpl.passes.legalise.rewriting.beside import Beside, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.settings.explicit import Modal
from rpl.passes.legalise.settings.movesettings import plain
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

EARLY = code(
    "corner-steps-early",
    Severity.WARNING,
    "the target needs the next move some time before the corner: what stands behind this move is done {seconds:g} s "
    "before the corner begins",
)
# A controller that plans the corner needs the next move before it; RAPID's program goes on so long before it.
_LEAD_S = 0.1
_DRIVING = (ir.Move, ir.MoveExternal, ir.Spline)
_UNKNOWN = (*_DRIVING, ir.WaitForMotion, ir.Label, ir.Goto, ir.Halt, ir.Raise)
_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)
_SEEN = frozenset(("current_target", "current_joints", "current_position"))
_TIMES = frozenset(("timer", "timer_stopped", "timer_positive", "time"))


@legalising()
def corner_steps(program: ir.Program, context: Context) -> ir.Program:
    """Only where the source's program goes on at a corner, and the target's can be told when."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    if source.runs_ahead_of != "fly_by" or source.signals_stop:
        return program
    ahead = target.runs_ahead_of == "all" and context.capabilities.motion.concurrent is Concurrent.ADVANCE
    if not ahead and target.runs_ahead_of != "begun":
        return program
    beside = Beside(program, context)
    assigned = usage_of(program).assigned
    busy = doing(program, _is_busy)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        modal = Modal(context, editor.scope, assigned, set())
        return edit_bodies(routine, _Corners(editor, routine, beside, modal, busy, ahead, source.lead_s).body)

    return beside.placed(edit_routines(program, context, work))


class _Corners:
    """Rewrites one routine. `busy`: routines (folded) that drive the robot, wait, or ask for what is now."""

    def __init__(
        self,
        editor: Editor,
        routine: ir.Routine,
        beside: Beside,
        modal: Modal,
        busy: frozenset[str],
        ahead: bool,
        lead_s: float,
    ) -> None:
        self.editor, self.routine, self.beside, self.modal = editor, routine, beside, modal
        self.busy, self.ahead, self.lead_s = busy, ahead, lead_s
        self.flag: ir.Name | None = None

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement = body[at]
            at += 1
            size = self.corner(statement)
            if size is None or not isinstance(statement, ir.Move):
                done.append(inside(statement, self.body))
                continue
            steps = self.behind(body[at:])
            if not self.of_now(steps):
                done.append(statement)
                continue
            done.extend(self.gate(statement, size))
            at += len(steps)
            for step in steps:
                done.extend(self.allowed(_in_force(step, statement) if self.ahead else step))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    # ---- where

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

    def corner(self, statement: ir.Statement) -> ir.Expression | None:
        """How far before the end of the move its corner begins (mm), where that is known."""
        if not isinstance(statement, ir.Move) or statement.kind not in ("linear", "circular"):
            return None
        if statement.concurrent or statement.search is not None or statement.motion_class != "classic":
            return None
        match statement.blend:
            case ir.BlendDistance(distance=size) if size is not None:
                pass
            case ir.BlendZone(zone=zone, distance=size):
                stop = self.modal.component(zone, "stop")
                if size is None and stop != ir.BoolLiteral(False):
                    return None
                size = size or self.modal.component(zone, "path")
            case _:
                return None
        size = plain(size)
        return size if isinstance(size, ir.RealLiteral) and size.value > 0.0 else None

    def of_now(self, steps: ir.Body) -> bool:
        """Does it matter when these steps are done, more than for outputs alone? Not where the robot stands first."""
        for step in steps:
            match step:
                case ir.WaitUntil(in_position=True) | ir.Wait() | ir.Message() | ir.Dialog():
                    return False
                case ir.Assign(target=ir.Name() | ir.Signal(kind="digital_out"), value=ir.BoolLiteral()):
                    continue  # an action on the path, where it is an output
            if self.asks(step):
                return True
        return False

    def asks(self, step: ir.Statement) -> bool:
        return any(_asks(node) or _touches(node, self.editor.scope) for node in walk(step))

    # ---- what is written

    def gate(self, move: ir.Move, size: ir.Expression) -> ir.Body:
        """The move, and the wait for its corner."""
        later = tidy(move.origin)
        lead = max(self.lead_s, _LEAD_S)
        if lead > self.lead_s:
            self.beside.context.diagnostics.report(EARLY, move.origin, seconds=lead)
        if not self.ahead:
            left = ir.Binary("<=", ir.System("remaining_distance"), self.left(move, size, lead))
            return (replace(move, concurrent=True), ir.WaitUntil(left, origin=later))
        if self.flag is None:
            self.flag = self.beside.kept(self.editor, self.routine, "rpl_at_corner", ir.BoolType())
        action = ir.Assign(self.flag, ir.BoolLiteral(True), origin=later)
        before, early = ir.Unary("-", size), ir.Quantity(ir.RealLiteral(-lead), "s")
        return (
            ir.Assign(self.flag, ir.BoolLiteral(False), origin=move.origin),
            ir.Trigger("end", action, distance=before, delay=early, origin=later),
            replace(move, origin=later),
            ir.LookAhead(origin=later),
            ir.WaitUntil(self.flag, origin=later),
        )

    def left(self, move: ir.Move, size: ir.Expression, lead_s: float) -> ir.Expression:
        """The way (mm) that is left that time before the corner begins."""
        speed = move.speed.path if move.speed is not None else None
        if speed is None and move.speed is not None and move.speed.profile is not None:
            speed = self.modal.component(move.speed.profile, "path")
        if speed is None:
            return size
        known = plain(speed)
        if isinstance(known, ir.RealLiteral) and isinstance(size, ir.RealLiteral):
            return ir.RealLiteral(float(f"{size.value + known.value * lead_s:.6g}"))
        return ir.Binary("+", size, ir.Binary("*", known, ir.RealLiteral(lead_s)))

    def allowed(self, step: ir.Statement) -> ir.Body:
        """The step, which does not wait for the robot, nor do those in it."""
        if not self.ahead:
            return (step,)
        waits = isinstance(step, ir.Wait | ir.WaitUntil) or touches(step, self.editor.scope)
        mark = (ir.LookAhead(origin=tidy(step.origin)),) if waits else ()
        return (*mark, inside(step, self.each))

    def each(self, body: ir.Body) -> ir.Body:
        return tuple(one for step in body for one in self.allowed(step))


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


def _in_force(step: ir.Statement, move: ir.Move) -> ir.Statement:
    """The step; places seen with the tool and in the frame of the move are what the controller itself gives."""
    null = ir.System("null_frame")

    def change(node: object) -> object:
        match node:
            case ir.Builtin(function=function, arguments=(tool, *frame)) if function in _SEEN:
                if tool == move.tool and (frame[0] if frame else null) == (move.frame or null):
                    return replace(node, arguments=())
        return node

    return rewrite(step, change)


def _touches(node: object, scope: Scope) -> bool:
    """Does the step use a signal that has a name?"""
    return isinstance(node, ir.Statement) and touches(node, scope)


__all__ = ["corner_steps"]
